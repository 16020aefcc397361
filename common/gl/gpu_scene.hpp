// A scene in GPU memory, and how passes draw it.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "common/bindings.glsl"
#include "common/scene_structs.glsl"
#include "gl/handles.hpp"
#include "gl/made_from.hpp"
#include "gl/shaders.hpp"
#include "scene/scene.hpp"

namespace conebook {

// Which faces a pass leaves out. `back_of_single_sided` is what a camera sees: double-sided materials show both.
enum class Culling { none, back_of_single_sided };

// What a scene's triangles make of a material.
struct MaterialUse {
    std::size_t triangles = 0;
    bool vertex_alpha = false;  // some vertex has an alpha other than 1
    // Sums over triangles: sides of their boxes along x, y and z, m; areas seen along x, y and z, m^2.
    double box_sides_m = 0.0, seen_areas_m2 = 0.0;
};

struct Triangle {
    std::array<glm::vec3, 3> corners;  // scene space; counter-clockwise from the front
    bool double_sided;
};

class GpuScene {
public:
    explicit GpuScene(const Scene& scene);

    // Bind buffers (kLightBinding) and draw every triangle with `program`, material by material: kMaterialBlock,
    // textures on units 0..6 (kBaseColorSlot ... kCoverageUnit).
    // Vertex attributes: 0 position, 1 normal, 2 tangent, 3 uv0, 4 uv1, 5 colour (see Vertex).
    // With `clip_from_scene`, what lies as a whole outside of what that matrix shows is left out, draw by draw. Gives
    // the number of draws.
    std::size_t draw(const gl::Program& program, Culling culling, const glm::mat4* clip_from_scene = nullptr) const;
    std::size_t draw_count() const { return draws_.size(); }

    // The same for programs with a tessellator: each triangle is a patch of three corners, `instances` times, and a call
    // of OpenGL's draws at most `most_patches`.
    void draw_patches(const gl::Program& program, int instances, std::uint32_t most_patches) const;

    // Draw these triangles at once, without materials: uniform uint first_triangle + gl_PrimitiveID is a triangle's number.
    void draw_geometry(const gl::Program& program, Range triangles) const;

    // For shaders that fetch triangles themselves: kVertexBinding (18 floats each), kIndexBinding (3 a triangle),
    // kTriangleMaterialBinding (material's number | kTriangleDoubleSided). Throws std::runtime_error when the scene has
    // more vertices or triangles than a storage block holds.
    void bind_triangles() const;

    // Bind one material after another as draw() does, and call run(its number in materials()).
    void for_each_material(const std::function<void(std::size_t)>& run) const;

    // Bind the light list (kLightBinding) and set uniform int light_count.
    void bind_lights(const gl::Program& program) const;

    // Vertex by vertex as in Scene. Who writes it marks that.
    const gl::Buffer& vertices() const { return vertex_buffer_; }
    void mark_moved() { ++geometry_revision_; }
    // The same where it is of what stands still, or where other nodes than before are dynamic.
    void mark_changed()
    {
        ++geometry_revision_;
        ++still_revision_;
    }
    // The scene that this was made from has other vertices at one of its nodes, another material there, other triangles
    // and materials altogether: each costs what it changes, and what is in the buffers is then, bit for bit, what a
    // GpuScene made from the scene as it is now has there. Textures of the first `same_images` images stay; bounds and
    // lights do. Who calls it marks that something changed.
    void move(const Scene& scene, std::size_t node);
    void set_material(const Scene& scene, std::size_t material);
    void set_triangles(const Scene& scene, std::size_t same_images);
    // Whether some of it may move, after nodes have become dynamic or static.
    void find_dynamic(const Scene& scene);
    // Other lights than those of the file.
    void set_lights(const std::vector<Light>& lights);
    // What passes compare with what they were made from. Materials belong to the geometry.
    Revision geometry_revision() const { return geometry_revision_; }
    Revision still_revision() const { return still_revision_; }
    Revision lights_revision() const { return lights_revision_; }

    // In the order of the draws, read back from GPU memory.
    std::vector<Triangle> triangles() const;

    const Bounds& bounds() const { return bounds_; }
    const std::vector<Light>& lights() const { return lights_; }
    std::size_t triangle_count() const { return triangle_count_; }
    const std::vector<Material>& materials() const { return materials_; }
    const std::vector<MaterialUse>& material_uses() const { return material_uses_; }  // of each of materials()
    bool may_move() const { return may_move_; }                                       // some of it: see Node::dynamic
    bool has_emission() const { return has_emission_; }
    bool has_textures() const { return !textures_.empty(); }
    std::vector<gl::Resource> resources() const;

private:
    void bind_material(std::size_t material) const;
    std::size_t for_each_draw(const gl::Program& program, Culling culling, const glm::mat4* clip_from_scene,
                              const std::function<void(const Draw&)>& run) const;
    void bind_textures(const Scene& scene, std::size_t same_images);
    std::size_t triangle_count_ = 0;
    Revision geometry_revision_ = 1, still_revision_ = 1, lights_revision_ = 1;
    Bounds bounds_;
    bool has_emission_ = false, may_move_ = false;
    std::vector<Light> lights_;
    std::vector<Draw> draws_;
    std::vector<std::optional<Bounds>> boxes_;  // of each draw's triangles; none for what may move
    std::vector<Material> materials_;
    std::vector<MaterialUse> draw_uses_, material_uses_;  // of each draw, of each material
    gl::Buffer vertex_buffer_, index_buffer_, triangle_material_buffer_, material_buffer_, light_buffer_;
    gl::VertexArray vertex_array_;
    // An image as a texture: as sRGB, as linear values, or as what an alpha mask covers of it.
    enum class Content { srgb, linear, coverage };
    struct TextureOf {
        int image;
        Content content;
        float alpha, cutoff;  // of the mask; 0 where there is none
        auto operator<=>(const TextureOf&) const = default;
    };
    struct BoundTexture {
        GLuint texture = 0;  // one of textures_; 0: none
        gl::Handle<gl::delete_sampler> sampler;
    };
    std::map<TextureOf, gl::Texture> textures_;
    std::vector<std::array<BoundTexture, shared::kCoverageUnit + 1>> bindings_;  // by material
    gl::Texture white_;
};

// Whether all of a box is beyond one of the six sides of what a matrix shows, depth 0 .. 1. A box that touches a side, to
// within what the floats of a vertex shader leave open, is not.
bool is_outside(const Bounds& box, const glm::mat4& clip_from_scene);

// Matrices of a camera for a picture of `size` pixels. Depth is reversed and spread over what the camera can see of
// `content`, the bounds of all that is drawn.
shared::CameraData camera_data(const Camera& camera, glm::ivec2 size, const Bounds& content);
// The same camera with its picture moved by a part of a pixel.
shared::CameraData moved(const shared::CameraData& camera, glm::vec2 pixels);
// LightData as the shaders read it.
shared::LightData light_data(const Light& light);

}  // namespace conebook
