// What the lights see: a depth map for every light, so that any point can ask whether a light sees it.
#pragma once

#include "app/parameters.hpp"
#include "app/statistics.hpp"
#include "common/shadow_structs.glsl"
#include "gl/gpu_scene.hpp"

namespace conebook {

struct ShadowMapParams {
    // Texels along a side of every map, 64 .. 8192: a texel's width is the smallest shadow that is drawn. Halved until
    // all maps together fit into 1 GiB.
    int shadow_map_size = 1024;
    // How far a point moves along its normal before it is looked up, in texel widths, 0 .. 10. The receiver's own plane
    // is compared texel by texel, so only curvature and rounding are left for it; a shadow moves by as much.
    float shadow_bias = 0.25f;
    // Compare each texel with the receiver's plane there. Off: with the receiver's depth alone, and acne appears.
    bool shadow_receiver_plane = true;
};
void add_parameters(ParameterTable& table, ShadowMapParams& params);

// Directional and spot lights have one layer of a depth array, point lights (and spots wider than 75 degrees) six.
// Throws std::runtime_error when the scene's lights need more layers than the driver has.
class ShadowMaps {
public:
    ShadowMaps(gl::Shaders& shaders, const GpuScene& scene, const ShadowMapParams& params);
    // Draws the maps if scene or lights have changed, and says whether it did.
    bool draw(const GpuScene& scene);
    void forget() { made_from_.forget(); }  // the next call draws whatever has changed, for measuring
    Revision revision() const { return revision_; }
    // For shaders that include common/shadow_map.glsl: kShadowLayerBinding, kShadowLightBinding, kShadowMapUnit.
    void bind(const gl::Program& program) const;

    int layers() const { return int(layers_.size()); }
    int size() const { return depth_.size().x; }  // of every map, texels
    const glm::mat4& clip_from_scene(int layer) const { return layers_[std::size_t(layer)].clip_from_scene; }
    const gl::Texture& depth() const { return depth_; }  // DEPTH32F array, 1 near .. 0 far
    std::vector<gl::Resource> resources() const { return {depth_.resource()}; }
    // One entry a light: the maps that it has, or why it has none.
    std::vector<Need> needs(const GpuScene& scene) const;

private:
    ShadowMapParams params_;
    MadeFrom<Revision, Revision> made_from_;  // geometry, lights
    Revision revision_ = 0;
    gl::Program program_;
    std::vector<shared::ShadowLayer> layers_;
    gl::Buffer layer_buffer_, light_buffer_;
    gl::Texture depth_;
    gl::Framebuffer framebuffer_;
};

// The matrices of a light's layers: depth 1 near, 0 far. `bounds` are the scene's. Empty for a light that gives nothing.
std::vector<glm::mat4> shadow_matrices(const Light& light, const Bounds& bounds, int map_size);

}  // namespace conebook
