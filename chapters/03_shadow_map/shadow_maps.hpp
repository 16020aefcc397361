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

// Directional and spot lights have one map, fitted to where their shadows fall; point lights (and spots wider than 75
// degrees) have six, or one where they are so far outside that it holds the whole scene. Lights that give nothing or
// throw no shadow have none. Throws std::runtime_error when maps of 64 texels a side take more than 1 GiB together,
// 65536 of them.
class ShadowMaps {
public:
    explicit ShadowMaps(gl::Shaders& shaders);
    // Draws the maps if scene, lights or their size have changed, and says whether it did.
    bool draw(const GpuScene& scene, const ShadowMapParams& params);
    void forget() { made_from_.forget(); }  // the next call draws whatever has changed, for measuring
    // Changes whenever the maps do, or how they are looked into.
    Revision revision() const { return revision_; }
    // For shaders that include common/shadow_map.glsl: kShadowLayerBinding, kShadowLightBinding, kShadowMapUnit.
    void bind(const gl::Program& program) const;

    int layers() const { return int(layers_.size()); }
    int size() const { return size_; }  // of every map, texels
    std::size_t draws() const { return draws_; }  // when the maps were drawn last, of all of them
    const shared::ShadowLayer& layer(int i) const { return layers_[std::size_t(i)]; }
    const gl::Texture& depth() const { return depth_; }  // DEPTH32F array, 1 near .. 0 far
    std::vector<gl::Resource> resources() const { return {depth_.resource()}; }
    // One entry a light: the maps that it has, or why it has none.
    std::vector<Need> needs(const GpuScene& scene) const;

private:
    void aim(const GpuScene& scene);

    ShadowMapParams params_;                       // of the last draw
    MadeFrom<Revision, Revision, int> made_from_;  // geometry, lights, size
    MadeFrom<float, bool> looked_into_;            // bias, receiver plane
    Revision revision_ = 0;
    bool drawn_ = false;
    std::size_t draws_ = 0;
    gl::Program program_;
    std::vector<Triangle> triangles_;  // of the scene, kept for lights that move
    MadeFrom<Revision> triangles_of_;  // geometry
    std::vector<shared::ShadowLayer> layers_;
    std::vector<shared::ShadowLight> lights_;
    gl::Buffer layer_buffer_, light_buffer_;
    int size_ = 1;
    gl::Texture depth_;
    gl::Framebuffer framebuffer_;
};

// The matrices of a light's maps: depth 1 near, 0 far. `bounds` are the scene's. Empty for a light that gives nothing
// or throws no shadow. Without `triangles` nothing is fitted: the maps hold all that is in `bounds`.
std::vector<glm::mat4> shadow_matrices(const Light& light, const Bounds& bounds, const std::vector<Triangle>* triangles,
                                       int map_size);

}  // namespace conebook
