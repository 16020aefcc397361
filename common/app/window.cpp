#include "app/window.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <glm/gtc/constants.hpp>

namespace conebook {

namespace {

// Rotation first about y (yaw), then about the camera's x (pitch); yaw 0 looks along -z.
glm::mat4 world_from_camera(glm::vec3 position, float yaw_rad, float pitch_rad)
{
    const glm::vec3 forward(-std::sin(yaw_rad) * std::cos(pitch_rad), std::sin(pitch_rad),
                            -std::cos(yaw_rad) * std::cos(pitch_rad));
    const glm::vec3 right(std::cos(yaw_rad), 0.0f, -std::sin(yaw_rad));
    const glm::vec3 up = glm::cross(right, forward);
    return {glm::vec4(right, 0.0f), glm::vec4(up, 0.0f), glm::vec4(-forward, 0.0f), glm::vec4(position, 1.0f)};
}

struct MovingKey {
    int key;
    glm::vec3 direction;  // camera space
};
constexpr MovingKey kMovingKeys[WindowInput::kMovingKeyCount] = {
    {GLFW_KEY_D, {1.0f, 0.0f, 0.0f}},  {GLFW_KEY_A, {-1.0f, 0.0f, 0.0f}}, {GLFW_KEY_E, {0.0f, 1.0f, 0.0f}},
    {GLFW_KEY_Q, {0.0f, -1.0f, 0.0f}}, {GLFW_KEY_S, {0.0f, 0.0f, 1.0f}},  {GLFW_KEY_W, {0.0f, 0.0f, -1.0f}}};

WindowInput& input_of(GLFWwindow* window) { return *static_cast<WindowInput*>(glfwGetWindowUserPointer(window)); }

}  // namespace

WindowInput::WindowInput(GLFWwindow* window, const Camera& start, const Bounds& bounds) : window_(window)
{
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    read_framebuffer_ = gl::Handle<gl::delete_framebuffer>(id);
    position_ = glm::vec3(start.world_from_camera[3]);
    const glm::vec3 forward = -glm::vec3(start.world_from_camera[2]);
    yaw_rad_ = std::atan2(-forward.x, -forward.z);
    pitch_rad_ = std::asin(glm::clamp(forward.y, -1.0f, 1.0f));
    speed_m_per_s_ = 0.25f * bounds.longest_side();
    last_time_s_ = glfwGetTime();
    glfwGetCursorPos(window_, &last_cursor_.x, &last_cursor_.y);
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, on_key);
    glfwSetCursorPosCallback(window_, on_cursor);
    glfwSetMouseButtonCallback(window_, on_button);
    glfwSetCharCallback(window_, on_character);
    glfwSetScrollCallback(window_, on_scroll);
    glfwSetWindowRefreshCallback(window_, on_refresh);
}

void WindowInput::note_panel_event()
{
    if (shows_panel() && panel_->concerns(last_cursor_)) panel_events_ = true;
}

void WindowInput::on_key(GLFWwindow* window, int key, int, int action, int)
{
    WindowInput& input = input_of(window);
    const bool for_panel = input.panel_has_keyboard();
    if (for_panel) input.note_panel_event();
    if (action == GLFW_RELEASE || for_panel) return;
    input.hand_on(InputEvent::Kind::key, key);
    if (action != GLFW_PRESS) return;
    if (key == GLFW_KEY_F1) {
        input.panel_is_shown_ = !input.panel_is_shown_;
        input.panel_events_ = true;
    }
    WindowRequests& requests = input.requests_;
    for (std::size_t i = 0; i < kMovingKeyCount; ++i)
        if (key == kMovingKeys[i].key) input.tapped_[i] = true;
    if (key == GLFW_KEY_ESCAPE) requests.close = true;
    if (key == GLFW_KEY_R) requests.reload_shaders = true;
    if (key == GLFW_KEY_P) requests.screenshot = true;
    if (key == GLFW_KEY_TAB) ++requests.views_on;
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
        requests.view = std::size_t(key - GLFW_KEY_1);
        requests.views_on = 0;
    }
}

void WindowInput::on_cursor(GLFWwindow* window, double x, double y)
{
    WindowInput& input = input_of(window);
    const glm::dvec2 cursor(x, y);
    const bool turns = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS && !input.panel_has_mouse();
    if (turns) input.turned_ += cursor - input.last_cursor_;
    input.last_cursor_ = cursor;
    if (!turns) input.note_panel_event();
    if (input.dragging_) input.hand_on(InputEvent::Kind::drag);
}

void WindowInput::on_button(GLFWwindow* window, int button, int action, int)
{
    WindowInput& input = input_of(window);
    input.note_panel_event();
    if (button != GLFW_MOUSE_BUTTON_LEFT) return;
    if (action == GLFW_PRESS && !input.panel_has_mouse()) {
        input.dragging_ = true;
        input.hand_on(InputEvent::Kind::press);
    } else if (action == GLFW_RELEASE && std::exchange(input.dragging_, false)) {
        input.hand_on(InputEvent::Kind::release);
    }
}

