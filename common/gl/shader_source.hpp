// The text of a shader with its includes and constants put in, and the way back from a driver's message to file and line.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace conebook::gl {

// #define NAME VALUE, placed after #version. A value that is a file (*.glsl) is what a line #include NAME stands for; for
// #ifdef such a name is 1.
using Defines = std::map<std::string, std::string>;

struct ShaderSource {
    std::string text;
    std::vector<std::string> files;  // relative to the shader root; files[i] is source string i of the #line directives
};

// `file` and those of its #include "..." lines, relative to `root`. Each counts once, by an include guard of its own, so that
// one inside an inactive #if is still there for the next. Throws std::runtime_error that names the file that is missing,
// and the line that wants it.
ShaderSource expand_shader(const std::filesystem::path& root, const std::string& file, const Defines& defines);

// A compiler's messages with "FILE:LINE" in place of the numbers of source string and line.
std::string with_file_names(const std::string& log, const ShaderSource& source);

}  // namespace conebook::gl
