// Values that own OpenGL 4.5 objects (direct state access): moved, never copied, deleted with their owner.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

namespace conebook::gl {

// A name and how much memory it takes; passes list theirs for --stats.
struct Resource {
    std::string name;
    std::size_t bytes = 0;
};

// An object name that is deleted with its owner.
template <void (*destroy)(GLuint)>
class Handle {
public:
    Handle() = default;
    explicit Handle(GLuint id) : id_(id) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Handle& operator=(Handle&& other) noexcept
    {
        std::swap(id_, other.id_);
        return *this;
    }
    ~Handle()
    {
        if (id_ != 0) destroy(id_);
    }
    GLuint id() const { return id_; }

private:
    GLuint id_ = 0;
};

void delete_buffer(GLuint id);
void delete_texture(GLuint id);
void delete_framebuffer(GLuint id);
void delete_vertex_array(GLuint id);
void delete_query(GLuint id);
void delete_sampler(GLuint id);

// The name of an object in debuggers and messages. What is longer than the driver takes (256 bytes at least) is cut off.
void label_object(GLenum kind, GLuint id, const std::string& label);

// Everything that is called while it lives is one group in debuggers; the name is cut off likewise.
class DebugGroup {
public:
    explicit DebugGroup(const std::string& name);
    ~DebugGroup();
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;
};

// Immutable storage of `bytes` bytes, zeroed or filled from `data`. One that was never made holds 0 bytes: it may be
// bound, cleared and read like any other. Scenes without a voxel have such.
class Buffer {
public:
    Buffer() = default;
    Buffer(const std::string& label, std::size_t bytes, const void* data = nullptr);
    template <typename T>
    Buffer(const std::string& label, const std::vector<T>& values)
        : Buffer(label, values.size() * sizeof(T), values.data())
    {
    }
    GLuint id() const { return handle_.id(); }
    std::size_t bytes() const { return bytes_; }
    explicit operator bool() const { return id() != 0; }
    Resource resource() const { return {label_, bytes_}; }

    // These wait for what shaders wrote before: they issue the barrier.
    void write(std::size_t offset, std::size_t bytes, const void* data) const;
    void clear() const;  // all bits 0
    // Copy back to the CPU.
    template <typename T>
    std::vector<T> read() const
    {
        std::vector<T> values(bytes_ / sizeof(T));
        read_bytes(0, values.size() * sizeof(T), values.data());
        return values;
    }
    template <typename T>
    T read_at(std::size_t offset) const
    {
        T value;
        read_bytes(offset, sizeof(T), &value);
        return value;
    }

    void bind(GLenum target, GLuint index) const;

private:
    void read_bytes(std::size_t offset, std::size_t bytes, void* out) const;
    Handle<delete_buffer> handle_;
    std::size_t bytes_ = 0;
    std::string label_;
};

// Another buffer where `bytes` are more than there are, with what the first `kept` bytes held, and room for a quarter more.
void grow(Buffer& buffer, const std::string& label, std::size_t bytes, std::size_t kept);

// What a storage block of this driver holds; OpenGL 4.5 promises 128 MiB (chapter 23, MAX_SHADER_STORAGE_BLOCK_SIZE).
std::size_t most_storage_bytes();
// Throws std::runtime_error, which names the items, the limit and the remedy, where that is less than `count` items.
void require_storage(const std::string& items, std::size_t count, std::size_t bytes_per_item,
                     const std::string& remedy);

// Immutable storage. size.z is the depth (3D) or the number of layers (arrays).
class Texture {
public:
    Texture() = default;
    Texture(const std::string& label, GLenum target, GLenum internal_format, glm::ivec3 size, int levels = 1);
    GLuint id() const { return handle_.id(); }
    glm::ivec3 size() const { return size_; }
    glm::ivec2 size_2d() const { return glm::ivec2(size_); }
    int levels() const { return levels_; }
    GLenum format() const { return format_; }
    GLenum target() const { return target_; }
    std::size_t bytes() const;
    explicit operator bool() const { return id() != 0; }
    Resource resource() const { return {label_, bytes()}; }

    // Filtering and wrapping; mipmapped minification is trilinear between levels.
    void set_filter(GLenum minification, GLenum magnification) const;
    void set_wrap(GLenum wrap) const;
    void clear() const;  // every level to zero; waits for what shaders wrote before
    void bind(GLuint unit) const;
    void bind_image(GLuint unit, int level, GLenum access) const { bind_image(unit, level, access, format_); }
    void bind_image(GLuint unit, int level, GLenum access, GLenum as_format) const;

private:
    Handle<delete_texture> handle_;
    GLenum target_ = 0, format_ = 0;
    glm::ivec3 size_{0};
    int levels_ = 0;
    std::string label_;
};

Texture texture_2d(const std::string& label, GLenum format, glm::ivec2 size, int levels = 1);
Texture texture_3d(const std::string& label, GLenum format, glm::ivec3 size, int levels = 1);

// A level of a texture as floats, `channels` (1, 2 or 4) a texel, bottom row (y = 0) first, whole depth.
std::vector<float> read_floats(const Texture& texture, int level, int channels);
// The same for r32ui textures.
std::vector<GLuint> read_uints(const Texture& texture, int level = 0);

// Colour attachments 0, 1, ... and a depth attachment; textures are not owned and must outlive it.
class Framebuffer {
public:
    Framebuffer() = default;
    Framebuffer(const std::string& label, const std::vector<const Texture*>& colors, const Texture* depth = nullptr);
    // No attachments: fragment shaders that write only images and buffers.
    Framebuffer(const std::string& label, glm::ivec2 size, int layers = 1);
    GLuint id() const { return handle_.id(); }
    void attach_depth_layer(const Texture& depth, int layer) const;
    void bind(glm::ivec2 viewport_size) const;  // binds for drawing and sets the viewport to the whole of it
    void bind(glm::ivec2 viewport_corner, glm::ivec2 viewport_size) const;

private:
    void check(const std::string& label) const;
    Handle<delete_framebuffer> handle_;
};

class VertexArray {
public:
    VertexArray();
    GLuint id() const { return handle_.id(); }

private:
    Handle<delete_vertex_array> handle_;
};

// Number of work groups of `group` that cover `items`.
inline GLuint group_count(std::size_t items, GLuint group) { return GLuint((items + group - 1) / group); }

// The same in rows of at most 65,535 work groups, the most a side that OpenGL 4.5 promises (chapter 23,
// MAX_COMPUTE_WORK_GROUP_COUNT); shaders find their place with common/item_index.glsl. Also an indirect dispatch.
glm::uvec3 group_counts(std::size_t items, GLuint group);
// Runs the program in use over a list, one thread an item; nothing where there are none.
void dispatch_items(std::size_t items, GLuint group);

}  // namespace conebook::gl
