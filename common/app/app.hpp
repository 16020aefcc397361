// The frame loop that every chapter shares: command line, context, scene, camera, timing, pictures, exit code.
//
//     app.each_frame([&] {
//         app.pass("g-buffer", [&] { ... });
//         app.show(linear, display);
//     });
//     return app.finish();
//
// In a window the frames follow the reader (app_window.cpp): coarse ones while something moves, then finer ones, then
// none. A frame whose picture nobody wants any more ends in a call of the App's or between the slices of a draw, as if
// it had never begun.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/context.hpp"
#include "app/options.hpp"
#include "app/panel.hpp"
#include "app/pass_timer.hpp"
#include "app/statistics.hpp"
#include "app/window.hpp"
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
    Scene& scene() { return scene_; }  // its bounds stay
    gl::Shaders& shaders() { return shaders_; }

    // In a window: what there is to see, and follows the reader, until the first frame is done. `draw` makes a picture
    // for camera(), size() and view() and must be fast.
    void show_meanwhile(std::function<const gl::Texture&()> draw);

    // Adds a part of a chapter's own to the window's panel. Without a window, nothing.
    void add_panel_section(PanelSection section);
    // The window's keys and mouse, where they are neither the panel's nor the camera's. Without a window, nothing.
    void on_input(std::function<bool(const InputEvent&)> handler);
    // One of the scene's lights as a preset would place it; --save-preset keeps it.
    void place_light(const LightChoice& choice);

    // Draws frame after frame, until the last one is done or the window is closed.
    void each_frame(const std::function<void()>& draw);
    // The same by hand, without a window: starts a frame; false when the last one is done.
    bool next_frame();
    int frame() const { return frame_; }       // 0, 1, 2, ...
    glm::ivec2 size() const { return size_; }  // of the picture in pixels; in a window another one from frame to frame
    shared::CameraData camera() const;         // this frame's
    // How many pictures of the same thing there have been since camera, view, size, a parameter or `light` changed: 0 for the
    // first. Always 0 without `accumulate`, and for views that show no light. Each such sample has a camera of its own, moved
    // by less than a pixel.
    int sample(bool accumulate, Revision light);
    // This frame's picture is not the last word, though nothing changes: a window draws another.
    void expect_more() { expects_more_ = true; }
    const Camera& scene_camera() const { return camera_; }  // the same, as the path tracer takes it
    // The scene's cameras have moved, and this one with them; but not where a preset has placed it, or in a window, where
    // the reader has it.
    void follow(const std::vector<Camera>& cameras);
    void move_camera(const glm::mat4& world_from_camera) { camera_.world_from_camera = world_from_camera; }
    const View& view() const;                               // this frame's
    bool shows(const std::string& view_name) const { return view().name == view_name; }

    // Do and time one pass (pass_timer.hpp), which must not time another.
    // `work` may return whether it had anything to do; what did not run is not in the statistics.
    template <typename Work>
    void pass(const std::string& name, Scope scope, Work work)
    {
        time_pass(name, scope, [&] {
            if constexpr (std::is_void_v<decltype(work())>) {
                work();
                return true;
            } else {
                return work();
            }
        });
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
    struct GivenUp {};  // thrown through a frame that nobody wants any more
    void time_pass(const std::string& name, Scope scope, const std::function<bool()>& work);
    void write_picture(const std::filesystem::path& file, const gl::Texture& linear, const gl::Texture& display) const;

    // In a window alone:
    void start_window();
    bool next_window_frame();
    bool take_requests();
    bool is_outdated() const;
    void look_after_window();
    void time_pass_in_window(const std::string& name, Scope scope, const std::function<bool()>& work);
    bool undo_values(const std::exception& fault);
    void build_panel();
    void refresh_panel();
    void show_meanwhile_again();
    void show_in_window(const gl::Texture& display);
    void save_screenshot();
    void set_title(const std::string& doing);
    void trace(const char* what);

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
    bool accumulates_ = false, expects_more_ = false;  // this frame
    MadeFrom<glm::mat4, glm::ivec2, std::size_t, ParameterValues, bool, Revision> seen_;
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