void WindowInput::hand_on(InputEvent::Kind kind, int key)
{
    if (!handler_) return;
    int width = 1, height = 1;
    glfwGetWindowSize(window_, &width, &height);
    const glm::dvec2 size(std::max(width, 1), std::max(height, 1));
    requests_.section = handler_({kind, key, last_cursor_ / size, size.x / size.y}) || requests_.section;
    panel_events_ = true;  // which may show it
}

void WindowInput::on_character(GLFWwindow* window, unsigned int) { input_of(window).note_panel_event(); }

void WindowInput::on_scroll(GLFWwindow* window, double, double y)
{
    WindowInput& input = input_of(window);
    if (input.panel_has_mouse())
        input.note_panel_event();
    else
        input.speed_m_per_s_ *= std::pow(1.2f, float(y));
}

void WindowInput::on_refresh(GLFWwindow* window) { input_of(window).requests_.show_again = true; }

void WindowInput::move()
{
    const auto is_down = [&](int key) { return glfwGetKey(window_, key) == GLFW_PRESS && !panel_has_keyboard(); };
    const double now_s = glfwGetTime();
    const double since_last_s = now_s - std::exchange(last_time_s_, now_s);
    // The window may have slept, and a key may be up again: how long it was down is not known, so it counts as this.
    constexpr double kTap_s = 0.05;
    glm::vec3 step_s(0.0f);  // camera space, seconds along each axis
    for (std::size_t i = 0; i < kMovingKeyCount; ++i) {
        const bool down = is_down(kMovingKeys[i].key);
        const double held_s = down && was_down_[i] ? since_last_s : down || tapped_[i] ? kTap_s : 0.0;
        step_s += float(held_s) * kMovingKeys[i].direction;
        was_down_[i] = down;
    }
    tapped_.reset();
    constexpr float kRadPerPixel = 0.004f;
    const glm::vec2 turn = kRadPerPixel * glm::vec2(std::exchange(turned_, glm::dvec2(0.0)));

    // The file's camera stays as it is until the reader moves it.
    if (step_s == glm::vec3(0.0f) && turn == glm::vec2(0.0f)) return;
    if (turn != glm::vec2(0.0f)) {
        yaw_rad_ -= turn.x;
        pitch_rad_ = glm::clamp(pitch_rad_ - turn.y, -0.49f * glm::pi<float>(), 0.49f * glm::pi<float>());
    }
    const float speed = speed_m_per_s_ * (is_down(GLFW_KEY_LEFT_SHIFT) ? 4.0f : 1.0f);
    const glm::mat4 turned = world_from_camera(position_, yaw_rad_, pitch_rad_);
    position_ += glm::mat3(turned) * step_s * speed;
    requests_.world_from_camera = world_from_camera(position_, yaw_rad_, pitch_rad_);
}

void WindowInput::poll()
{
    glfwPollEvents();
    move();
    requests_.close = requests_.close || glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void WindowInput::wait(double seconds)
{
    glfwWaitEventsTimeout(seconds);
    poll();
}

WindowRequests WindowInput::take() { return std::exchange(requests_, {}); }

glm::ivec2 WindowInput::framebuffer_size() const
{
    glm::ivec2 size;
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    return glm::max(size, glm::ivec2(1));
}

void WindowInput::present(const gl::Texture& display)
{
    const glm::ivec2 size = display.size_2d();
    if (!shown_ || shown_.size_2d() != size) shown_ = gl::texture_2d("shown", GL_RGBA8, size);
    glCopyImageSubData(display.id(), GL_TEXTURE_2D, 0, 0, 0, 0, shown_.id(), GL_TEXTURE_2D, 0, 0, 0, 0, size.x, size.y,
                       1);
    present_again();
}

void WindowInput::present_again()
{
    if (!shown_) return;
    GLint framebuffer = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    const bool rows_only = glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE;  // between the slices of a draw
    glDisable(GL_SCISSOR_TEST);
    const glm::ivec2 from = shown_.size_2d(), to = framebuffer_size();
    glNamedFramebufferTexture(read_framebuffer_.id(), GL_COLOR_ATTACHMENT0, shown_.id(), 0);
    glBlitNamedFramebuffer(read_framebuffer_.id(), 0, 0, 0, from.x, from.y, 0, 0, to.x, to.y, GL_COLOR_BUFFER_BIT,
                           from == to ? GL_NEAREST : GL_LINEAR);
    if (shows_panel()) {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        panel_->draw();
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(framebuffer));
    }
    if (rows_only) glEnable(GL_SCISSOR_TEST);
    glfwSwapBuffers(window_);
}

void WindowInput::add(const PanelChanges& changes)
{
    if (changes.view) {
        requests_.view = changes.view;
        requests_.views_on = 0;
    }
    if (changes.values) requests_.values = changes.values;
    requests_.section = requests_.section || changes.section;
}

void WindowInput::set_title(const std::string& title)
{
    if (title != title_) glfwSetWindowTitle(window_, title.c_str());
    title_ = title;
}

}  // namespace conebook
