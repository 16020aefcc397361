// An OpenGL 4.5 core context: of a GLFW window, or of EGL without a display.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

struct GLFWwindow;

namespace conebook {

class Context {
public:
    // Throws std::runtime_error when there is no display (window) or no OpenGL 4.5 driver. The context is current.
    static Context window(const std::string& title, glm::ivec2 size);
    // On the device that `device` chooses: its number in device_listing(), or a part of its renderer's name. Where it is
    // empty, $CONEBOOK_DEVICE chooses; where that is too, the first GPU that gives a context, or else the CPU.
    static Context headless(const std::string& device = "");
    // What headless() can choose from, one line each: number, driver or why there is no context, kind of device.
    static std::string device_listing();
    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;
    ~Context();

    GLFWwindow* glfw_window() const;  // null when headless
    std::string driver() const;       // renderer and version, as OpenGL names them
    bool is_software() const;         // the CPU draws

private:
    struct State;
    struct Device;
    static std::vector<Device> devices();
    static Context on_device(const Device& device);
    explicit Context(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace conebook
