#include "app/context.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace conebook {

namespace {

// Parts of the names of renderers that run on the CPU: Mesa's three, and Windows's under WSL.
constexpr const char* kSoftwareRenderers[] = {"llvmpipe", "softpipe", "SWR", "Microsoft Basic Render Driver"};

std::string gl_string(GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); }

}  // namespace

struct Context::State {
    GLFWwindow* window = nullptr;
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext egl_context = EGL_NO_CONTEXT;
    bool glfw_started = false;
    ~State()
    {
        if (window != nullptr) glfwDestroyWindow(window);
        if (glfw_started) glfwTerminate();
        if (egl_context != EGL_NO_CONTEXT) {
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
            eglDestroyContext(display, egl_context);
        }
        if (display != EGL_NO_DISPLAY) eglTerminate(display);
    }
};

Context::Context(std::unique_ptr<State> state) : state_(std::move(state)) {}
Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;
Context::~Context() = default;

GLFWwindow* Context::glfw_window() const { return state_->window; }

std::string Context::driver() const { return gl_string(GL_RENDERER) + ", " + gl_string(GL_VERSION); }

bool Context::is_software() const
{
    const std::string renderer = gl_string(GL_RENDERER);
    return std::any_of(std::begin(kSoftwareRenderers), std::end(kSoftwareRenderers),
                       [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

Context Context::window(const std::string& title, glm::ivec2 size)
{
    auto state = std::make_unique<State>();
    glfwSetErrorCallback([](int, const char*) {});
    if (glfwInit() == GLFW_FALSE)
        throw std::runtime_error("no display for a window (is DISPLAY or WAYLAND_DISPLAY set?); use --headless");
    state->glfw_started = true;
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
    state->window = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (state->window == nullptr) throw std::runtime_error("the display's driver gives no OpenGL 4.5 core context");
    glfwMakeContextCurrent(state->window);
    return Context(std::move(state));
}

Context Context::headless()
{
    auto state = std::make_unique<State>();
    // Surfaceless works without DISPLAY and XDG_RUNTIME_DIR; the core entry point eglGetPlatformDisplay would need
    // EGL 1.5 before a display exists, so the extension's is used.
    state->display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (state->display == EGL_NO_DISPLAY || eglInitialize(state->display, nullptr, nullptr) == EGL_FALSE)
        throw std::runtime_error("EGL gives no display without a screen (Debian packages libegl1, libgl1-mesa-dri)");
    eglBindAPI(EGL_OPENGL_API);
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 EGL_TRUE,
                                 EGL_NONE};
    state->egl_context = eglCreateContext(state->display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (state->egl_context == EGL_NO_CONTEXT) throw std::runtime_error("EGL gives no OpenGL 4.5 core context");
    if (eglMakeCurrent(state->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state->egl_context) == EGL_FALSE)
        throw std::runtime_error("EGL cannot make its context current without a surface");
    return Context(std::move(state));
}

}  // namespace conebook
