// Every picture of cases.txt against the one that is kept. The pictures were looked at before they were committed, but
// a golden freezes faults too: whether a picture is right is the matter of the analytic and hard tests.
//
// CONEBOOK_UPDATE_GOLDENS=1 writes the pictures instead of comparing them.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "image/image.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

struct Case {
    std::string name, program, arguments;
    // A pixel fails when one of its channels is further off than this, in steps of 1/255. The same driver on the same
    // processor gives the same bits (measured over ten runs, and with one and two driver threads); another processor
    // of the same width may round a division or an exponential the other way, which is one step after the tone
    // curve, and two where it is steepest.
    int max_difference = 2;
    // The share of pixels that may fail: where such a rounding moves an edge, one pixel flips as a whole. 66 pixels
    // of 256 x 256, while a light, a shadow or a cone that goes missing changes thousands.
    double max_share = 0.001;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.program << c.arguments; }

std::filesystem::path folder_of(const char* variable)
{
    const char* value = std::getenv(variable);
    return value != nullptr ? value : "";
}

std::filesystem::path golden_folder() { return folder_of("CONEBOOK_ROOT") / "tests" / "golden"; }

bool updating()
{
    const char* value = std::getenv("CONEBOOK_UPDATE_GOLDENS");
    return value != nullptr && std::string(value) == "1";
}

// assets/... and {shared}/... become absolute: programs do not depend on the working directory.
std::string absolute_argument(const std::string& word)
{
    const std::string shared = "{shared}";
    if (word.rfind("assets/", 0) == 0) return (folder_of("CONEBOOK_ROOT") / word).string();
    if (word.rfind(shared, 0) == 0) return folder_of("CONEBOOK_SHARED").string() + word.substr(shared.size());
    return word;
}

Case parse_case(const std::string& line)
{
    Case parsed;
    std::istringstream words(line);
    words >> parsed.name >> parsed.program;
    if (parsed.program.empty()) throw std::runtime_error("expected NAME CHAPTER ARGS...: " + line);
    if (parsed.name.rfind(parsed.program, 0) != 0)
        throw std::runtime_error("the name does not start with its chapter's: " + line);
    bool has_size = false, has_voxels = false;
    for (std::string word; words >> word;) {
        const std::string value = word.substr(word.find('=') + 1);
        if (word.rfind("max_difference=", 0) == 0) {
            parsed.max_difference = std::stoi(value);
            continue;
        }
        if (word.rfind("max_share=", 0) == 0) {
            parsed.max_share = std::stod(value);
            continue;
        }
        has_size = has_size || word == "--size";
        has_voxels = has_voxels || word.rfind("voxels=", 0) == 0;
        parsed.arguments += " '" + absolute_argument(word) + "'";
    }
    if (!has_size) parsed.arguments += " --size 256x256";
    if (conebook::has_voxels(parsed.program) && !has_voxels) parsed.arguments += " --set voxels=64";
    return parsed;
}

std::vector<Case> read_cases(const std::filesystem::path& file)
{
    std::ifstream in(file);
    if (!in) throw std::runtime_error(file.string() + ": cannot be read");
    std::vector<Case> cases;
    for (std::string line; std::getline(in, line);)
        if (line.find_first_not_of(" \t") != std::string::npos && line[0] != '#') cases.push_back(parse_case(line));
    return cases;
}

// GoogleTest asks for the cases before any test runs, so a fault in the file is left to its own test.
std::vector<Case> cases_or_none()
{
    try {
        return read_cases(golden_folder() / "cases.txt");
    } catch (const std::exception&) {
        return {};
    }
}

TEST(GoldenFiles, CasesAreWellFormedAndEveryPictureHasOne)
{
    std::vector<Case> cases;
    ASSERT_NO_THROW(cases = read_cases(golden_folder() / "cases.txt"));
    ASSERT_FALSE(cases.empty());
    std::vector<std::string> names;
    for (const Case& c : cases) names.push_back(c.name);
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end()) << "a name is there twice";
    for (const auto& entry : std::filesystem::directory_iterator(golden_folder())) {
        if (entry.path().extension() != ".png") continue;
        EXPECT_TRUE(std::binary_search(names.begin(), names.end(), entry.path().stem().string()))
            << entry.path() << " belongs to no case";
    }
}

