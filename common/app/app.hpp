// The frame loop that every chapter shares: command line, context, scene, camera, timing, pictures, exit code.
//
//     while (app.next_frame()) {
//         app.pass("g-buffer", [&] { ... });
//         app.show(linear, display);
//     }
//     return app.finish();
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/context.hpp"
#include "app/options.hpp"
#include "app/pass_timer.hpp"
#include "app/statistics.hpp"
#include "gl/debug_log.hpp"
#include "gl/gpu_scene.hpp"
#include "gl/handles.hpp"
#include "gl/shaders.hpp"
#include "image/image.hpp"
#include "scene/scene.hpp"

namespace conebook {

class App {
public:
    // Parses the command line, makes the context, loads the scene. Throws as parse_options, Context, load_scene do.
    App(int argc, char** argv, ProgramInfo info);
    ~App();

    const Options& options() const { return options_; }
    const Scene& scene() const { return scene_; }
    gl::Shaders& shaders() { return shaders_; }

    // Starts a frame; false when the last one is done or the window was closed.
    bool next_frame();
    int frame() const { return frame_; }        // 0, 1, 2, ...
    glm::ivec2 size() const { return size_; }   // of the picture in pixels; a window may change it between frames
    shared::CameraData camera() const;          // this frame's
    // How many pictures of the same thing there have been since camera, view, size, a parameter or `light` changed: 0 for the
    // first. Always 0 without `accumulate`, and for views that show no light. Each such sample has a camera of its own, moved
    // by less than a pixel.
    int sample(bool accumulate, Revision light);
    const Camera& scene_camera() const { return camera_; }  // the same, as the path tracer takes it
    const View& view() const;                   // this frame's
    bool shows(const std::string& view_name) const { return view().name == view_name; }

    // Do and time one pass (pass_timer.hpp), which must not time another.
    // `work` may return whether it had anything to do; what did not run is not in the statistics.
    template <typename Work>
    void pass(const std::string& name, Scope scope, Work work)
    {
        timer_.time(
            name, scope,
            [&] {
                if constexpr (std::is_void_v<decltype(work())>) {
                    work();
                    return true;
                } else {
                    return work();
                }
            },
            statistics_);
    }
    template <typename Work>
    void pass(const std::string& name, Work work)
    {
        pass(name, Scope::camera, work);
    }

    // The frame's picture: `linear` is what .exr gets, `display` (RGBA8, sRGB encoded) is for .png and the screen.
    void show(const gl::Texture& linear, const gl::Texture& display);

    Statistics& statistics() { return statistics_; }

    // Writes picture and statistics and gives the exit code: 0 only if no OpenGL fault was seen.
    int finish();

private:
    struct Window;
    void write_picture(const gl::Texture& linear, const gl::Texture& display) const;

    ProgramInfo info_;
    Options options_;
    Scene scene_;
    Context context_;
    gl::DebugLog debug_log_;
    gl::Shaders shaders_;
    Statistics statistics_;
    PassTimer timer_;
    Camera camera_;
    glm::ivec2 size_;
    std::size_t view_index_ = 0;
    int frame_ = -1, sample_ = 0;
    MadeFrom<glm::mat4, glm::ivec2, std::size_t, std::vector<double>, bool, Revision> seen_;
    const gl::Texture* linear_ = nullptr;
    const gl::Texture* display_ = nullptr;
    std::unique_ptr<Window> window_;  // null when headless
};

// RGBA texture of floats as a picture, top row first. Throws std::runtime_error that names `file`, which is then not to be
// written, when a value is not finite.
ImageF finite_picture(const gl::Texture& linear, const std::filesystem::path& file);

// For main's catch: prints the one line to stderr and gives the exit code.
int report_failure(const std::exception& error);

}  // namespace conebook
