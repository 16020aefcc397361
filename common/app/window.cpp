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
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, on_key);
    glfwSetScrollCallback(window_, on_scroll);
}

void WindowInput::on_key(GLFWwindow* window, int key, int, int action, int)
{
    if (action != GLFW_PRESS) return;
    WindowRequests& requests = static_cast<WindowInput*>(glfwGetWindowUserPointer(window))->requests_;
    if (key == GLFW_KEY_ESCAPE) requests.close = true;
    if (key == GLFW_KEY_R) requests.reload_shaders = true;
    if (key == GLFW_KEY_P) requests.screenshot = true;
    if (key == GLFW_KEY_TAB) requests.next_view = true;
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) requests.view = std::size_t(key - GLFW_KEY_1);
}

void WindowInput::on_scroll(GLFWwindow* window, double, double y)
{
    static_cast<WindowInput*>(glfwGetWindowUserPointer(window))->speed_m_per_s_ *= std::pow(1.2f, float(y));
}

void WindowInput::move(Camera& camera, float seconds)
{
    const auto down = [&](int key) { return glfwGetKey(window_, key) == GLFW_PRESS; };
    glm::dvec2 cursor;
    glfwGetCursorPos(window_, &cursor.x, &cursor.y);
    const bool turning = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    if (turning) {
        constexpr float kRadPerPixel = 0.004f;
        yaw_rad_ -= kRadPerPixel * float(cursor.x - last_cursor_.x);
        pitch_rad_ -= kRadPerPixel * float(cursor.y - last_cursor_.y);
        pitch_rad_ = glm::clamp(pitch_rad_, -0.49f * glm::pi<float>(), 0.49f * glm::pi<float>());
    }
    last_cursor_ = cursor;
    glm::vec3 step(0.0f);  // camera space
    step.x = float(down(GLFW_KEY_D)) - float(down(GLFW_KEY_A));
    step.y = float(down(GLFW_KEY_E)) - float(down(GLFW_KEY_Q));
    step.z = float(down(GLFW_KEY_S)) - float(down(GLFW_KEY_W));
    const bool moving = step != glm::vec3(0.0f);
    if (!moving && !turning) return;  // the file's camera stays as it is until the reader moves it
    const float speed = speed_m_per_s_ * (down(GLFW_KEY_LEFT_SHIFT) ? 4.0f : 1.0f);
    const glm::mat4 turned = world_from_camera(position_, yaw_rad_, pitch_rad_);
    position_ += glm::mat3(turned) * step * speed * seconds;
    camera.world_from_camera = world_from_camera(position_, yaw_rad_, pitch_rad_);
}

WindowRequests WindowInput::poll(Camera& camera)
{
    glfwPollEvents();
    const double now_s = glfwGetTime();
    move(camera, float(now_s - last_time_s_));
    last_time_s_ = now_s;
    requests_.close = requests_.close || glfwWindowShouldClose(window_) == GLFW_TRUE;
    return std::exchange(requests_, {});
}

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
                           GL_NEAREST);
    glfwSwapBuffers(window_);
}

}  // namespace conebook
