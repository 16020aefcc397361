// The command line, the same in every chapter.
#pragma once

#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "app/parameters.hpp"
#include "app/preset.hpp"

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
    std::string name;         // "08_diffuse_cones"
    std::vector<View> views;  // the first is the default
    ParameterTable parameters;
    // What is to be done with the scene before anything is made of it, its camera included.
    std::function<void(Scene&)> prepare = {};
};

struct Options {
    std::filesystem::path scene;
    std::filesystem::path output;        // empty: nothing is written
    std::filesystem::path stats;         // empty: not written
    std::filesystem::path preset;        // empty: none
    std::filesystem::path save_preset;   // empty: not written
    std::filesystem::path root;          // the folder that holds shaders/ and assets/
    std::filesystem::path trace_frames;  // empty: not written
    bool headless = false;
    std::string device;  // for Context::headless
    bool print_stats = false;
    glm::ivec2 size{0};
    int frames = 1;
    bool frames_given = false;
    std::string view;
    CameraChoice camera;
    bool camera_from_preset = false;
    std::vector<LightChoice> lights;  // of the preset
};

// Not an error: the program has said what it was asked (--help, --list-views) and ends with this code.
struct ExitRequest : std::exception {
    explicit ExitRequest(int exit_code) : code(exit_code) {}
    int code;
};

// Parse argv; info.parameters get the values of --preset, then every --set. Throws std::runtime_error with one line,
// also for files that could not be written or would replace each other, or ExitRequest.
Options parse_options(int argc, char** argv, ProgramInfo& info);

}  // namespace conebook
