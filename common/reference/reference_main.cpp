// reference: renders a scene with the CPU path tracer; the ground truth of the book (path_tracer.hpp).
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

#include <unistd.h>
#include <CLI/CLI.hpp>

#include "reference/path_tracer.hpp"

using namespace conebook;

namespace {

void parse_size(const std::string& text, int& width, int& height)
{
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 1 || height < 1 || width > 16384 ||
        height > 16384)
        throw std::runtime_error("--size " + text + ": expected WIDTHxHEIGHT, each 1 to 16384");
}

void show_progress(double done, double seconds)
{
    if (done <= 0.0) return;
    std::fprintf(stderr, "\r%5.1f %%, %.0f s left   ", 100.0 * done, seconds / done * (1.0 - done));
    std::fflush(stderr);
}

int run(int argc, char** argv)
{
    std::string scene_file, size = "512x512", output, part = "final", error_file;
    std::optional<int> camera_index;
    PathTraceOptions options;
    float sky = 0.0f;
    CLI::App app{"Path traces a glTF scene on the CPU: scene-linear radiance, standard error per pixel."};
    app.add_option("--scene", scene_file, ".gltf or .glb file")->required();
    app.add_option("--size", size, "WIDTHxHEIGHT in pixels, default 512x512");
    app.add_option("--spp", options.spp, "samples per pixel, default 64")->check(CLI::Range(1, 1 << 24));
    app.add_option("--bounces", options.bounces, "indirect bounces; -1 (default): all")->check(CLI::Range(-1, 1 << 20));
    app.add_option("--seed", options.seed, "of the random numbers, default 0");
    app.add_option("--output", output, ".exr file")->required();
    app.add_option("--camera", camera_index, "the scene's Nth camera, from 0");
    app.add_option("--part", part, "final, direct, indirect_diffuse, indirect_specular or emission");
    app.add_option("--error", error_file, ".exr file for the standard error per pixel");
    app.add_option("--sky", sky, "radiance of a constant sky, default 0")->check(CLI::Range(0.0, 1e9));
    app.add_option("--threads", options.threads, "default 0: all cores; does not change the picture")
        ->check(CLI::Range(0, 1024));
    app.add_option("--max-seconds", options.max_seconds, "stop after the pass that exceeds this time")
        ->check(CLI::Range(0.0, 1e9));
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& e) {
        return app.exit(e);
    } catch (const CLI::ParseError& e) {
        throw std::runtime_error(e.what());
    }
    parse_size(size, options.width, options.height);
    options.parts = {part_from_name(part)};
    options.sky = glm::vec3(sky);
    if (!output.ends_with(".exr")) throw std::runtime_error(output + ": the reference writes .exr only");
    if (!error_file.empty() && options.spp < 2)
        throw std::runtime_error("--error needs at least 2 samples per pixel (--spp)");

    const Scene scene = load_scene(scene_file);
    const std::string name = std::filesystem::path(scene_file).filename().string();
    for (const std::string& warning : scene.warnings) std::cerr << name << ": note: " << warning << "\n";
    const Camera camera = choose_camera(scene, camera_index);
    const bool terminal = isatty(STDERR_FILENO);
    if (terminal) options.progress = show_progress;
    const PathTraceResult result = path_trace(scene, camera, options);
    if (terminal) std::fprintf(stderr, "\r%30s\r", "");
    if (result.non_finite > 0)
        throw std::runtime_error(scene_file + ": " + std::to_string(result.non_finite) +
                                 " samples were NaN or infinite; nothing was written");
    write_exr(output, result.pictures[0]);
    if (!error_file.empty()) write_exr(error_file, result.errors[0]);

    const MeanWithError mean = mean_radiance(result.pictures[0], result.errors[0]);
    glm::dvec3 pixel_error(0.0);
    for (const glm::vec4& e : result.errors[0].pixels) pixel_error += glm::dvec3(e);
    pixel_error /= double(result.errors[0].pixels.size());
    std::printf("%s: %s, %dx%d, %d samples per pixel, %d bounces, %.1f s\n", output.c_str(), part.c_str(),
                options.width, options.height, result.spp, options.bounces, result.seconds);
    std::printf("mean radiance  %.6g %.6g %.6g W/(sr m^2), standard error of that mean %.2g %.2g %.2g\n", mean.mean.x,
                mean.mean.y, mean.mean.z, mean.standard_error.x, mean.standard_error.y, mean.standard_error.z);
    std::printf("mean standard error of a pixel  %.3g %.3g %.3g\n", pixel_error.x, pixel_error.y, pixel_error.z);
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    try {
        return run(argc, argv);
    } catch (const std::exception& e) {
        std::cerr << "reference: " << e.what() << "\n";
        return 1;
    }
}
