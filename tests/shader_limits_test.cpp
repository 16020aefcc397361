// Storage buffers of every shader of the book within what OpenGL 4.5 promises (chapter 23): eight in fragment and compute
// shaders, numbered 0 to 7, and none in vertex and geometry shaders. Read from the sources, so that it does not depend on
// the limits of the driver at hand, nor on which variants are compiled.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "common/bindings.glsl"

namespace conebook {
namespace {

std::filesystem::path shader_root() { return std::filesystem::path(std::getenv("CONEBOOK_ROOT")) / "shaders"; }

std::string text_of(const std::filesystem::path& file)
{
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

// Value of every `CONEBOOK_CONSTANT int k... = n;` of bindings.glsl.
std::map<std::string, int> named_numbers()
{
    std::map<std::string, int> numbers;
    const std::string text = text_of(shader_root() / "common/bindings.glsl");
    const std::regex line(R"(CONEBOOK_CONSTANT int (k\w+) = (\d+);)");
    for (std::sregex_iterator i(text.begin(), text.end(), line), end; i != end; ++i)
        numbers[(*i)[1]] = std::stoi((*i)[2]);
    return numbers;
}

// The file and everything that it includes, whatever the conditions around it.
void expand(const std::string& file, std::set<std::string>& seen, std::string& out)
{
    if (!seen.insert(file).second) return;
    std::istringstream lines(text_of(shader_root() / file));
    const std::regex include(R"(^\s*#include\s+\"([^\"]+)\".*)");
    std::smatch match;
    for (std::string line; std::getline(lines, line);) {
        if (std::regex_match(line, match, include))
            expand(match[1], seen, out);
        else
            out += line.substr(0, line.find("//")) + "\n";
    }
}

TEST(ShaderLimits, StorageBuffersAreWithinWhatOpenGlPromises)
{
    if (!std::getenv("CONEBOOK_ROOT")) GTEST_SKIP() << "CONEBOOK_ROOT is not set";
    const std::map<std::string, int> numbers = named_numbers();
    ASSERT_EQ(numbers.at("kRadianceBinding"), shared::kRadianceBinding);
    const std::regex storage(R"(layout\(\s*std430\s*,\s*binding\s*=\s*(\w+)\s*\)[^;{]*buffer\s+(\w+))");
    int shaders = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(shader_root())) {
        const std::string extension = entry.path().extension().string();
        constexpr const char* kStages[] = {".vert", ".tesc", ".tese", ".geom", ".frag", ".comp"};
        if (std::find(std::begin(kStages), std::end(kStages), extension) == std::end(kStages)) continue;
        const std::string file = std::filesystem::relative(entry.path(), shader_root()).string();
        std::set<std::string> seen;
        std::string text;
        expand(file, seen, text);
        ++shaders;
        std::map<int, std::string> taken;
        for (std::sregex_iterator i(text.begin(), text.end(), storage), end; i != end; ++i) {
            const std::string name = (*i)[1], block = (*i)[2];
            EXPECT_TRUE(extension == ".frag" || extension == ".comp") << file << " has the storage block " << block;
            ASSERT_TRUE(numbers.count(name))
                << file << ": " << block << " at " << name << ", not named in bindings.glsl";
            const int number = numbers.at(name);
            EXPECT_LE(number, 7) << file << ": " << block;
            // One block may stand twice, for two variants of the shader.
            EXPECT_EQ(taken.emplace(number, block).first->second, block) << file << ": both at " << number;
        }
    }
    EXPECT_GT(shaders, 30);
}

}  // namespace
}  // namespace conebook
