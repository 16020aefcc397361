// An OpenGL 4.5 core context: of a GLFW window, or of EGL without a display.
#pragma once

#include <memory>
#include <string>

#include <glm/glm.hpp>

struct GLFWwindow;

namespace conebook {

class Context {
public:
    // Throws std::runtime_error when there is no display (window) or no OpenGL 4.5 driver. The context is current.
    static Context window(const std::string& title, glm::ivec2 size);
    static Context headless();
    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;
    ~Context();

    GLFWwindow* glfw_window() const;  // null when headless
    std::string driver() const;       // renderer and version, as OpenGL names them
    bool is_software() const;         // the CPU draws

private:
    struct State;
    explicit Context(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace conebook
