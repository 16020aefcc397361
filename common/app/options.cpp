#include "app/options.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "app/context.hpp"

namespace conebook {

namespace {

constexpr int kMaxSide = 16384;  // pixels; what OpenGL 4.5 promises for textures

glm::ivec2 parse_size(const std::string& text)
{
    int width = 0, height = 0;
    char x = 0, rest = 0;
    const bool ok = std::sscanf(text.c_str(), "%d%c%d%c", &width, &x, &height, &rest) == 3 && x == 'x';
    if (!ok || width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
        throw std::runtime_error("--size " + text + ": expected WIDTHxHEIGHT, each 1 .. " + std::to_string(kMaxSide));
    return {width, height};
}

// The folder given at build time, or $CONEBOOK_ROOT: never the working directory.
std::filesystem::path find_root()
{
    const char* from_environment = std::getenv("CONEBOOK_ROOT");
    const std::filesystem::path root = from_environment != nullptr ? from_environment : CONEBOOK_ROOT;
    if (!std::filesystem::is_directory(root / "shaders"))
        throw std::runtime_error(root.string() + ": holds no shaders folder; set CONEBOOK_ROOT to the repository");
    return root;
}

// Fail before the work, not after it.
void check_writable(const char* option, const std::filesystem::path& file)
{
    if (file.empty()) return;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        throw std::runtime_error(std::string(option) + " " + file.string() + ": folder " + folder.string() +
                                 " does not exist");
    if (std::filesystem::is_directory(file, error))
        throw std::runtime_error(std::string(option) + " " + file.string() + ": is a folder");
}

}  // namespace

std::vector<View> joined(std::vector<View> first, const std::vector<View>& second)
{
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

Options parse_options(int argc, char** argv, ProgramInfo& info)
{
    Options options;
    std::string scene, size, output, stats;
    std::vector<std::string> assignments;
    int camera = -1;
    bool list_views = false, list_parameters = false, list_devices = false;

    CLI::App cli(info.name, info.name);
    cli.add_option("--scene", scene, "glTF scene, .gltf or .glb (default: assets/cornell_box.glb)");
    cli.add_flag("--headless", options.headless, "render without a display (EGL)");
    cli.add_option("--device", options.device, "with --headless: number or part of the name; --list-devices names them");
    cli.add_option("--size", size, "WxH in pixels (default: 1280x720 window, 512x512 headless)");
    cli.add_option("--output", output, ".png: tone mapped, sRGB; .exr: scene-linear radiance");
    CLI::Option* frames = cli.add_option("--frames", options.frames, "render N frames, keep the last (headless: 1)");
    cli.add_option("--view", options.view, "what to show; --list-views names them");
    CLI::Option* camera_option = cli.add_option("--camera", camera, "the scene's Nth camera, from 0");
    cli.add_option("--stats", stats, "write times and memory as JSON");
    cli.add_flag("--print-stats", options.print_stats, "print times and memory as a table");
    cli.add_option("--set", assignments, "NAME=VALUE ..., parameters; --list-params names them")
        ->type_name("NAME=VALUE");
    cli.add_flag("--list-views", list_views, "name the views and end");
    cli.add_flag("--list-params", list_parameters, "name the parameters and end");
    cli.add_flag("--list-devices", list_devices, "name the devices that can render headless and end");
    try {
        cli.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        std::cout << cli.help();
        throw ExitRequest(0);
    } catch (const CLI::ParseError& error) {
        throw std::runtime_error(error.what());
    }

    if (list_views) {
        for (const View& view : info.views) std::cout << view.name << "\t" << view.help << "\n";
        throw ExitRequest(0);
    }
    if (list_parameters) {
        std::cout << info.parameters.listing();
        throw ExitRequest(0);
    }

    if (list_devices) {
        std::cout << Context::device_listing();
        throw ExitRequest(0);
    }
    if (!options.device.empty() && !options.headless)
        throw std::runtime_error("--device " + options.device + ": needs --headless; a window has its display's driver");

    for (const std::string& assignment : assignments) info.parameters.set(assignment);
    if (options.view.empty()) options.view = info.views.front().name;
    if (std::none_of(info.views.begin(), info.views.end(), [&](const View& v) { return v.name == options.view; }))
        throw std::runtime_error("--view " + options.view + ": unknown view; --list-views names those of " + info.name);
    if (frames->count() > 0 && (options.frames < 1 || options.frames > 1000000))
        throw std::runtime_error("--frames " + std::to_string(options.frames) + ": must be 1 .. 1000000");
    options.frames_given = frames->count() > 0;
    if (camera_option->count() > 0) {
        if (camera < 0) throw std::runtime_error("--camera " + std::to_string(camera) + ": must be 0 or more");
        options.camera = camera;
    }
    options.output = output;
    options.stats = stats;
    const std::string extension = options.output.extension().string();
    if (!options.output.empty() && extension != ".png" && extension != ".exr")
        throw std::runtime_error("--output " + output + ": must end in .png or .exr");
    check_writable("--output", options.output);
    check_writable("--stats", options.stats);
    options.size = !size.empty() ? parse_size(size) : options.headless ? glm::ivec2(512, 512) : glm::ivec2(1280, 720);
    options.root = find_root();
    options.scene = scene.empty() ? options.root / "assets" / "cornell_box.glb" : std::filesystem::path(scene);
    return options;
}

}  // namespace conebook