std::string read_line(const std::filesystem::path& file)
{
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

struct Difference {
    double failing_share = 0.0;  // of the pixels
    int largest = 0;             // of any channel, steps of 1/255
    Image8 picture;              // 16 times the difference, so that a step of 1/255 can be seen
};

Difference difference_of(const Image8& actual, const Image8& golden, int max_difference)
{
    Difference result;
    result.picture = {golden.width, golden.height, std::vector<std::uint8_t>(golden.rgba.size(), 255)};
    std::size_t failing = 0;
    for (std::size_t pixel = 0; pixel < golden.rgba.size() / 4; ++pixel) {
        int largest = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const int d = std::abs(int(actual.rgba[4 * pixel + c]) - int(golden.rgba[4 * pixel + c]));
            result.picture.rgba[4 * pixel + c] = std::uint8_t(std::min(16 * d, 255));
            largest = std::max(largest, d);
        }
        failing += largest > max_difference ? 1 : 0;
        result.largest = std::max(result.largest, largest);
    }
    result.failing_share = double(failing) / double(golden.rgba.size() / 4);
    return result;
}

class Golden : public testing::TestWithParam<Case> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Golden);

TEST_P(Golden, IsAsItWas)
{
    const Case& wanted = GetParam();
    ASSERT_FALSE(program_folder().empty()) << "CONEBOOK_BIN is not set";
    if (wanted.arguments.find("{shared}") != std::string::npos) GTEST_SKIP() << "CONEBOOK_SHARED is not set";
    const std::filesystem::path golden_file = golden_folder() / (wanted.name + ".png");
    const std::filesystem::path renderer_file = golden_folder() / "renderer.txt";

    const TemporaryFolder folder;
    const std::filesystem::path actual_file = folder / (wanted.name + ".png"), stats_file = folder / "stats.json";
    const ProgramRun run =
        run_program(wanted.program, wanted.arguments + " --headless --output '" + actual_file.string() + "' --stats '" +
                                        stats_file.string() + "'");
    ASSERT_EQ(run.code, 0) << wanted.program << wanted.arguments << "\n" << run.output;
    std::ifstream stats(stats_file);
    const std::string renderer = nlohmann::json::parse(stats).at("driver").get<std::string>();

    if (updating()) {
        std::filesystem::copy_file(actual_file, golden_file, std::filesystem::copy_options::overwrite_existing);
        std::ofstream(renderer_file) << renderer << "\n";
        return;
    }
    ASSERT_TRUE(std::filesystem::exists(golden_file))
        << golden_file << " is missing; ./test --update-goldens makes it, for somebody to look at";
    const std::string made_with = read_line(renderer_file);
    if (renderer != made_with) GTEST_SKIP() << "the goldens were made with " << made_with << ", this is " << renderer;

    const Image8 actual = read_png(actual_file), golden = read_png(golden_file);
    ASSERT_EQ(actual.width, golden.width);
    ASSERT_EQ(actual.height, golden.height);
    const Difference difference = difference_of(actual, golden, wanted.max_difference);
    if (difference.failing_share <= wanted.max_share) return;

    const std::filesystem::path failures = std::filesystem::path(program_folder()).parent_path() / "golden_failures";
    std::filesystem::create_directories(failures);
    write_png(failures / (wanted.name + "_actual.png"), actual);
    write_png(failures / (wanted.name + "_golden.png"), golden);
    write_png(failures / (wanted.name + "_difference.png"), difference.picture);
    FAIL() << wanted.name << ": " << 100.0 * difference.failing_share << " % of the pixels differ by more than "
           << wanted.max_difference << "/255 (allowed " << 100.0 * wanted.max_share << " %), the largest by "
           << difference.largest << "/255; actual, golden and difference are in " << failures;
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(cases_or_none()),
                         [](const testing::TestParamInfo<Case>& info) { return "c" + info.param.name; });

}  // namespace
}  // namespace conebook
