// A scene made in code and its lit voxels: chapters 03 to 07 without a program around them. Header only.
#pragma once

#include "07_anisotropic_mips/light_pyramid.hpp"
#include "voxel_scene.hpp"

namespace conebook {

// Voxels -> what the lights reach -> what the faces reflect of it -> its pyramids.
struct LitScene : VoxelScene {
    ShadowMaps shadow_maps;
    VoxelShading shading;
    LightPyramid pyramid;

    LitScene(const Scene& source, int voxels, const VoxelShadingParams& shading_params = {},
             const PyramidParams& pyramid_params = {})
        : VoxelScene(source, source.bounds, voxels),
          shadow_maps(test_gl().shaders),
          shading(test_gl().shaders),
          pyramid(test_gl().shaders)
    {
        shadow_maps.draw(scene, {});
        average();
        shading.run(scene, grid, voxelizer, faces, shadow_maps, shading_params);
        pyramid.run(grid, faces, shading.radiance(), shading.revision(), pyramid_params);
    }
};

}  // namespace conebook
