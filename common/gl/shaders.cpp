#include "gl/shaders.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <stdexcept>

#include "gl/handles.hpp"
#include "gl/strict.hpp"

namespace conebook::gl {

struct Program::State {
    GLuint id = 0;
    std::vector<std::string> files;
    Defines defines;
    std::shared_ptr<const std::function<void()>> between_slices;
    ~State()
    {
        if (id != 0) glDeleteProgram(id);
    }
};

namespace {

GLenum stage_of(const std::string& file)
{
    const std::string extension = std::filesystem::path(file).extension().string();
    if (extension == ".vert") return GL_VERTEX_SHADER;
    if (extension == ".tesc") return GL_TESS_CONTROL_SHADER;
    if (extension == ".tese") return GL_TESS_EVALUATION_SHADER;
    if (extension == ".geom") return GL_GEOMETRY_SHADER;
    if (extension == ".frag") return GL_FRAGMENT_SHADER;
    if (extension == ".comp") return GL_COMPUTE_SHADER;
    throw std::runtime_error(file + ": unknown shader stage (.vert .tesc .tese .geom .frag .comp)");
}

// What the compiler or linker says of an object.
template <typename GetParameter, typename GetLog>
std::string info_log(GLuint object, GetParameter get_parameter, GetLog get_log)
{
    GLint length = 0;
    get_parameter(object, GL_INFO_LOG_LENGTH, &length);
    std::string log(std::size_t(std::max(length, 1)), '\0');
    get_log(object, length, nullptr, log.data());
    return log.c_str();
}

// Throws when `failed`. A warning goes to stderr, or is thrown too when programs are strict.
void judge(const std::string& what, std::string log, bool failed)
{
    const std::size_t warning = std::min(log.find("warning"), log.find("WARNING"));
    const std::size_t error = std::min(log.find("error"), log.find("ERROR"));
    if (!failed && warning == std::string::npos) return;
    // Headings of the driver's go, so that the first line, which is the one that is shown, says what is wrong.
    const std::size_t fault = failed && error != std::string::npos ? error : warning;
    if (fault != std::string::npos) log.erase(0, log.rfind('\n', fault) + 1);
    const std::string message = "shader " + what + (log.empty() ? "the driver does not say what is wrong" : log);
    if (failed || strict()) throw std::runtime_error(message);
    std::cerr << message << "\n";
}

GLuint compile(const ShaderSource& source, const std::string& text)
{
    const std::string& file = source.files.front();
    const GLuint shader = glCreateShader(stage_of(file));
    const char* begin = text.c_str();
    glShaderSource(shader, 1, &begin, nullptr);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    try {
        const std::string log = with_file_names(info_log(shader, glGetShaderiv, glGetShaderInfoLog), source);
        judge(log.empty() ? file + ": " : "", log, ok == GL_FALSE);
    } catch (...) {
        glDeleteShader(shader);
        throw;
    }
    return shader;
}

// For tools/check_shaders.py: the text as the driver gets it, once for every variant. Its sources are named at its end.
void dump(const std::filesystem::path& folder, const ShaderSource& source)
{
    std::string text = source.text;
    for (std::size_t i = 0; i < source.files.size(); ++i)
        text += "// source string " + std::to_string(i) + ": " + source.files[i] + "\n";
    const std::filesystem::path path(source.files.front());
    const std::string name = path.stem().string() + "_" + std::to_string(std::hash<std::string>()(text));
    std::filesystem::create_directories(folder);
    std::ofstream out(folder / (name + path.extension().string()), std::ios::binary);
    out << text;
    out.close();
    if (!out) throw std::runtime_error(folder.string() + ": shaders cannot be written there (CONEBOOK_DUMP_SHADERS)");
}

GLuint compile(const std::filesystem::path& root, const std::string& file, const Defines& defines)
{
    const ShaderSource source = expand_shader(root, file, defines);
    if (const char* folder = std::getenv("CONEBOOK_DUMP_SHADERS")) dump(folder, source);
    // Mesa does not compile again, and says nothing of, a text that its disk cache knows: a warning would count once and
    // never more. So a text that it cannot know, with the time behind it, goes first; one that warns is then never cached.
    if (strict()) {
        const auto now = std::chrono::system_clock::now().time_since_epoch().count();
        glDeleteShader(compile(source, source.text + "// " + std::to_string(now) + "\n"));
    }
    return compile(source, source.text);
}

GLuint link(const std::filesystem::path& root, const std::vector<std::string>& files, const Defines& defines)
{
    const GLuint program = glCreateProgram();
    std::vector<GLuint> shaders;
    try {
        for (const std::string& file : files) {
            shaders.push_back(compile(root, file, defines));
            glAttachShader(program, shaders.back());
        }
        glLinkProgram(program);
        GLint ok = 0;
        glGetProgramiv(program, GL_LINK_STATUS, &ok);
        judge(files.back() + ": ", info_log(program, glGetProgramiv, glGetProgramInfoLog), ok == GL_FALSE);
    } catch (...) {
        for (const GLuint shader : shaders) glDeleteShader(shader);
        glDeleteProgram(program);
        throw;
    }
    for (const GLuint shader : shaders) glDeleteShader(shader);
    label_object(GL_PROGRAM, program, files.back());
    return program;
}

}  // namespace

GLuint Program::id() const { return state_ ? state_->id : 0; }

void Program::use() const
{
    // Not even the same program may be used again while transform feedback runs (OpenGL 4.5, 7.3).
    GLint now = 0;
    glGetIntegerv(GL_CURRENT_PROGRAM, &now);
    if (GLuint(now) != id()) glUseProgram(id());
}

const std::function<void()>& Program::between_slices() const { return *state_->between_slices; }

namespace {
GLint location(GLuint program, const char* name) { return glGetUniformLocation(program, name); }
}  // namespace

void Program::set(const char* name, bool value) const { glProgramUniform1i(id(), location(id(), name), value ? 1 : 0); }
void Program::set(const char* name, int value) const { glProgramUniform1i(id(), location(id(), name), value); }
void Program::set(const char* name, GLuint value) const { glProgramUniform1ui(id(), location(id(), name), value); }
void Program::set(const char* name, float value) const { glProgramUniform1f(id(), location(id(), name), value); }
void Program::set(const char* name, glm::vec2 v) const { glProgramUniform2fv(id(), location(id(), name), 1, &v[0]); }
void Program::set(const char* name, glm::vec3 v) const { glProgramUniform3fv(id(), location(id(), name), 1, &v[0]); }
void Program::set(const char* name, glm::vec4 v) const { glProgramUniform4fv(id(), location(id(), name), 1, &v[0]); }
void Program::set(const char* name, glm::ivec2 v) const { glProgramUniform2iv(id(), location(id(), name), 1, &v[0]); }
void Program::set(const char* name, glm::ivec3 v) const { glProgramUniform3iv(id(), location(id(), name), 1, &v[0]); }
void Program::set(const char* name, const glm::mat4& value) const
{
    glProgramUniformMatrix4fv(id(), location(id(), name), 1, GL_FALSE, &value[0][0]);
}
void Program::set(const char* name, const std::vector<glm::vec4>& values) const
{
    glProgramUniform4fv(id(), location(id(), name), GLsizei(values.size()), &values[0][0]);
}

Shaders::Shaders(std::filesystem::path shader_root) : root_(std::move(shader_root)) {}

Program Shaders::load(const std::vector<std::string>& files, const Defines& defines)
{
    if (*between_slices_) (*between_slices_)();
    auto state = std::make_shared<Program::State>();
    state->between_slices = between_slices_;
    state->files = files;
    state->defines = defines;
    state->id = link(root_, files, defines);
    std::erase_if(programs_, [](const auto& program) { return program.expired(); });
    programs_.push_back(state);
    return Program(state);
}

std::size_t Shaders::program_count() const
{
    return std::size_t(std::count_if(programs_.begin(), programs_.end(), [](const auto& p) { return !p.expired(); }));
}

void Shaders::reload()
{
    for (const auto& weak : programs_)
        if (const auto state = weak.lock()) {
            const GLuint fresh = link(root_, state->files, state->defines);
            glDeleteProgram(state->id);
            state->id = fresh;
        }
}

const Program& ProgramVariants::with(const Defines& defines)
{
    Program& program = programs_[defines];
    if (program.id() == 0) program = shaders_->load(files_, defines);
    return program;
}

}  // namespace conebook::gl
