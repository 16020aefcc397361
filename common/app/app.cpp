#include "app/app.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include "app/app_window.hpp"
#include "app/needs.hpp"
#include "scene/objects.hpp"
#include "scene/radical_inverse.hpp"

namespace conebook {

namespace {

std::size_t index_of(const std::vector<View>& views, const std::string& name)
{
    std::size_t i = 0;
    while (views[i].name != name) ++i;
    return i;
}

// Does `work`; what it throws is a fault of the preset and names its file.
template <typename Work>
auto of_preset(const std::filesystem::path& preset, Work work)
{
    try {
        return work();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(preset.string() + ": " + error.what());
    }
}

Scene scene_of(const Options& options, const ProgramInfo& info)
{
    Scene scene = load_scene(options.scene);
    if (info.prepare) info.prepare(scene);
    of_preset(options.preset, [&] { place_lights(scene, options.lights); });
    return scene;
}

Camera camera_of(const Scene& scene, const Options& options)
{
    if (!options.camera_from_preset) return place_camera(scene, options.camera);
    return of_preset(options.preset, [&] { return place_camera(scene, options.camera); });
}

// OpenGL's bottom row first to the files' top row first.
template <typename T>
void flip_rows(std::vector<T>& texels, int width, int height)
{
    for (int y = 0; y < height / 2; ++y)
        std::swap_ranges(texels.begin() + std::ptrdiff_t(y) * width, texels.begin() + std::ptrdiff_t(y + 1) * width,
                         texels.begin() + std::ptrdiff_t(height - 1 - y) * width);
}

}  // namespace

App::App(int argc, char** argv, ProgramInfo info)
    : info_(std::move(info)),
      options_(parse_options(argc, argv, info_)),
      scene_(scene_of(options_, info_)),
      context_(options_.headless ? Context::headless(options_.device) : Context::window(info_.name, options_.size)),
      shaders_(options_.root / "shaders"),
      timer_(context_.is_software() ? PassTimer::Clock::cpu_around_finish : PassTimer::Clock::gpu_queries),
      camera_(camera_of(scene_, options_)),
      size_(options_.size),
      view_index_(index_of(info_.views, options_.view))
{
    for (const std::string& warning : scene_.warnings)
        std::cerr << options_.scene.filename().string() << ": note: " << warning << "\n";
    statistics_.set_run(info_.name, context_.driver(), size_);
    statistics_.add_needs({camera_need(scene_, options_.camera.index)});
    // The book's conventions for every pass: depth 1 near and 0 far, stored as float without loss.
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    if (context_.glfw_window() != nullptr) start_window();
}

App::~App() = default;

void App::place_light(const LightChoice& choice)
{
    place_lights(scene_, {choice});
    const auto same = std::find_if(options_.lights.begin(), options_.lights.end(),
                                   [&](const LightChoice& other) { return other.index == choice.index; });
    if (same == options_.lights.end()) {
        options_.lights.push_back(choice);
        return;
    }
    LightChoice& kept = *same;
    if (choice.intensity) kept.intensity = choice.intensity;
    if (choice.position) kept.position = choice.position;
    if (choice.direction) kept.direction = choice.direction;
}

void App::each_frame(const std::function<void()>& draw)
{
    while (next_frame()) {
        try {
            draw();
        } catch (const GivenUp&) {
            --frame_;
            seen_.forget();  // the mean of frames lacks this one
        } catch (const std::exception& fault) {
            if (!undo_values(fault)) throw;
            --frame_;
            seen_.forget();
        }
    }
}

bool App::next_frame()
{
    ++frame_;
    accumulates_ = expects_more_ = false;
    if ((options_.frames_given || window_ == nullptr) && frame_ >= options_.frames) return false;
    return window_ == nullptr || next_window_frame();
}

void App::time_pass(const std::string& name, Scope scope, const std::function<bool()>& work)
{
    if (window_ != nullptr)
        time_pass_in_window(name, scope, work);
    else
        timer_.time(name, scope, work, statistics_);
}

int App::sample(bool accumulate, Revision light)
{
    const bool changed =
        seen_.differs(camera_.world_from_camera, size_, view_index_, info_.parameters.values(), accumulate, light);
    accumulates_ = accumulate && view().encoding == Encoding::radiance;
    sample_ = accumulates_ && !changed ? sample_ + 1 : 0;
    return sample_;
}

shared::CameraData App::camera() const
{
    // Halton's points (pbrt 4ed, 8.6.1)
    const glm::vec2 offset(float(radical_inverse(2, unsigned(sample_))), float(radical_inverse(3, unsigned(sample_))));
    return moved(camera_data(camera_, size_, bounds_with_objects(scene_)), offset - glm::round(offset));
}

void App::follow(const std::vector<Camera>& cameras)
{
    const CameraChoice& choice = options_.camera;
    if (cameras.empty() || window_ != nullptr || choice.position || choice.orientation) return;
    camera_.world_from_camera = cameras[std::size_t(choice.index.value_or(0))].world_from_camera;
}

const View& App::view() const { return info_.views[view_index_]; }

void App::write_picture(const std::filesystem::path& file, const gl::Texture& linear, const gl::Texture& display) const
{
    const ImageF radiance = finite_picture(linear, file);
    if (file.extension() == ".exr") {
        write_exr(file, radiance);
        return;
    }
    const glm::ivec2 size = linear.size_2d();
    std::vector<std::uint32_t> texels(std::size_t(size.x) * std::size_t(size.y));
    glGetTextureImage(display.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(texels.size() * 4), texels.data());
    flip_rows(texels, size.x, size.y);
    Image8 picture{size.x, size.y, std::vector<std::uint8_t>(texels.size() * 4)};
    std::memcpy(picture.rgba.data(), texels.data(), picture.rgba.size());
    write_png(file, picture);
}

void App::show(const gl::Texture& linear, const gl::Texture& display)
{
    linear_ = &linear;
    display_ = &display;
    timer_.end_frame(statistics_);
    if (window_ != nullptr) show_in_window(display);
}

int App::finish()
{
    glFinish();
    timer_.finish(statistics_);
    std::vector<std::string> faults = debug_log_.faults();
    if (faults.empty()) {
        if (linear_ != nullptr && !options_.output.empty()) write_picture(options_.output, *linear_, *display_);
        faults = debug_log_.faults();
    }
    if (!faults.empty()) throw std::runtime_error(faults.front());
    if (!options_.stats.empty()) statistics_.write_json(options_.stats);
    if (!options_.save_preset.empty())
        write_preset(options_.save_preset, info_.parameters,
                     {view().name, choice_of(scene_, options_.camera.index, camera_), options_.lights});
    if (options_.print_stats) std::cout << statistics_.table();
    return EXIT_SUCCESS;
}

ImageF finite_picture(const gl::Texture& linear, const std::filesystem::path& file)
{
    const glm::ivec2 size = linear.size_2d();
    ImageF picture{size.x, size.y, {}};
    const std::vector<float> floats = gl::read_floats(linear, 0, 4);
    for (const float value : floats)
        if (!std::isfinite(value))
            throw std::runtime_error(file.string() + ": not written, the picture holds a value that is not finite");
    picture.pixels.resize(floats.size() / 4);
    std::memcpy(picture.pixels.data(), floats.data(), floats.size() * sizeof(float));
    flip_rows(picture.pixels, size.x, size.y);
    return picture;
}

int report_failure(const std::exception& error)
{
    if (const auto* exit = dynamic_cast<const ExitRequest*>(&error)) return exit->code;
    // One line, so that the fault cannot scroll away; a driver may have more to say of a shader.
    const std::string all = error.what();
    const std::size_t end = all.find('\n');
    std::cerr << all.substr(0, end);
    if (end != std::string::npos)
        std::cerr << " (and " << std::count(all.begin() + std::ptrdiff_t(end), all.end(), '\n') << " more)";
    std::cerr << "\n";
    return EXIT_FAILURE;
}

}  // namespace conebook
