#include "app/app.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include "app/needs.hpp"
#include "app/window.hpp"

namespace conebook {

struct App::Window {
    WindowInput input;
    WindowRequests requests;
    int screenshots = 0;
};

namespace {

std::size_t index_of(const std::vector<View>& views, const std::string& name)
{
    std::size_t i = 0;
    while (views[i].name != name) ++i;
    return i;
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
      scene_(load_scene(options_.scene)),
      context_(options_.headless ? Context::headless(options_.device) : Context::window(info_.name, options_.size)),
      shaders_(options_.root / "shaders"),
      timer_(context_.is_software() ? PassTimer::Clock::cpu_around_finish : PassTimer::Clock::gpu_queries),
      camera_(choose_camera(scene_, options_.camera)),
      size_(options_.size),
      view_index_(index_of(info_.views, options_.view))
{
    for (const std::string& warning : scene_.warnings)
        std::cerr << options_.scene.filename().string() << ": note: " << warning << "\n";
    statistics_.set_run(info_.name, context_.driver(), size_);
    statistics_.add_needs({camera_need(scene_, options_.camera)});
    // The book's conventions for every pass: depth 1 near and 0 far, stored as float without loss.
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    if (context_.glfw_window() != nullptr) {
        std::cerr << info_.name << ": drawn by " << context_.driver() << "\n";
        window_ = std::unique_ptr<Window>(
            new Window{WindowInput(context_.glfw_window(), camera_, scene_.bounds), {}, 0});
    }
}

App::~App() = default;

bool App::next_frame()
{
    ++frame_;
    if (window_ == nullptr) return frame_ < options_.frames;
    if (options_.frames_given && frame_ >= options_.frames) return false;
    window_->requests = window_->input.poll(camera_);
    const WindowRequests& requests = window_->requests;
    if (requests.close) return false;
    if (requests.next_view) view_index_ = (view_index_ + 1) % info_.views.size();
    if (requests.view && *requests.view < info_.views.size()) view_index_ = *requests.view;
    if (requests.reload_shaders) {
        try {
            shaders_.reload();
        } catch (const std::exception& error) {
            std::cerr << error.what() << "\n";  // the old programs go on, so the reader can correct the file
        }
    }
    size_ = window_->input.framebuffer_size();
    return true;
}

namespace {

// Van der Corput's radical inverse: the first two, of bases 2 and 3, are Halton's points.
float radical_inverse(int base, int i)
{
    float value = 0.0f, digit = 1.0f / float(base);
    for (; i > 0; i /= base, digit /= float(base)) value += digit * float(i % base);
    return value;
}

}  // namespace

int App::sample(bool accumulate, Revision light)
{
    const bool changed = seen_.differs(camera_.world_from_camera, size_, view_index_, info_.parameters.values(), accumulate, light);
    sample_ = accumulate && !changed && view().encoding == Encoding::radiance ? sample_ + 1 : 0;
    return sample_;
}

shared::CameraData App::camera() const
{
    const glm::vec2 offset(radical_inverse(2, sample_), radical_inverse(3, sample_));
    return moved(camera_data(camera_, size_, scene_.bounds), offset - glm::round(offset));
}

const View& App::view() const { return info_.views[view_index_]; }

void App::write_picture(const gl::Texture& linear, const gl::Texture& display) const
{
    const ImageF radiance = finite_picture(linear, options_.output);
    if (options_.output.extension() == ".exr") {
        write_exr(options_.output, radiance);
        return;
    }
    const glm::ivec2 size = linear.size_2d();
    std::vector<std::uint32_t> texels(std::size_t(size.x) * std::size_t(size.y));
    glGetTextureImage(display.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(texels.size() * 4), texels.data());
    flip_rows(texels, size.x, size.y);
    Image8 picture{size.x, size.y, std::vector<std::uint8_t>(texels.size() * 4)};
    std::memcpy(picture.rgba.data(), texels.data(), picture.rgba.size());
    write_png(options_.output, picture);
}

void App::show(const gl::Texture& linear, const gl::Texture& display)
{
    linear_ = &linear;
    display_ = &display;
    timer_.end_frame(statistics_);
    if (window_ == nullptr) return;
    window_->input.present(display);
    if (window_->requests.screenshot) {
        const Options saved = options_;
        options_.output = info_.name + "_" + std::to_string(window_->screenshots++) + ".png";
        write_picture(linear, display);
        std::cout << "screenshot: " << std::filesystem::absolute(options_.output).string() << "\n";
        options_ = saved;
    }
}

int App::finish()
{
    glFinish();
    timer_.finish(statistics_);
    std::vector<std::string> faults = debug_log_.faults();
    if (faults.empty()) {
        if (linear_ != nullptr && !options_.output.empty()) write_picture(*linear_, *display_);
        faults = debug_log_.faults();
    }
    if (!faults.empty()) throw std::runtime_error(faults.front());
    if (!options_.stats.empty()) statistics_.write_json(options_.stats);
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
