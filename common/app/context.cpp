#include "app/context.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace conebook {

namespace {

// Parts of the names of renderers that run on the CPU: Mesa's three, and Windows's under WSL.
constexpr const char* kSoftwareRenderers[] = {"llvmpipe", "softpipe", "SWR", "Microsoft Basic Render Driver"};

std::string lower_case(std::string text)
{
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

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
    if (state->window == nullptr) {
        const char* reason = nullptr;
        glfwGetError(&reason);
        throw std::runtime_error(std::string("the display's driver gives no OpenGL 4.5 core context") +
                                 (reason != nullptr ? std::string(": ") + reason : ""));
    }
    glfwMakeContextCurrent(state->window);
    return Context(std::move(state));
}

// One way to a context without a display.
struct Context::Device {
    EGLDeviceEXT egl = EGL_NO_DEVICE_EXT;  // none: Mesa's surfaceless platform, which chooses by itself
    std::string kind;
    bool software = false;
};

namespace {

bool has_extension(const std::string& extensions, const std::string& name)
{
    return (" " + extensions + " ").find(" " + name + " ") != std::string::npos;
}

// A function that EGL or the device lacks must not be called: libepoxy would end the program.
std::string device_string(EGLDeviceEXT device, EGLint name)
{
    const char* text = eglQueryDeviceStringEXT(device, name);
    return text != nullptr ? text : "";
}

}  // namespace

// GPUs first. Throws std::runtime_error when there is none.
std::vector<Context::Device> Context::devices()
{
    std::string client;  // the extensions that need no display
    if (epoxy_has_egl())
        if (const char* text = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS); text != nullptr) client = text;
    const auto has = [&](const char* name) { return has_extension(client, name); };
    std::vector<Device> found;
    const bool enumerable =
        has("EGL_EXT_device_base") || (has("EGL_EXT_device_enumeration") && has("EGL_EXT_device_query"));
    if (enumerable && has("EGL_EXT_platform_device") && has("EGL_EXT_platform_base")) {
        EGLDeviceEXT all[64];
        EGLint count = 0;
        if (eglQueryDevicesEXT(64, all, &count) == EGL_FALSE) count = 0;
        for (const EGLDeviceEXT device : std::span(all, std::size_t(count))) {
            const std::string extensions = device_string(device, EGL_EXTENSIONS);
            const bool software = has_extension(extensions, "EGL_MESA_device_software");
            const std::string file =
                has_extension(extensions, "EGL_EXT_device_drm") ? device_string(device, EGL_DRM_DEVICE_FILE_EXT) : "";
            found.push_back({device, software ? "CPU" : file.empty() ? "GPU" : "GPU " + file, software});
        }
        std::stable_partition(found.begin(), found.end(), [](const Device& device) { return !device.software; });
    }
    if (has("EGL_MESA_platform_surfaceless") && has("EGL_EXT_platform_base"))
        found.push_back({EGL_NO_DEVICE_EXT, "surfaceless", false});
    if (found.empty())
        throw std::runtime_error(
            "EGL has no driver that works without a display (Debian packages libegl1, libgl1-mesa-dri)");
    return found;
}

// Throws std::runtime_error with the step that failed.
Context Context::on_device(const Device& device)
{
    auto state = std::make_unique<State>();
    // The core entry point eglGetPlatformDisplay would need EGL 1.5 before a display exists, so the extension's is used.
    state->display = device.egl != EGL_NO_DEVICE_EXT
                         ? eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device.egl, nullptr)
                         : eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (state->display == EGL_NO_DISPLAY || eglInitialize(state->display, nullptr, nullptr) == EGL_FALSE)
        throw std::runtime_error("EGL cannot open it");
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
        throw std::runtime_error("its context works with a surface only");
    return Context(std::move(state));
}

Context Context::headless(const std::string& device)
{
    const char* from_environment = std::getenv("CONEBOOK_DEVICE");
    const std::string wanted = !device.empty() ? device : from_environment != nullptr ? from_environment : "";
    const std::string option = !device.empty() ? "--device " + wanted : "CONEBOOK_DEVICE=" + wanted;
    const std::vector<Device> all = devices();
    if (!wanted.empty() && wanted.find_first_not_of("0123456789") == std::string::npos) {
        const std::size_t number = wanted.size() < 4 ? std::size_t(std::stoi(wanted)) : all.size();
        if (number >= all.size())
            throw std::runtime_error(option + ": there are devices 0 .. " + std::to_string(all.size() - 1) +
                                     "; --list-devices names them");
        try {
            return on_device(all[number]);
        } catch (const std::exception& error) {
            throw std::runtime_error(option + ": " + error.what());
        }
    }
    const auto is_gpu = [&](std::size_t i) {
        return i < all.size() && !all[i].software && all[i].egl != EGL_NO_DEVICE_EXT;
    };
    std::optional<std::size_t> on_cpu;  // a device that looks like a GPU can turn out to be drawn for by the CPU
    std::string faults;
    for (std::size_t i = 0; i < all.size() && (is_gpu(i) || !on_cpu); ++i) {
        try {
            Context context = on_device(all[i]);
            if (lower_case(gl_string(GL_RENDERER)).find(lower_case(wanted)) == std::string::npos) continue;
            if (!context.is_software() || !is_gpu(i + 1)) return context;
            on_cpu = on_cpu.value_or(i);
        } catch (const std::exception& error) {
            faults += " (" + all[i].kind + ": " + error.what() + ")";
        }
    }
    if (on_cpu) return on_device(all[*on_cpu]);
    if (!wanted.empty()) throw std::runtime_error(option + ": no renderer is called so; --list-devices names them");
    throw std::runtime_error("EGL gives no context without a display" + faults);
}

std::string Context::device_listing()
{
    std::string out;
    int number = 0;
    for (const Device& device : devices()) {
        std::string name;
        try {
            name = on_device(device).driver();
        } catch (const std::exception& error) {
            name = std::string("- ") + error.what();
        }
        out += std::to_string(number++) + "\t" + name + "\t" + device.kind + "\n";
    }
    return out;
}

}  // namespace conebook
