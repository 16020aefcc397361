#include "app/options.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "app/context.hpp"
#include "image/picture_size.hpp"
#include "image/write_file.hpp"

namespace conebook {

namespace {

// The folder given at build time, or $CONEBOOK_ROOT: never the working directory.
std::filesystem::path find_root()
{
    const char* from_environment = std::getenv("CONEBOOK_ROOT");
    const std::filesystem::path root = from_environment != nullptr ? from_environment : CONEBOOK_ROOT;
    if (!std::filesystem::is_directory(root / "shaders"))
        throw std::runtime_error(root.string() + ": holds no shaders folder; set CONEBOOK_ROOT to the repository");
    return root;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b)
{
    std::error_code error, error_a, error_b;
    if (std::filesystem::equivalent(a, b, error)) return true;
    const std::filesystem::path full_a = std::filesystem::weakly_canonical(a, error_a);
    return full_a == std::filesystem::weakly_canonical(b, error_b) && !error_a && !error_b;
}

struct NamedFile {
    std::string option;
    std::filesystem::path file;  // may be empty
};

// Fail before the work, not after it: an output must be writable and neither an output before it nor one of `others`.
void check_outputs(const std::vector<NamedFile>& outputs, std::vector<NamedFile> others)
{
    for (const NamedFile& output : outputs) {
        if (output.file.empty()) continue;
        for (const NamedFile& other : others)
            if (!other.file.empty() && same_file(output.file, other.file))
                throw std::runtime_error(output.option + " " + output.file.string() + ": is the file of " +
                                         other.option);
        try {
            check_writable(output.file);
        } catch (const std::exception& error) {
            throw std::runtime_error(output.option + " " + error.what());
        }
        others.push_back(output);
    }
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
    std::string scene, size, output, stats, trace_frames, preset_file, save_preset;
    std::vector<std::string> assignments;
    int camera = -1;
    bool list_views = false, list_parameters = false, list_devices = false;

    CLI::App cli(info.name, info.name);
    cli.add_option("--scene", scene, "glTF scene, .gltf or .glb (default: assets/cornell_box.glb)");
    cli.add_flag("--headless", options.headless, "render without a display (EGL)");
    cli.add_option("--device", options.device,
                   "with --headless: number or part of the name; --list-devices names them");
    cli.add_option("--size", size, "WxH in pixels (default: 1280x720 window, 512x512 headless)");
    cli.add_option("--output", output, ".png: tone mapped, sRGB; .exr: scene-linear radiance");
    CLI::Option* frames = cli.add_option("--frames", options.frames, "render N frames, keep the last (headless: 1)");
    cli.add_option("--view", options.view, "what to show; --list-views names them");
    CLI::Option* camera_option = cli.add_option("--camera", camera, "the scene's Nth camera, from 0");
    cli.add_option("--stats", stats, "write times and memory as JSON");
    cli.add_flag("--print-stats", options.print_stats, "print times and memory as a table");
    cli.add_option("--trace-frames", trace_frames,
                   "write a line for each picture that a window shows: when (s, monotonic clock), meanwhile or frame, "
                   "its size, the window's, view, sample, changes by the reader so far, "
                   "parameters that are not the default");
    cli.add_option("--set", assignments, "NAME=VALUE ..., parameters; --list-params names them")
        ->type_name("NAME=VALUE");
    cli.add_option("--preset", preset_file, "parameters, view, camera and lights as another run saved them");
    cli.add_option("--save-preset", save_preset, "write parameters, view, camera and lights as JSON");
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
        throw std::runtime_error("--device " + options.device +
                                 ": needs --headless; a window has its display's driver");

    // What the command line says stands above what the preset says.
    Preset preset;
    if (!preset_file.empty()) preset = read_preset(preset_file, info.parameters);
    for (const std::string& assignment : assignments) info.parameters.set(assignment);
    const std::string view_from = options.view.empty() ? preset_file + ": view " : "--view ";
    if (options.view.empty()) options.view = preset.view.empty() ? info.views.front().name : preset.view;
    if (std::none_of(info.views.begin(), info.views.end(), [&](const View& v) { return v.name == options.view; }))
        throw std::runtime_error(view_from + options.view + ": unknown view; --list-views names those of " + info.name);
    if (frames->count() > 0 && (options.frames < 1 || options.frames > 1000000))
        throw std::runtime_error("--frames " + std::to_string(options.frames) + ": must be 1 .. 1000000");
    options.frames_given = frames->count() > 0;
    if (camera_option->count() > 0) {
        if (camera < 0) throw std::runtime_error("--camera " + std::to_string(camera) + ": must be 0 or more");
        preset.camera = {camera, {}, {}, {}};
    }
    options.camera_from_preset = !preset_file.empty() && camera_option->count() == 0;
    options.camera = preset.camera;
    options.lights = preset.lights;
    options.output = output;
    options.stats = stats;
    options.trace_frames = trace_frames;
    options.preset = preset_file;
    options.save_preset = save_preset;
    const std::string extension = options.output.extension().string();
    if (!options.output.empty() && extension != ".png" && extension != ".exr")
        throw std::runtime_error("--output " + output + ": must end in .png or .exr");
    options.size = !size.empty()      ? parse_picture_size(size)
                   : options.headless ? glm::ivec2(512, 512)
                                      : glm::ivec2(1280, 720);
    options.root = find_root();
    options.scene = scene.empty() ? options.root / "assets" / "cornell_box.glb" : std::filesystem::path(scene);
    // A preset may be brought up to date in its place.
    const std::vector<NamedFile> inputs{{"--scene", options.scene}, {"--preset", preset_file}};
    const std::vector<NamedFile> outputs{{"--output", output}, {"--stats", stats}, {"--trace-frames", trace_frames}};
    check_outputs(outputs, inputs);
    std::vector<NamedFile> others = outputs;
    others.push_back(inputs.front());
    check_outputs({{"--save-preset", save_preset}}, others);
    return options;
}

}  // namespace conebook
