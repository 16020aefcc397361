#include "app/window.hpp"

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
    glfwSetScrollCallback(window_, on_scroll);
    glfwSetWindowRefreshCallback(window_, on_refresh);
}

void WindowInput::on_key(GLFWwindow* window, int key, int, int action, int)
{
    if (action != GLFW_PRESS) return;
    WindowInput& input = input_of(window);
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
    if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS) input.turned_ += cursor - input.last_cursor_;
    input.last_cursor_ = cursor;
}

void WindowInput::on_scroll(GLFWwindow* window, double, double y)
{
    input_of(window).speed_m_per_s_ *= std::pow(1.2f, float(y));
}

void WindowInput::on_refresh(GLFWwindow* window) { input_of(window).requests_.show_again = true; }

void WindowInput::move()
{
    const auto is_down = [&](int key) { return glfwGetKey(window_, key) == GLFW_PRESS; };
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

void WindowInput::present(const gl::Texture& display) const
{
    const glm::ivec2 from = display.size_2d(), to = framebuffer_size();
    glNamedFramebufferTexture(read_framebuffer_.id(), GL_COLOR_ATTACHMENT0, display.id(), 0);
    glBlitNamedFramebuffer(read_framebuffer_.id(), 0, 0, 0, from.x, from.y, 0, 0, to.x, to.y, GL_COLOR_BUFFER_BIT,
                           from == to ? GL_NEAREST : GL_LINEAR);
    glfwSwapBuffers(window_);
}

void WindowInput::set_title(const std::string& title)
{
    if (title != title_) glfwSetWindowTitle(window_, title.c_str());
    title_ = title;
}

}  // namespace conebook
