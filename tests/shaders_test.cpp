// Shader sources put together from files, and what becomes of a compiler's errors and warnings.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "gl/shader_source.hpp"
#include "temporary_folder.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

const char* const kVertexShader = "#version 450 core\nvoid main() { gl_Position = vec4(0.0); }\n";

// Files below a folder of their own.
class Files {
public:
    void write(const std::string& name, const std::string& text) const
    {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }
    const std::filesystem::path& path() const { return folder_.path(); }
    std::string expand(const std::string& name, const gl::Defines& defines = {}) const
    {
        return gl::expand_shader(path(), name, defines).text;
    }
    // What the driver says of the program of x.vert and x.frag; nothing when it has no complaint.
    std::string complaint(const gl::Defines& defines = {}) const
    {
        write("x.vert", kVertexShader);
        test_gl();  // the context
        gl::Shaders shaders(path());
        try {
            shaders.load({"x.vert", "x.frag"}, defines);
        } catch (const std::exception& error) {
            return error.what();
        }
        return "";
    }

private:
    TemporaryFolder folder_;
};

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

TEST(ShaderSource, AnIncludeInAnInactiveBranchDoesNotCount)
{
    const Files files;
    files.write("lib/value.glsl", "float value() { return 1.0; }\n");
    files.write("lib/twice.glsl", "#include \"lib/value.glsl\"\nfloat twice() { return 2.0 * value(); }\n");
    files.write("x.frag",
                "#version 450 core\n"
                "#if WITHOUT\n#include \"lib/value.glsl\"\n#endif\n"
                "#include \"lib/twice.glsl\"\n#include \"lib/value.glsl\"\n"
                "out vec4 color;\nvoid main() { color = vec4(twice() + value()); }\n");
    EXPECT_EQ(files.complaint({{"WITHOUT", "0"}}), "");  // value() is there, though the first include is not active
    EXPECT_EQ(files.complaint({{"WITHOUT", "1"}}), "");  // and there once
}

TEST(ShaderSource, FilesThatIncludeEachOtherEnd)
{
    const Files files;
    files.write("a.glsl", "#include \"b.glsl\"\nconst float a = 1.0;\n");
    files.write("b.glsl", "#include \"a.glsl\"\nconst float b = 1.0;\n");
    files.write("x.frag",
                "#version 450 core\n#include \"a.glsl\"\n#include \"b.glsl\"\n#include \"x.frag\"\n"
                "out vec4 color;\nvoid main() { color = vec4(a, b, a, b); }\n");
    EXPECT_EQ(files.complaint(), "");
}

TEST(ShaderSource, DefinesFollowTheVersion)
{
    const Files files;
    files.write("x.frag", "// a comment\n#version 450 core\nfloat x = A;\n");
    const std::string text = files.expand("x.frag", {{"A", "3.0"}, {"B", "2"}});
    EXPECT_EQ(text, "// a comment\n#version 450 core\n#define A 3.0\n#define B 2\n#line 3 0\nfloat x = A;\n");
}

TEST(ShaderSource, AMissingIncludeNamesFileAndLine)
{
    const Files files;
    files.write("a.glsl", "\n\n#include \"nowhere.glsl\"\n");
    files.write("x.frag", "#version 450 core\n#include \"a.glsl\"\n");
    try {
        files.expand("x.frag");
        FAIL() << "nothing was thrown";
    } catch (const std::exception& error) {
        EXPECT_EQ(std::string(error.what()), "a.glsl:3: #include \"nowhere.glsl\" is not below the shader folder");
    }
}

