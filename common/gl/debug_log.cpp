#include "gl/debug_log.hpp"

#include <epoxy/gl.h>

#include "gl/strict.hpp"

namespace conebook::gl {

namespace {

void on_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei, const GLchar* message, const void* user)
{
    // Drivers call much undefined behaviour that no shader runs into, such as a sampler that is declared and not bound.
    const bool fault = severity == GL_DEBUG_SEVERITY_HIGH || type == GL_DEBUG_TYPE_ERROR ||
                       (type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR && strict());
    if (fault) static_cast<DebugLog*>(const_cast<void*>(user))->add_fault(std::string("OpenGL: ") + message);
}

}  // namespace

DebugLog::DebugLog()
{
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(on_message, this);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
}

DebugLog::~DebugLog() { glDebugMessageCallback(nullptr, nullptr); }

std::vector<std::string> DebugLog::faults() const
{
    std::vector<std::string> all = faults_;
    for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError())
        all.push_back("OpenGL: error code " + std::to_string(error));
    return all;
}

}  // namespace conebook::gl
