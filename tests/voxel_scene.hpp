// A scene made in code and its voxels: chapters 04 and 05 without a program around them. Header only.
#pragma once

#include "05_atomic_averaging/voxel_faces.hpp"
#include "test_gl.hpp"

namespace conebook {

// Triangles -> occupied voxels -> the mean material of their faces.
struct VoxelScene {
    GpuScene scene;
    VoxelGrid grid;
    VoxelizerParams voxelizer_params;
    ConservativeVoxelizer voxelizer;
    VoxelFaces faces;

    VoxelScene(const Scene& source, const Bounds& bounds, int voxels, const VoxelizerParams& params = {})
        : scene((test_gl(), source)),  // the context comes first
          grid(bounds, {voxels}),
          voxelizer_params(params),
          voxelizer(test_gl().shaders),
          faces(test_gl().shaders, voxelizer)
    {
    }
    // Anew, whether anything has changed or not.
    void voxelize()
    {
        voxelizer.forget();
        voxelizer.run(scene, grid, voxelizer_params);
    }
    void average()
    {
        voxelize();
        faces.run(scene, grid, voxelizer);
    }
};

}  // namespace conebook
