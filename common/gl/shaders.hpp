// Programs from files: includes, constants set from C++, errors with the file and line of the included file, reload.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include "gl/shader_source.hpp"

namespace conebook::gl {

// A linked program. Copies share it; after Shaders::reload all of them are the new one.
class Program {
public:
    Program() = default;
    GLuint id() const;
    void use() const;
    // Uniforms by name. A name that the linked program does not use is ignored: variants leave some out.
    void set(const char* name, bool value) const;
    void set(const char* name, int value) const;
    void set(const char* name, GLuint value) const;
    void set(const char* name, float value) const;
    void set(const char* name, glm::vec2 value) const;
    void set(const char* name, glm::vec3 value) const;
    void set(const char* name, glm::vec4 value) const;
    void set(const char* name, glm::ivec2 value) const;
    void set(const char* name, glm::ivec3 value) const;
    void set(const char* name, const glm::mat4& value) const;
    void set(const char* name, const std::vector<glm::vec4>& values) const;
    // Shaders::set_between_slices; null: work with this program need not be sliced.
    const std::function<void()>& between_slices() const;

private:
    friend class Shaders;
    struct State;
    explicit Program(std::shared_ptr<State> state) : state_(std::move(state)) {}
    std::shared_ptr<State> state_;
};

class Shaders {
public:
    explicit Shaders(std::filesystem::path shader_root);
    // Compile and link; the stage follows from the extension (.vert .tesc .tese .geom .frag .comp). Paths are relative to the
    // shader root (expand_shader). Throws std::runtime_error with FILE:LINE of the fault. A warning of the compiler is
    // printed, or thrown when gl::strict(). $CONEBOOK_DUMP_SHADERS: a folder that gets the text of every shader.
    Program load(const std::vector<std::string>& files, const Defines& defines = {});
    std::size_t program_count() const;  // of those still in use
    // Compile again all programs still in use. On a fault the old programs stay and the fault is thrown.
    void reload();
    // What all programs are to do between the slices of a long draw (pixel_pass.hpp), and what load() does before
    // its work: look after a window, say. It may throw, which gives up the draw.
    void set_between_slices(std::function<void()> call) { *between_slices_ = std::move(call); }

private:
    std::filesystem::path root_;
    std::shared_ptr<std::function<void()>> between_slices_ = std::make_shared<std::function<void()>>();
    std::vector<std::weak_ptr<Program::State>> programs_;
};

// The same files compiled with different defines, each when it is first asked for.
class ProgramVariants {
public:
    // `shaders` must outlive this. Throws as Shaders::load does, when a variant is made.
    ProgramVariants(Shaders& shaders, std::vector<std::string> files) : shaders_(&shaders), files_(std::move(files)) {}
    const Program& with(const Defines& defines);

private:
    Shaders* shaders_;
    std::vector<std::string> files_;
    std::map<Defines, Program> programs_;
};

}  // namespace conebook::gl
