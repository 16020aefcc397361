// The window's side of the frame loop: free camera, keys, showing the picture. Tools such as a panel belong here.
#pragma once

#include <optional>

#include "gl/handles.hpp"
#include "scene/scene.hpp"

struct GLFWwindow;

namespace conebook {

// What the keys asked for since the last frame.
struct WindowRequests {
    bool close = false;
    bool reload_shaders = false;
    bool screenshot = false;
    std::optional<std::size_t> view;  // by number key
    bool next_view = false;           // Tab
};

// Free camera: WASD and QE move, the right mouse button turns, Shift is faster, the wheel changes the speed.
class WindowInput {
public:
    WindowInput(GLFWwindow* window, const Camera& start, const Bounds& bounds);
    WindowInput(const WindowInput&) = delete;
    WindowInput& operator=(const WindowInput&) = delete;
    WindowRequests poll(Camera& camera);
    glm::ivec2 framebuffer_size() const;
    void present(const gl::Texture& display) const;

private:
    void move(Camera& camera, float seconds);
    static void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
    static void on_scroll(GLFWwindow* window, double x, double y);

    GLFWwindow* window_;
    WindowRequests requests_;
    gl::Handle<gl::delete_framebuffer> read_framebuffer_;
    glm::vec3 position_{0.0f};
    float yaw_rad_ = 0.0f, pitch_rad_ = 0.0f;
    float speed_m_per_s_ = 1.0f;
    glm::dvec2 last_cursor_{0.0};
    double last_time_s_ = 0.0;
};

}  // namespace conebook
