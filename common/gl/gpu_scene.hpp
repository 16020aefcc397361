// A scene in GPU memory, and how passes draw it.
#pragma once

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

class GpuScene {
public:
    explicit GpuScene(const Scene& scene);

    // Bind buffers (kLightBinding) and draw every triangle with `program`, material by material: kMaterialBlock,
    // textures on units 0..6 (kBaseColorSlot ... kCoverageUnit).
    // Vertex attributes: 0 position, 1 normal, 2 tangent, 3 uv0, 4 uv1, 5 colour (see Vertex). For shaders that pull
    // vertices themselves: uniform uint first_index, kVertexBinding (18 floats each), kIndexBinding.
    void draw(const gl::Program& program, Culling culling) const;

    // The same for compute shaders: dispatches one work group a triangle (uniform uint triangle_count).
    void dispatch_triangles(const gl::Program& program) const;

    // Bind the light list (kLightBinding) and set uniform int light_count.
    void bind_lights(const gl::Program& program) const;

    // Other lights than those of the file.
    void set_lights(const std::vector<Light>& lights);
    // What passes compare with what they were made from. Materials belong to the geometry.
    Revision geometry_revision() const { return geometry_revision_; }
    Revision lights_revision() const { return lights_revision_; }

    const Bounds& bounds() const { return bounds_; }
    const std::vector<Light>& lights() const { return lights_; }
    std::size_t triangle_count() const { return triangle_count_; }
    bool has_emission() const { return has_emission_; }
    bool has_textures() const { return !textures_.empty(); }
    std::vector<gl::Resource> resources() const;

private:
    void bind_buffers() const;
    void bind_material(const gl::Program& program, int material) const;
    std::size_t triangle_count_ = 0;
    Revision geometry_revision_ = 1, lights_revision_ = 1;
    Bounds bounds_;
    bool has_emission_ = false;
    std::vector<Light> lights_;
    std::vector<Draw> draws_;
    std::vector<Material> materials_;
    gl::Buffer vertex_buffer_, index_buffer_, material_buffer_, light_buffer_;
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
