#include "gl/shader_source.hpp"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace conebook::gl {

namespace {

std::string read_text(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error(file.string() + ": shader file cannot be read");
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

class Expansion {
public:
    Expansion(const std::filesystem::path& root, const Defines& defines) : root_(root), defines_(defines) {}

    void add(const std::string& file)
    {
        const std::size_t file_number = number_of(file);
        open_.push_back(file);
        std::istringstream lines(read_text(root_ / file));
        static const std::regex include_line(R"(^\s*#include\s+\"([^\"]+)\".*)");
        static const std::regex chosen_include_line(R"(^\s*#include\s+([A-Z_]+)\s*)");
        std::string line;
        for (int number = 1; std::getline(lines, line); ++number) {
            std::smatch match;
            if (std::regex_match(line, match, include_line)) {
                include(match[1], file + ":" + std::to_string(number));
                start_line(number + 1, file_number);
                continue;
            }
            if (std::regex_match(line, match, chosen_include_line)) {
                const auto chosen = defines_.find(match[1]);
                // Where it isn't chosen the line is not active, or it is a fault that the compiler tells.
                if (chosen == defines_.end())
                    source_.text += "#error no file is chosen for " + match[1].str() + "\n";
                else
                    include(chosen->second, file + ":" + std::to_string(number));
                start_line(number + 1, file_number);
                continue;
            }
            source_.text += line + "\n";
            if (line.rfind("#version", 0) != 0) continue;
            for (const auto& [name, value] : defines_) {
                const bool is_file = value.ends_with(".glsl");
                source_.text += "#define " + name + " ";
                source_.text += is_file ? "1" : value;
                source_.text += "\n";
            }
            start_line(number + 1, file_number);
        }
        open_.pop_back();
    }
    ShaderSource take() { return std::move(source_); }

private:
    void include(const std::string& file, const std::string& place)
    {
        // Within itself a file is there already, or this line is not active.
        if (std::find(open_.begin(), open_.end(), file) != open_.end()) return;
        if (!std::filesystem::exists(root_ / file))
            throw std::runtime_error(place + ": #include \"" + file + "\" is not below the shader folder");
        const std::size_t number = number_of(file);
        const std::string guard = "INCLUDED_" + std::to_string(number);
        source_.text += "#ifndef " + guard + "\n#define " + guard + "\n";
        start_line(1, number);
        add(file);
        source_.text += "#endif\n";
    }
    void start_line(int line, std::size_t file_number)
    {
        source_.text += "#line " + std::to_string(line) + " " + std::to_string(file_number) + "\n";
    }
    std::size_t number_of(const std::string& file)
    {
        const auto found = std::find(source_.files.begin(), source_.files.end(), file);
        const std::size_t number = std::size_t(found - source_.files.begin());
        if (found == source_.files.end()) source_.files.push_back(file);
        return number;
    }

    const std::filesystem::path& root_;
    const Defines& defines_;
    std::vector<std::string> open_;  // from the shader's own file to the one that is being read
    ShaderSource source_;
};

}  // namespace

ShaderSource expand_shader(const std::filesystem::path& root, const std::string& file, const Defines& defines)
{
    Expansion expansion(root, defines);
    expansion.add(file);
    return expansion.take();
}

// Drivers write "0:12(5): error: ..." (Mesa), "0(12) : error ..." (NVIDIA), "ERROR: 0:12: ..." (others).
std::string with_file_names(const std::string& log, const ShaderSource& source)
{
    static const std::regex location(R"((\d+)(?::|\()(\d+)(?:\(\d+\))?\)?)");
    std::string out;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (std::regex_search(line, match, location)) {
            const std::size_t index = std::stoul(match[1]);
            if (index < source.files.size())
                line = match.prefix().str() + source.files[index] + ":" + match[2].str() + match.suffix().str();
        }
        out += (out.empty() ? "" : "\n") + line;
    }
    return out;
}

}  // namespace conebook::gl
