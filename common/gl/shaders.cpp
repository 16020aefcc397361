#include "gl/shaders.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "gl/handles.hpp"

namespace conebook::gl {

struct Program::State {
    GLuint id = 0;
    std::vector<std::string> files;
    Defines defines;
    ~State()
    {
        if (id != 0) glDeleteProgram(id);
    }
};

namespace {

std::string read_text(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error(file.string() + ": shader file cannot be read");
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

// A source with its includes put in. GLSL numbers the pieces: `files[i]` is source string i of the #line directives.
struct ExpandedSource {
    std::string text;
    std::vector<std::string> files;
};

void expand(const std::filesystem::path& root, const std::string& file, const Defines& defines, ExpandedSource& out)
{
    const int file_number = int(out.files.size());
    out.files.push_back(file);
    std::istringstream lines(read_text(root / file));
    static const std::regex include_line(R"(^\s*#include\s+\"([^\"]+)\".*)");
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        std::smatch match;
        if (std::regex_match(line, match, include_line)) {
            const std::string included = match[1];
            if (std::find(out.files.begin(), out.files.end(), included) == out.files.end()) {
                if (!std::filesystem::exists(root / included))
                    throw std::runtime_error(file + ":" + std::to_string(number) + ": #include \"" + included +
                                             "\" is not below the shader folder");
                out.text += "#line 1 " + std::to_string(out.files.size()) + "\n";
                expand(root, included, defines, out);
            }
            out.text += "#line " + std::to_string(number + 1) + " " + std::to_string(file_number) + "\n";
            continue;
        }
        out.text += line + "\n";
        if (line.rfind("#version", 0) == 0) {
            for (const auto& [name, value] : defines) out.text += "#define " + name + " " + value + "\n";
            out.text += "#line " + std::to_string(number + 1) + " " + std::to_string(file_number) + "\n";
        }
    }
}

GLenum stage_of(const std::string& file)
{
    const std::string extension = std::filesystem::path(file).extension().string();
    if (extension == ".vert") return GL_VERTEX_SHADER;
    if (extension == ".geom") return GL_GEOMETRY_SHADER;
    if (extension == ".frag") return GL_FRAGMENT_SHADER;
    if (extension == ".comp") return GL_COMPUTE_SHADER;
    throw std::runtime_error(file + ": unknown shader stage (.vert .geom .frag .comp)");
}

// Drivers write "0:12(5): error: ..." (Mesa), "0(12) : error ..." (NVIDIA), "ERROR: 0:12: ..." (others): put the file
// name in place of the number of the source string.
std::string with_file_names(const std::string& log, const ExpandedSource& source)
{
    static const std::regex location(R"((\d+)(?::|\()(\d+)(?:\(\d+\))?\)?)");
    std::string out;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (std::regex_search(line, match, location)) {
            const std::size_t index = std::stoul(match[1]);
            if (index < source.files.size())
                line = match.prefix().str() + source.files[index] + ":" + match[2].str() + match.suffix().str();
        }
        out += (out.empty() ? "" : "\n") + line;
    }
    return out;
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

bool warns(const std::string& log)
{
    return log.find("warning") != std::string::npos || log.find("WARNING") != std::string::npos;
}

// Throws when the compiler has anything to complain of.
GLuint compile(const ExpandedSource& source, const std::string& text, GLenum stage)
{
    const GLuint shader = glCreateShader(stage);
    const char* begin = text.c_str();
    glShaderSource(shader, 1, &begin, nullptr);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    const std::string log = info_log(shader, glGetShaderiv, glGetShaderInfoLog);
    if (!ok || warns(log)) {
        glDeleteShader(shader);
        throw std::runtime_error("shader " + with_file_names(log, source));
    }
    return shader;
}

GLuint compile(const std::filesystem::path& root, const std::string& file, const Defines& defines)
{
    ExpandedSource source;
    expand(root, file, defines, source);
    const GLenum stage = stage_of(file);
    // Mesa does not compile again, and says nothing of, a text that its disk cache knows: a warning would count once and
    // never more. So a text that it cannot know, with the time behind it, goes first; one that warns is then never cached.
    // 0.2 to 4 ms a shader, 45 ms for the 36 of chapter 12 (llvmpipe, Mesa 22.3.6).
    const bool is_mesa =
        std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))).find("Mesa") != std::string::npos;
    if (is_mesa) {
        const auto now = std::chrono::system_clock::now().time_since_epoch().count();
        glDeleteShader(compile(source, source.text + "// " + std::to_string(now) + "\n", stage));
    }
    return compile(source, source.text, stage);
}

GLuint link(const std::filesystem::path& root, const std::vector<std::string>& files, const Defines& defines)
{
    const GLuint program = glCreateProgram();
    std::vector<GLuint> shaders;
    const auto release = [&] {
        for (GLuint shader : shaders) glDeleteShader(shader);
    };
    try {
        for (const std::string& file : files) {
            shaders.push_back(compile(root, file, defines));
            glAttachShader(program, shaders.back());
        }
    } catch (...) {
        release();
        glDeleteProgram(program);
        throw;
    }
    glLinkProgram(program);
    release();
    GLint ok = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &ok);
    const std::string log = info_log(program, glGetProgramiv, glGetProgramInfoLog);
    if (!ok || warns(log)) {
        glDeleteProgram(program);
        throw std::runtime_error("shader " + files.back() + ": " + log);
    }
    set_label(GL_PROGRAM, program, files.back());
    return program;
}

}  // namespace

GLuint Program::id() const { return state_ ? state_->id : 0; }
void Program::use() const { glUseProgram(id()); }

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
    auto state = std::make_shared<Program::State>();
    state->files = files;
    state->defines = defines;
    state->id = link(root_, files, defines);
    std::erase_if(programs_, [](const auto& program) { return program.expired(); });
    programs_.push_back(state);
    return Program(state);
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

}  // namespace conebook::gl
