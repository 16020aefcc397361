// The second half of the frame, chapters 02 and 08 to 11 in order: g-buffer -> direct light -> cones -> sum.
#pragma once

#include "02_g_buffer/g_buffer_view.hpp"
#include "10_soft_shadows/soft_shadows.hpp"
#include "11_emissives/emitters.hpp"

namespace conebook {

struct LitPixelParams {
    ConeParams cones;
    DiffuseConeParams diffuse;
    SpecularConeParams specular;
    SoftShadowParams shadows;
    CompositeParams composite;
};
void add_parameters(ParameterTable& table, LitPixelParams& params);

// final, the parts that add up to it, and what the voxels hold; the names that LitPixels::run knows.
std::vector<View> light_views();

class LitPixels {
public:
    // `emitters` and `params` must outlive this.
    LitPixels(gl::Shaders& shaders, const VoxelGrid& grid, Emitters& emitters, glm::ivec2 size,
              const LitPixelParams& params);

    // The cone directions, for whoever gathers as the pixels do.
    const DiffuseConeUniforms& cones() const { return cones_; }

    // RGBA32F: the frame's view of light that `voxels` hold. Without `indirect` no cones are traced, and no
    // specular ones where no surface has a specular lobe. Valid until the next call.
    const gl::Texture& run(App& app, const GpuScene& scene, const LitVoxels& voxels, const ShadowMaps& shadow_maps,
                           bool indirect);

    // RGBA32F: another of the light views, from what the last run made. Valid until the next call.
    const gl::Texture& composite(const std::string& view);

    const GBuffer& g_buffer() const { return g_buffer_; }
    const SpecularCones& specular_cones() const { return specular_cones_; }

    // Of what the last run made.
    std::vector<gl::Resource> resources() const;
    // `indirect` as in run().
    std::vector<Need> needs(const Scene& scene, bool indirect) const;

private:
    const LitPixelParams& params_;
    Emitters& emitters_;
    DiffuseConeUniforms cones_;
    GBuffer g_buffer_;
    SoftShadowLighting direct_lighting_;
    DiffuseCones diffuse_cones_;
    SpecularCones specular_cones_;
    CompositePass composite_;
    const gl::Texture *direct_ = nullptr, *gathered_ = nullptr, *specular_ = nullptr;  // of the last run
    PyramidViewPass pyramid_view_;
    GBufferViewPass g_buffer_view_;
};

}  // namespace conebook
