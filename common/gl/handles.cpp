#include "gl/handles.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace conebook::gl {

void delete_buffer(GLuint id) { glDeleteBuffers(1, &id); }
void delete_texture(GLuint id) { glDeleteTextures(1, &id); }
void delete_framebuffer(GLuint id) { glDeleteFramebuffers(1, &id); }
void delete_vertex_array(GLuint id) { glDeleteVertexArrays(1, &id); }
void delete_query(GLuint id) { glDeleteQueries(1, &id); }
void delete_sampler(GLuint id) { glDeleteSamplers(1, &id); }

namespace {

struct FormatInfo {
    GLenum internal_format;
    std::size_t bytes_per_texel;
    GLenum format, type;  // of the zero that clears it
};

FormatInfo format_info(GLenum internal_format)
{
    static constexpr FormatInfo table[] = {
        {GL_R8, 1, GL_RED, GL_FLOAT},
        {GL_RG8, 2, GL_RG, GL_FLOAT},
        {GL_RGBA8, 4, GL_RGBA, GL_FLOAT},
        {GL_SRGB8_ALPHA8, 4, GL_RGBA, GL_FLOAT},
        {GL_RG16, 4, GL_RG, GL_FLOAT},
        {GL_RG16_SNORM, 4, GL_RG, GL_FLOAT},
        {GL_RGBA16, 8, GL_RGBA, GL_FLOAT},
        {GL_R16F, 2, GL_RED, GL_FLOAT},
        {GL_RG16F, 4, GL_RG, GL_FLOAT},
        {GL_RGBA16F, 8, GL_RGBA, GL_FLOAT},
        {GL_R11F_G11F_B10F, 4, GL_RGB, GL_FLOAT},
        {GL_R32F, 4, GL_RED, GL_FLOAT},
        {GL_RG32F, 8, GL_RG, GL_FLOAT},
        {GL_RGBA32F, 16, GL_RGBA, GL_FLOAT},
        {GL_RGBA32UI, 16, GL_RGBA_INTEGER, GL_UNSIGNED_INT},
        {GL_R8UI, 1, GL_RED_INTEGER, GL_UNSIGNED_INT},
        {GL_R32UI, 4, GL_RED_INTEGER, GL_UNSIGNED_INT},
        {GL_RG32UI, 8, GL_RG_INTEGER, GL_UNSIGNED_INT},
        {GL_DEPTH_COMPONENT32F, 4, GL_DEPTH_COMPONENT, GL_FLOAT},
    };
    for (const FormatInfo& info : table)
        if (info.internal_format == internal_format) return info;
    throw std::runtime_error("texture format " + std::to_string(internal_format) + " is not in the table of formats");
}

}  // namespace

namespace {

// `text` is cut to fewer bytes than the driver's `limit`, since longer ones are an error (OpenGL 4.5, 20.7).
std::string_view shortened(const std::string& text, GLenum limit)
{
    GLint bytes = 0;
    glGetIntegerv(limit, &bytes);
    return std::string_view(text).substr(0, std::size_t(bytes) - 1);
}

}  // namespace

void label_object(GLenum kind, GLuint id, const std::string& label)
{
    const std::string_view text = shortened(label, GL_MAX_LABEL_LENGTH);
    glObjectLabel(kind, id, GLsizei(text.size()), text.data());
}

DebugGroup::DebugGroup(const std::string& name)
{
    const std::string_view text = shortened(name, GL_MAX_DEBUG_MESSAGE_LENGTH);
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, GLsizei(text.size()), text.data());
}

DebugGroup::~DebugGroup() { glPopDebugGroup(); }

Buffer::Buffer(const std::string& label, std::size_t bytes, const void* data) : bytes_(bytes), label_(label)
{
    GLuint id = 0;
    glCreateBuffers(1, &id);
    handle_ = Handle<delete_buffer>(id);
    glNamedBufferStorage(id, GLsizeiptr(std::max<std::size_t>(bytes, 4)), data, GL_DYNAMIC_STORAGE_BIT);
    label_object(GL_BUFFER, id, label);
    if (data == nullptr) clear();
}

