// The window's side of the frame loop: free camera, keys, showing the picture and the panel over it.
#pragma once

#include <bitset>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/panel.hpp"
#include "gl/handles.hpp"
#include "scene/scene.hpp"

struct GLFWwindow;

namespace conebook {

// What a chapter's own keys and mouse get: what neither the panel takes nor the camera. It comes between the slices of a
// pass, so whoever takes it changes a copy, as a section of the panel does, and must not throw.
struct InputEvent {
    enum class Kind { key, press, drag, release };  // of a key, also while it is held; of the left button
    Kind kind = Kind::key;
    int key = 0;          // GLFW_KEY_...
    glm::dvec2 at{0.0};   // where the cursor is, 0 .. 1 from the picture's top left corner
    double aspect = 1.0;  // the picture's width over its height
};

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
    std::optional<ParameterValues> values;       // by the panel
    bool section = false;                        // a section of the panel, or a chapter's input, has changed something
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

    // While the window has a panel. F1 shows and hides it.
    void set_panel(Panel* panel) { panel_ = panel; }
    bool shows_panel() const { return panel_ != nullptr && panel_is_shown_; }
    // Whether something has happened since the last call that the panel answers.
    bool take_panel_events() { return std::exchange(panel_events_, false); }
    // Who gets the events that are the chapter's; it says whether that has changed anything.
    void set_handler(std::function<bool(const InputEvent&)> handler) { handler_ = std::move(handler); }
    // What the reader did in the panel.
    void add(const PanelChanges& changes);

    glm::ivec2 framebuffer_size() const;
    // Over the whole window, whatever size `display` has; and over it the panel as it was built.
    void present(const gl::Texture& display);
    // The last picture once more; nothing before there was one. Leaves OpenGL's state as it was.
    void present_again();
    void set_title(const std::string& title);

    static constexpr std::size_t kMovingKeyCount = 6;

private:
    void move();
    void note_panel_event();
    void hand_on(InputEvent::Kind kind, int key = 0);
    bool panel_has_keyboard() const { return shows_panel() && panel_->has_keyboard(); }
    bool panel_has_mouse() const { return shows_panel() && panel_->has_mouse(); }
    static void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
    static void on_cursor(GLFWwindow* window, double x, double y);
    static void on_button(GLFWwindow* window, int button, int action, int modifiers);
    static void on_character(GLFWwindow* window, unsigned int character);
    static void on_scroll(GLFWwindow* window, double x, double y);
    static void on_refresh(GLFWwindow* window);

    GLFWwindow* window_;
    WindowRequests requests_;
    std::string title_;
    Panel* panel_ = nullptr;
    std::function<bool(const InputEvent&)> handler_;
    bool panel_is_shown_ = true, panel_events_ = false;
    bool dragging_ = false;  // the left button went down beside the panel, and is down
    gl::Texture shown_;      // the last picture
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
