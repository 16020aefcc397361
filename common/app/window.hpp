// The window's side of the frame loop: free camera, keys, showing the picture. Tools such as a panel belong here.
#pragma once

#include <bitset>
#include <optional>
#include <string>

#include "gl/handles.hpp"
#include "scene/scene.hpp"

struct GLFWwindow;

namespace conebook {

// What the reader asked for since the last WindowInput::take(), in the order in which it came.
struct WindowRequests {
    bool close = false;
    bool reload_shaders = false;
    bool screenshot = false;
    bool show_again = false;  // the window was covered, and its pixels are lost
    // The view of the last number key, if any, and how often Tab was pressed after it.
    std::optional<std::size_t> view;
    int views_on = 0;
    std::optional<glm::mat4> world_from_camera;  // where the camera has moved
};

// Free camera: WASD and QE move, the right mouse button turns, Shift is faster, the wheel changes the speed.
class WindowInput {
public:
    WindowInput(GLFWwindow* window, const Camera& start, const Bounds& bounds);
    WindowInput(const WindowInput&) = delete;
    WindowInput& operator=(const WindowInput&) = delete;

    // Looks what has happened, without waiting. However short a key was pressed, it counts.
    void poll();
    // The same, but sleeps until something happens, or for so long.
    void wait(double seconds);
    // All that was asked for since it was last taken.
    const WindowRequests& requests() const { return requests_; }
    WindowRequests take();

    glm::ivec2 framebuffer_size() const;
    // Over the whole window, whatever size `display` has.
    void present(const gl::Texture& display) const;
    void set_title(const std::string& title);

    static constexpr std::size_t kMovingKeyCount = 6;

private:
    void move();
    static void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
    static void on_cursor(GLFWwindow* window, double x, double y);
    static void on_scroll(GLFWwindow* window, double x, double y);
    static void on_refresh(GLFWwindow* window);

    GLFWwindow* window_;
    WindowRequests requests_;
    std::string title_;
    gl::Handle<gl::delete_framebuffer> read_framebuffer_;
    glm::vec3 position_{0.0f};
    float yaw_rad_ = 0.0f, pitch_rad_ = 0.0f;
    float speed_m_per_s_ = 1.0f;
    std::bitset<kMovingKeyCount> was_down_;  // at the last poll
    std::bitset<kMovingKeyCount> tapped_;    // went down since then
    glm::dvec2 turned_{0.0};                 // pixels that the cursor moved with the button down since then
    glm::dvec2 last_cursor_{0.0};
    double last_time_s_ = 0.0;
};

}  // namespace conebook
