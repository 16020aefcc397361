// The command line, the same in every chapter.
#pragma once

#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "app/parameters.hpp"

namespace conebook {

// How a view's values become a .png: radiance is exposed, tone mapped and sRGB encoded; colour (reflectance, 0..1) is
// sRGB encoded; data (normals, depth, shares) is written as it is.
enum class Encoding { radiance, color, data };

struct View {
    std::string name;
    Encoding encoding = Encoding::radiance;
    std::string help;
};

// One list of views after another.
std::vector<View> joined(std::vector<View> first, const std::vector<View>& second);

// What a chapter's program says of itself.
struct ProgramInfo {
    std::string name;  // "08_diffuse_cones"
    std::vector<View> views;  // the first is the default
    ParameterTable parameters;
};

struct Options {
    std::filesystem::path scene;
    std::filesystem::path output;  // empty: nothing is written
    std::filesystem::path stats;   // empty: not written
    std::filesystem::path root;    // the folder that holds shaders/ and assets/
    bool headless = false;
    std::string device;            // for Context::headless
    bool print_stats = false;
    glm::ivec2 size{0};
    int frames = 1;
    bool frames_given = false;
    std::string view;
    std::optional<int> camera;
};

// Not an error: the program has said what it was asked (--help, --list-views) and ends with this code.
struct ExitRequest : std::exception {
    explicit ExitRequest(int exit_code) : code(exit_code) {}
    int code;
};

// Parse argv, apply every --set to info.parameters. Throws std::runtime_error with one line, or ExitRequest.
Options parse_options(int argc, char** argv, ProgramInfo& info);

}  // namespace conebook
