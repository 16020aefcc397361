// A scene made in code and its shadows and emitters: chapters 02 to 11 without a program around them. Header only.
//
//     LightPipeline pipeline(scene, camera, {256, 256}, 128);
//     const ImageF visible = pipeline.visibility(ShadowMethod::cone, soft_shadow_params);
#pragma once

#include "10_soft_shadows/soft_shadows.hpp"
#include "11_emissives/emissive_light.hpp"
#include "cone_pipeline.hpp"

namespace conebook {

class LightPipeline {
public:
    LightPipeline(const Scene& scene, const Camera& camera, glm::ivec2 size, int voxels)
        : scene_((test_gl(), scene)),  // the context comes first
          shadow_maps_(test_gl().shaders, scene_, {}),
          grid_(scene_.bounds(), {voxels}),
          voxelizer_(test_gl().shaders, grid_, {}),
          faces_(test_gl().shaders, grid_, voxelizer_),
          shading_(test_gl().shaders, {}),
          pyramid_(test_gl().shaders, grid_, {}),
          emissive_(test_gl().shaders),
          g_buffer_(test_gl().shaders, size)
    {
        shadow_maps_.draw(scene_);
        voxelizer_.run(scene_, grid_);
        faces_.run(scene_, grid_, voxelizer_);
        pyramid_.clear();
        shading_.run(scene_, grid_, voxelizer_, faces_, shadow_maps_);
        pyramid_.run(grid_, faces_, shading_.radiance());
        look(camera);
    }

    void look(const Camera& camera) { g_buffer_.draw(scene_, camera_data(camera, g_buffer_.size())); }

    // Only what the faces emit by themselves stays in the pyramids.
    void keep_emission_alone() { pyramid_.run(grid_, faces_, emissive_.run(faces_)); }

    // Mean visible share of the lights, 0..1, in all channels; alpha 1 where there is a surface.
    ImageF visibility(ShadowMethod method, const SoftShadowParams& params, const ConeParams& cone_params = {})
    {
        return direct(method, params, cone_params, true);
    }
    // Radiance of direct light.
    ImageF direct(ShadowMethod method, const SoftShadowParams& params, const ConeParams& cone_params = {},
                  bool show_visibility = false)
    {
        SoftShadowLighting lighting(test_gl().shaders, grid_, method);
        return read_picture(lighting.run(g_buffer_, scene_, grid_, faces_, shading_, pyramid_, shadow_maps_,
                                         cone_params, params, show_visibility));
    }
    // rgb: E / pi, the cosine-weighted mean radiance over the hemisphere, W/(sr m^2); a: ambient.
    ImageF gathered(const ConeParams& params)
    {
        DiffuseCones cones(test_gl().shaders, grid_, {});
        return read_picture(cones.run(g_buffer_, grid_, pyramid_, DiffuseConeUniforms(params), params));
    }

    const VoxelGrid& grid() const { return grid_; }
    const VoxelFaces& faces() const { return faces_; }

private:
    GpuScene scene_;
    ShadowMaps shadow_maps_;
    VoxelGrid grid_;
    ConservativeVoxelizer voxelizer_;
    VoxelFaces faces_;
    VoxelShading shading_;
    LightPyramid pyramid_;
    EmissiveLight emissive_;
    GBuffer g_buffer_;
};

}  // namespace conebook
