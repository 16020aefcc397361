// reference: renders a scene with the CPU path tracer; the ground truth of the book (path_tracer.hpp).
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

#include <unistd.h>
#include <CLI/CLI.hpp>

#include "image/picture_size.hpp"
#include "reference/path_tracer.hpp"
#include "reference/shared_light.hpp"
#include "scene/objects.hpp"
#include "scene/pose.hpp"

using namespace conebook;

namespace {

void show_progress(double done, double seconds)
{
    if (done <= 0.0) return;
    std::fprintf(stderr, "\r%5.1f %%, %.0f s left   ", 100.0 * done, seconds / done * (1.0 - done));
    std::fflush(stderr);
}

constexpr const char* kParts[] = {"direct", "indirect_diffuse", "indirect_specular", "emission"};
constexpr float kVoxelsAcross = 128.0f;  // chapter 08's default: its planes are a voxel thick

// Neighbours share the indirect diffuse light. `result`: of that part alone, or of that and of all light, whose picture then
// comes first.
void share(PathTraceResult& result, const Scene& scene, const Camera& camera, int threads)
{
    const SceneTracer tracer(scene, threads);
    const auto start = std::chrono::steady_clock::now();
    const ImageF own = std::move(result.pictures.back());
    const std::vector<VisibleSurface> surfaces = visible_surfaces(tracer, camera, own.width, own.height, threads);
    const float plane_tolerance = scene.bounds.longest_side() / kVoxelsAcross;
    ImageF shared = share_indirect_diffuse(own, surfaces, plane_tolerance, threads);
    if (result.pictures.size() == 2)
        for (std::size_t i = 0; i < own.pixels.size(); ++i)
            shared.pixels[i] += glm::vec4(glm::vec3(result.pictures[0].pixels[i] - own.pixels[i]), 0.0f);
    result.pictures[0] = std::move(shared);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.sample_seconds += seconds;
    result.seconds += seconds;
}

int run(int argc, char** argv)
{
    std::string scene_file, size = "512x512", output, part = "final", error_file;
    std::optional<int> camera_index;
    PathTraceOptions options;
    float sky = 0.0f;
    std::optional<double> time_s;
    std::string objects;
    bool shared = false, write_parts = false;
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
    app.add_option("--time", time_s, "s: the pose of what the file animates; default: as it lies there")->check(CLI::Range(0.0, 1e6));
    app.add_option("--objects", objects, objects_help());
    app.add_option("--threads", options.threads, "default 0: all cores; does not change the picture")
        ->check(CLI::Range(0, 1024));
    app.add_option("--max-seconds", options.max_seconds, "stop after the pass that exceeds this time")
        ->check(CLI::Range(0.0, 1e9));
    app.add_flag(
        "--write-parts", write_parts,
        "with --output X.exr: also X_direct.exr, X_indirect_diffuse.exr ..., and X_direct_error.exr ... with --error");
    app.add_flag("--share", shared,
                 "neighbours on a surface share their indirect diffuse light, as chapter 08's do: less noise, and no "
                 "longer the truth");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& e) {
        return app.exit(e);
    } catch (const CLI::ParseError& e) {
        throw std::runtime_error(e.what());
    }
    const glm::ivec2 pixels = parse_picture_size(size);
    options.width = pixels.x;
    options.height = pixels.y;
    options.parts = {part_from_name(part)};
    if (write_parts) {
        if (shared || options.parts[0] != Part::final)
            throw std::runtime_error("--write-parts: the parts come with --part final, and without --share");
        for (const char* name : kParts) options.parts.push_back(part_from_name(name));
    }
    if (shared) {
        if (!error_file.empty())
            throw std::runtime_error("--share: a shared picture has no standard error, leave out --error");
        if (options.parts[0] == Part::final)
            options.parts = {Part::final, Part::indirect_diffuse};
        else if (options.parts[0] != Part::indirect_diffuse)
            throw std::runtime_error("--share: only --part final and indirect_diffuse hold what is shared");
    }
    options.sky = glm::vec3(sky);
    if (!output.ends_with(".exr")) throw std::runtime_error(output + ": the reference writes .exr only");
    if (!error_file.empty() && options.spp < 2)
        throw std::runtime_error("--error needs at least 2 samples per pixel (--spp)");

    Scene scene = load_scene(scene_file);
    PlacedObjects placed(scene);
    try {
        placed.set(scene, parse_objects(objects));
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(std::string("--objects: ") + error.what());
    }
    scene.bounds = bounds_with_objects(scene);
    const Bounds all_poses = time_s ? swept_bounds(scene) : scene.bounds;
    if (time_s) scene = posed(std::move(scene), *time_s);
    const std::string name = std::filesystem::path(scene_file).filename().string();
    for (const std::string& warning : scene.warnings) std::cerr << name << ": note: " << warning << "\n";
    scene.bounds = all_poses;  // a camera that the file lacks shows all of them, as in chapter 15
    const Camera camera = choose_camera(scene, camera_index);
    const bool terminal = isatty(STDERR_FILENO);
    if (terminal) options.progress = show_progress;
    PathTraceResult result = path_trace(scene, camera, options);
    if (shared) share(result, scene, camera, options.threads);
    if (terminal) std::fprintf(stderr, "\r%30s\r", "");
    if (result.non_finite > 0)
        throw std::runtime_error(scene_file + ": " + std::to_string(result.non_finite) +
                                 " samples were NaN or infinite; nothing was written");
    write_exr(output, result.pictures[0]);
    if (!error_file.empty()) write_exr(error_file, result.errors[0]);

    const auto part_file = [&](std::size_t i, const char* end) {
        return output.substr(0, output.size() - 4) + "_" + kParts[i] + end + ".exr";
    };
    for (std::size_t i = 0; write_parts && i < std::size(kParts); ++i) {
        write_exr(part_file(i, ""), result.pictures[i + 1]);
        if (!error_file.empty()) write_exr(part_file(i, "_error"), result.errors[i + 1]);
    }
    std::printf("%s: %s%s, %dx%d, %d samples per pixel, %d bounces, %.3f s for the samples, %.3f s in all\n",
                output.c_str(), part.c_str(), shared ? ", shared" : "", options.width, options.height, result.spp,
                options.bounces, result.sample_seconds, result.seconds);
    if (shared) return 0;  // what follows is of independent pixels
    const MeanWithError mean = mean_radiance(result.pictures[0], result.errors[0]);
    glm::dvec3 pixel_error(0.0);
    for (const glm::vec4& e : result.errors[0].pixels) pixel_error += glm::dvec3(e);
    pixel_error /= double(result.errors[0].pixels.size());
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