// A fault is planted into each line of three files in turn; the driver's message must name that file and line.
TEST(ShaderSource, FaultsAreNamedByFileAndLine)
{
    const std::vector<std::pair<std::string, std::vector<std::string>>> sources = {
        {"x.frag",
         {"#version 450 core", "#if 0", "#include \"lib/b.glsl\"", "#endif", "#include \"lib/a.glsl\"", "",
          "#include \"lib/b.glsl\"", "", "out vec4 color;", "void main() { color = vec4(a(), b(), 0.0, 0.0); }", ""}},
        {"lib/a.glsl", {"", "#include \"lib/b.glsl\"", "", "float a() { return 2.0 * b(); }", ""}},
        {"lib/b.glsl", {"// first", "float b() { return 1.0; }", ""}}};
    for (const auto& [faulty, lines] : sources)
        for (std::size_t line = 0; line < lines.size(); ++line) {
            if (!lines[line].empty()) continue;  // planted into empty lines
            const Files files;
            for (const auto& [name, all] : sources) {
                std::string text;
                for (std::size_t i = 0; i < all.size(); ++i)
                    text += (name == faulty && i == line ? "no_such_type planted;" : all[i]) + "\n";
                files.write(name, text);
            }
            const std::string place = faulty + ":" + std::to_string(line + 1);
            EXPECT_NE(files.complaint().find("shader " + place), std::string::npos)
                << place << ": " << files.complaint();
        }
}

TEST(ShaderSource, MessagesOfAllDriversAreTranslated)
{
    const gl::ShaderSource source{"", {"x.frag", "lib/a.glsl"}};
    EXPECT_EQ(gl::with_file_names("1:12(5): error: bad", source), "lib/a.glsl:12: error: bad");
    EXPECT_EQ(gl::with_file_names("0(12) : error C0000: bad", source), "x.frag:12 : error C0000: bad");
    EXPECT_EQ(gl::with_file_names("ERROR: 1:12: 'x' : bad", source), "ERROR: lib/a.glsl:12: 'x' : bad");
    EXPECT_EQ(gl::with_file_names("7:12: of another", source), "7:12: of another");
}

TEST(Warnings, AreFaultsOnlyWhenStrict)
{
    const Files files;
    files.write("x.frag",
                "#version 450 core\nout vec4 color;\n"
                "void main() { float x; color = vec4(x); }\n"
                "// " + files.path().string() + ": a text that no driver's cache has seen\n");
    setenv("CONEBOOK_STRICT", "1", 1);
    EXPECT_NE(files.complaint().find("x.frag:3"), std::string::npos) << files.complaint();
    setenv("CONEBOOK_STRICT", "0", 1);
    testing::internal::CaptureStderr();
    EXPECT_EQ(files.complaint(), "");
    EXPECT_NE(testing::internal::GetCapturedStderr().find("x.frag:3"), std::string::npos);
    setenv("CONEBOOK_STRICT", "1", 1);
    EXPECT_NE(files.complaint().find("x.frag:3"), std::string::npos) << "the driver's cache knows the text by now";
}

TEST(Dump, WritesEveryVariantOnceAsTheDriverGetsIt)
{
    const Files files;
    files.write("x.frag", "#version 450 core\nout vec4 color;\nvoid main() { color = vec4(A); }\n");
    const TemporaryFolder folder;
    setenv("CONEBOOK_DUMP_SHADERS", (folder / "dump").c_str(), 1);
    for (const char* value : {"1.0", "2.0", "1.0"}) EXPECT_EQ(files.complaint({{"A", value}}), "");
    unsetenv("CONEBOOK_DUMP_SHADERS");
    std::size_t vertex = 0, fragment = 0, first = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "dump")) {
        std::ifstream in(entry.path());
        std::ostringstream text;
        text << in.rdbuf();
        vertex += entry.path().extension() == ".vert" ? 1 : 0;
        fragment += entry.path().extension() == ".frag" ? 1 : 0;
        first += count(text.str(), "#define A 1.0\n");
    }
    EXPECT_EQ(vertex, 2u);  // defines go to every stage
    EXPECT_EQ(fragment, 2u);
    EXPECT_EQ(first, 2u);
}

}  // namespace
}  // namespace conebook