// What shaders write is not ordered against commands that write the same memory, so that these wait for it first
// (OpenGL 4.5, 7.12.2: BUFFER_UPDATE and TEXTURE_UPDATE barriers, for reading and for writing). The other way round
// shaders see what earlier commands wrote without a barrier.
void Buffer::write(std::size_t offset, std::size_t bytes, const void* data) const
{
    if (bytes == 0) return;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glNamedBufferSubData(id(), GLintptr(offset), GLsizeiptr(bytes), data);
}

void Buffer::clear() const
{
    if (!*this) return;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glClearNamedBufferData(id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void grow(Buffer& buffer, const std::string& label, std::size_t bytes, std::size_t kept)
{
    if (buffer.bytes() >= bytes) return;
    Buffer larger(label, (bytes + bytes / 4 + 15) / 16 * 16);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    if (kept > 0) glCopyNamedBufferSubData(buffer.id(), larger.id(), 0, 0, GLsizeiptr(kept));
    buffer = std::move(larger);
}

void Buffer::bind(GLenum target, GLuint index) const { glBindBufferBase(target, index, id()); }

void Buffer::read_bytes(std::size_t offset, std::size_t bytes, void* out) const
{
    if (bytes == 0) return;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(id(), GLintptr(offset), GLsizeiptr(bytes), out);
}

std::size_t most_storage_bytes()
{
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    return std::size_t(most);
}

void require_storage(const std::string& items, std::size_t count, std::size_t bytes_per_item, const std::string& remedy)
{
    const std::size_t most = most_storage_bytes();
    if (count * bytes_per_item <= most) return;
    throw std::runtime_error(std::to_string(count) + " " + items + " of " + std::to_string(bytes_per_item) +
                             " bytes are more than a storage block of this driver holds (" +
                             std::to_string(most >> 20) + " MiB, GL_MAX_SHADER_STORAGE_BLOCK_SIZE); use " + remedy);
}

Texture::Texture(const std::string& label, GLenum target, GLenum internal_format, glm::ivec3 size, int levels)
    : target_(target), format_(internal_format), size_(size), levels_(levels), label_(label)
{
    GLuint id = 0;
    glCreateTextures(target, 1, &id);
    handle_ = Handle<delete_texture>(id);
    if (target == GL_TEXTURE_2D)
        glTextureStorage2D(id, levels, internal_format, size.x, size.y);
    else
        glTextureStorage3D(id, levels, internal_format, size.x, size.y, size.z);
    if (glGetError() == GL_OUT_OF_MEMORY)
        throw std::runtime_error(label + ": no memory for a texture of " + std::to_string(bytes() >> 20) + " MiB");
    label_object(GL_TEXTURE, id, label);
    set_filter(levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST, GL_NEAREST);
    set_wrap(GL_CLAMP_TO_EDGE);
}

std::size_t Texture::bytes() const
{
    if (levels_ == 0) return 0;  // not made yet
    std::size_t texels = 0;
    for (int level = 0; level < levels_; ++level) {
        const glm::ivec3 s = glm::max(size_ >> level, glm::ivec3(1));
        const bool is_3d = target_ == GL_TEXTURE_3D;
        texels += std::size_t(s.x) * std::size_t(s.y) * std::size_t(is_3d ? s.z : std::max(size_.z, 1));
    }
    return texels * format_info(format_).bytes_per_texel;
}

void Texture::set_filter(GLenum minification, GLenum magnification) const
{
    glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, GLint(minification));
    glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, GLint(magnification));
}

void Texture::set_wrap(GLenum wrap) const
{
    for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTextureParameteri(id(), axis, GLint(wrap));
}

void Texture::clear() const
{
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    const FormatInfo info = format_info(format_);
    for (int level = 0; level < levels_; ++level) glClearTexImage(id(), level, info.format, info.type, nullptr);
}

void Texture::bind(GLuint unit) const { glBindTextureUnit(unit, id()); }

void Texture::bind_image(GLuint unit, int level, GLenum access, GLenum as_format) const
{
    const bool layered = target_ != GL_TEXTURE_2D;
    glBindImageTexture(unit, id(), level, layered ? GL_TRUE : GL_FALSE, 0, access, as_format);
}

Texture texture_2d(const std::string& label, GLenum format, glm::ivec2 size, int levels)
{
    return Texture(label, GL_TEXTURE_2D, format, glm::ivec3(size, 1), levels);
}

