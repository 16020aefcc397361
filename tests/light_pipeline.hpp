// A scene made in code and its shadows and emitters: chapters 02 to 11 without a program around them. Header only.
//
//     LightPipeline pipeline(scene, camera, {256, 256}, 128);
//     const ImageF visible = pipeline.visibility(ShadowMethod::cone, soft_shadow_params);
#pragma once

#include "10_soft_shadows/soft_shadows.hpp"
#include "11_emissives/emitter_light.hpp"
#include "cone_pipeline.hpp"

namespace conebook {

class LightPipeline {
public:
    LightPipeline(const Scene& scene, const Camera& camera, glm::ivec2 size, int voxels)
        // The voxels hold what surfaces reflect, the emitters the rest.
        : lit_(scene, voxels),
          emitters_(test_gl().shaders, scene),
          g_buffer_(test_gl().shaders, size),
          walk_(test_gl().shaders),
          diffuse_(test_gl().shaders),
          emitter_light_(test_gl().shaders)
    {
        walk_.run(lit_.grid, lit_.faces);
        emitters_.run(lit_.scene, lit_.grid, lit_.faces, lit_.shading, {});
        lit_.pyramid.run(lit_.grid, lit_.faces, lit_.shading.radiance(), lit_.shading.revision(), {},
                         emitters_.part_of_voxels());
        look(camera);
    }

    void look(const Camera& camera)
    {
        g_buffer_.draw(lit_.scene, camera_data(camera, g_buffer_.size(), lit_.scene.bounds()));
    }

    // Only what the faces emit by themselves stays in the pyramids.
    void keep_emission_alone()
    {
        lit_.pyramid.run(lit_.grid, lit_.faces, lit_.shading.radiance(), lit_.shading.revision(), {},
                          LightPart::none);
    }

    // Mean visible share of the lights, 0..1, in all channels; alpha 1 where there is a surface.
    ImageF visibility(ShadowMethod method, const SoftShadowParams& params, const ConeParams& cone_params = {})
    {
        return direct(method, params, cone_params, true);
    }
    // Radiance of direct light.
    ImageF direct(ShadowMethod method, SoftShadowParams params, const ConeParams& cone_params = {},
                  bool show_visibility = false)
    {
        SoftShadowLighting lighting(test_gl().shaders);
        params.shadows = method;
        return read_picture(lighting.run(g_buffer_, lit_.scene, {lit_.grid, lit_.pyramid, walk_}, lit_.faces,
                                         lit_.shading, lit_.shadow_maps, cone_params, params, show_visibility));
    }
    // rgb: E / pi, the cosine-weighted mean radiance over the hemisphere, W/(sr m^2); a: ambient.
    ImageF gathered(const ConeParams& params)
    {
        ConeDirections directions;
        directions.update(params, 0);
        const ConeVolumes volumes{lit_.grid, lit_.pyramid, walk_};
        const gl::Texture& cones = diffuse_.run(g_buffer_, volumes, directions, params, {});
        return read_picture(emitter_light_.run(g_buffer_, volumes, emitters_, diffuse_, cones, params));
    }

    const VoxelGrid& grid() const { return lit_.grid; }
    const VoxelFaces& faces() const { return lit_.faces; }

private:
    LitScene lit_;
    Emitters emitters_;
    GBuffer g_buffer_;
    WalkVolume walk_;
    DiffuseCones diffuse_;
    EmitterLight emitter_light_;
};

}  // namespace conebook
