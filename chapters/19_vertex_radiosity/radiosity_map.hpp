// The radiosity map: a texture with the irradiance of every patch, and the patches and triangles on the GPU that it
// is for.
#pragma once

#include "19_vertex_radiosity/patch_mesh.hpp"
#include "19_vertex_radiosity/sight.hpp"
#include "gl/gpu_scene.hpp"

namespace conebook {

enum class FormFactor : int { exact, published };

// The patch mesh in GPU memory.
class PatchBuffers {
public:
    void upload(const PatchMesh& mesh);

    // Every patch as a point: attributes 0 position, 1 normal of shared::Patch.
    void draw_points(const gl::Program& program) const;
    // Every triangle, material by material as GpuScene::draw; attributes as there. Sets first_triangle. `scene` is
    // the one that the mesh was made from. Culling::none and backs: only sides that have no material are left out, or
    // only others.
    void draw(const gl::Program& program, const GpuScene& scene, GLenum culled_of_single_sided) const;
    // For shaders that include 19_vertex_radiosity/patches.glsl, with the triangles at kIndexBinding.
    void bind() const;

    int patch_count() const { return patch_count_; }
    int back_offset() const { return back_offset_; }
    std::vector<gl::Resource> resources() const;

private:
    int patch_count_ = 0, back_offset_ = 0;
    std::vector<Draw> draws_;
    gl::Buffer patches_, vertices_, indices_;
    gl::VertexArray points_, triangles_;
};

// M^2 texels, RGBA32F: the irradiance of patch i, W/m^2, is in texel (i mod M, i / M). Direct and indirect light lie in
// maps of their own, so that each can be seen.
class RadiosityMap {
public:
    explicit RadiosityMap(gl::Shaders& shaders);
    // Black, and large enough.
    void clear(int patch_count);

    // `sight`: sight_of(...). half_texel off: points are drawn at corners of texels.
    void add_direct(const PatchBuffers& patches, const GpuScene& scene, const std::vector<std::uint32_t>& sight,
                    bool half_texel);
    void clear_indirect() const;
    void add_indirect(const PatchBuffers& patches, const std::vector<LightNode>& lights,
                      const std::vector<std::uint32_t>& sight, FormFactor form_factor, bool half_texel);

    int side() const { return direct_.size().x; }  // M
    const gl::Texture& direct() const { return direct_; }
    const gl::Texture& indirect() const { return indirect_; }
    // For shaders that look patches up: the maps on units 8 and 9, map_side.
    void bind(const gl::Program& program) const;
    std::vector<gl::Resource> resources() const { return {direct_.resource(), indirect_.resource()}; }

private:
    void add(const gl::Program& program, const gl::Framebuffer& target, const PatchBuffers& patches,
             const std::vector<std::uint32_t>& sight, std::size_t light_count, bool half_texel) const;
    gl::Program from_lights_, from_patches_;
    gl::Texture direct_, indirect_;
    gl::Framebuffer direct_target_, indirect_target_;
};

}  // namespace conebook