Texture texture_3d(const std::string& label, GLenum format, glm::ivec3 size, int levels)
{
    return Texture(label, GL_TEXTURE_3D, format, size, levels);
}

namespace {

std::size_t texel_count(const Texture& texture, int level)
{
    glm::ivec3 s = glm::max(texture.size() >> level, glm::ivec3(1));
    if (texture.target() != GL_TEXTURE_3D) s.z = std::max(texture.size().z, 1);
    return std::size_t(s.x) * std::size_t(s.y) * std::size_t(s.z);
}

}  // namespace

std::vector<float> read_floats(const Texture& texture, int level, int channels)
{
    const GLenum format = texture.format() == GL_DEPTH_COMPONENT32F ? GL_DEPTH_COMPONENT
                          : channels == 1                           ? GL_RED
                          : channels == 2                           ? GL_RG
                                                                    : GL_RGBA;
    std::vector<float> values(texel_count(texture, level) * std::size_t(channels));
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.id(), level, format, GL_FLOAT, GLsizei(values.size() * sizeof(float)), values.data());
    return values;
}

std::vector<GLuint> read_uints(const Texture& texture, int level)
{
    std::vector<GLuint> values(texel_count(texture, level));
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.id(), level, GL_RED_INTEGER, GL_UNSIGNED_INT, GLsizei(values.size() * sizeof(GLuint)),
                      values.data());
    return values;
}

Framebuffer::Framebuffer(const std::string& label, const std::vector<const Texture*>& colors, const Texture* depth)
{
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    handle_ = Handle<delete_framebuffer>(id);
    std::vector<GLenum> draw_buffers;
    for (const Texture* color : colors) {
        draw_buffers.push_back(GLenum(GL_COLOR_ATTACHMENT0 + draw_buffers.size()));
        glNamedFramebufferTexture(id, draw_buffers.back(), color->id(), 0);
    }
    if (draw_buffers.empty()) draw_buffers.push_back(GL_NONE);
    glNamedFramebufferDrawBuffers(id, GLsizei(draw_buffers.size()), draw_buffers.data());
    if (depth != nullptr) glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth->id(), 0);
    check(label);
}

Framebuffer::Framebuffer(const std::string& label, glm::ivec2 size, int layers)
{
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    handle_ = Handle<delete_framebuffer>(id);
    glNamedFramebufferParameteri(id, GL_FRAMEBUFFER_DEFAULT_WIDTH, size.x);
    glNamedFramebufferParameteri(id, GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.y);
    glNamedFramebufferParameteri(id, GL_FRAMEBUFFER_DEFAULT_LAYERS, layers > 1 ? layers : 0);
    check(label);
}

void Framebuffer::check(const std::string& label) const
{
    const GLenum status = glCheckNamedFramebufferStatus(id(), GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error(label + ": framebuffer is not complete (" + std::to_string(status) + ")");
    label_object(GL_FRAMEBUFFER, id(), label);
}

void Framebuffer::attach_depth_layer(const Texture& depth, int layer) const
{
    glNamedFramebufferTextureLayer(id(), GL_DEPTH_ATTACHMENT, depth.id(), 0, layer);
}

void Framebuffer::bind(glm::ivec2 viewport_size) const { bind(glm::ivec2(0), viewport_size); }

void Framebuffer::bind(glm::ivec2 viewport_corner, glm::ivec2 viewport_size) const
{
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id());
    glViewport(viewport_corner.x, viewport_corner.y, viewport_size.x, viewport_size.y);
}

VertexArray::VertexArray()
{
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    handle_ = Handle<delete_vertex_array>(id);
}

glm::uvec3 group_counts(std::size_t items, GLuint group)
{
    constexpr GLuint kMostInRow = 65535;
    const GLuint groups = group_count(items, group), rows = std::max(group_count(groups, kMostInRow), 1u);
    return {group_count(groups, rows), rows, 1};
}

void dispatch_items(std::size_t items, GLuint group)
{
    const glm::uvec3 groups = group_counts(items, group);
    if (items > 0) glDispatchCompute(groups.x, groups.y, groups.z);
}

}  // namespace conebook::gl
