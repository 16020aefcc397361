// A scene made in code, its pieces, voxels and rays: chapter 18 without a program around it. Header only.
#pragma once

#include "18_voxel_ray_marching/ray_marching.hpp"
#include "image/image.hpp"
#include "scene_builder.hpp"
#include "test_gl.hpp"

namespace conebook {

class MarchPipeline {
public:
    MarchPipeline(const Scene& scene, int voxel_count, const PieceVoxelParams& params = {}, float piece = 0.75f)
        : gl_(test_gl()),
          scene_(scene),
          maps_(gl_.shaders),
          grid_(scene.bounds, VoxelGridParams{voxel_count}),
          list_(gl_.shaders),
          voxels_(gl_.shaders),
          rays_(gl_.shaders)
    {
        maps_.draw(scene_, {});
        fill(params, piece);
    }
    // Once more, into another grid.
    MarchPipeline& in_grid(const shared::GridData& grid, const PieceVoxelParams& params = {}, float piece = 0.75f)
    {
        grid_.fit(grid);
        fill(params, piece);
        return *this;
    }
    void fill(const PieceVoxelParams& params, float piece = 0.75f)
    {
        list_.cut(scene_, grid_, {piece});
        list_.light(scene_, maps_);
        voxels_.run(list_, grid_, params);
    }

    std::vector<Piece> pieces() const
    {
        std::vector<Piece> all = list_.pieces().read<Piece>();
        all.resize(list_.count());
        return all;
    }
    // E / pi at every pixel; alpha 1 where there is a surface.
    ImageF gathered(const Camera& camera, glm::ivec2 size, const RayParams& params)
    {
        GBuffer g_buffer(gl_.shaders, size);
        g_buffer.draw(scene_, camera_data(camera, size, scene_.bounds()));
        ImageF image = read_picture(rays_.run(g_buffer, grid_, voxels_, params));
        const std::vector<float> depth = gl::read_floats(g_buffer.depth(), 0, 1);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                image.at(x, size.y - 1 - y).a = depth[std::size_t(y * size.x + x)] > 0.0f ? 1.0f : 0.0f;
        return image;
    }

    const VoxelGrid& grid() const { return grid_; }
    const StreamOut& list() const { return list_; }
    const PieceVoxels& voxels() const { return voxels_; }

private:
    TestGl& gl_;
    GpuScene scene_;
    ShadowMaps maps_;
    VoxelGrid grid_;
    StreamOut list_;
    PieceVoxels voxels_;
    RayMarching rays_;
};

}  // namespace conebook
