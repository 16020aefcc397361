// A scene in GPU memory, and how passes draw it.
#pragma once

#include <array>
#include <functional>
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
    void draw(const gl::Program& program, Culling culling) const;

    // The same for programs with a tessellator: each triangle is a patch of three corners, `instances` times, and a call
    // of OpenGL's draws at most `most_patches`.
    void draw_patches(const gl::Program& program, int instances, std::uint32_t most_patches) const;

    // Draw every triangle of the scene at once, without materials: gl_PrimitiveID is the triangle's number.
    void draw_geometry(const gl::Program& program) const;

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
    // Other lights than those of the file.
    void set_lights(const std::vector<Light>& lights);
    // What passes compare with what they were made from. Materials belong to the geometry.
    Revision geometry_revision() const { return geometry_revision_; }
    Revision lights_revision() const { return lights_revision_; }

    // In the order of the draws, read back from GPU memory.
    std::vector<Triangle> triangles() const;

    const Bounds& bounds() const { return bounds_; }
    const std::vector<Light>& lights() const { return lights_; }
    std::size_t triangle_count() const { return triangle_count_; }
    const std::vector<Material>& materials() const { return materials_; }
    const std::vector<MaterialUse>& material_uses() const { return material_uses_; }  // of each of materials()
    bool may_move() const { return may_move_; }  // some of it: see Node::dynamic
    bool has_emission() const { return has_emission_; }
    bool has_textures() const { return !textures_.empty(); }
    std::vector<gl::Resource> resources() const;

private:
    void bind_material(std::size_t material) const;
    void for_each_draw(const gl::Program& program, Culling culling, const std::function<void(const Draw&)>& run) const;
    std::size_t triangle_count_ = 0;
    Revision geometry_revision_ = 1, lights_revision_ = 1;
    Bounds bounds_;
    bool has_emission_ = false, may_move_ = false;
    std::vector<Light> lights_;
    std::vector<Draw> draws_;
    std::vector<Material> materials_;
    std::vector<MaterialUse> material_uses_;
    gl::Buffer vertex_buffer_, index_buffer_, triangle_material_buffer_, material_buffer_, light_buffer_;
    gl::VertexArray vertex_array_;
    struct BoundTexture {
        int texture = -1;  // index into textures_
        gl::Handle<gl::delete_sampler> sampler;
    };
    std::vector<gl::Texture> textures_;
    std::vector<std::array<BoundTexture, shared::kCoverageUnit + 1>> bindings_;  // by material
    gl::Texture white_;
};

// Matrices of a camera for a picture of `size` pixels. Depth is reversed and spread over what the camera can see of
// `content`, the bounds of all that is drawn.
shared::CameraData camera_data(const Camera& camera, glm::ivec2 size, const Bounds& content);
// The same camera with its picture moved by a part of a pixel.
shared::CameraData moved(const shared::CameraData& camera, glm::vec2 pixels);
// LightData as the shaders read it.
shared::LightData light_data(const Light& light);

}  // namespace conebook
