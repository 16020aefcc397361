// Six directional pyramids of the light in the voxels, filtered from the finest level up.
#pragma once

#include "06_voxel_shading/voxel_shading.hpp"

namespace conebook {

struct PyramidParams {
    // The six directions of the finest level hold the same, for comparison: a wall then covers along itself too.
    bool isotropic = false;
};
void add_parameters(ParameterTable& table, PyramidParams& params);

class LightPyramid {
public:
    LightPyramid(gl::Shaders& shaders, const VoxelGrid& grid, const PyramidParams& params);

    // Empty all levels: needed when other voxels become occupied.
    void clear() const { light_.clear(); }
    // All levels from `face_radiance` (vec4 a face: rgb in W/(sr m^2)).
    void run(const VoxelGrid& grid, const VoxelFaces& faces, const gl::Buffer& face_radiance);

    // kLightAtlasUnit, for shaders that include common/pyramid.glsl.
    void bind() const;
    // rgba16f, six times the grid's width (face * size.x + x), all levels of the grid; see common/pyramid.glsl.
    const gl::Texture& light() const { return light_; }
    std::vector<gl::Resource> resources() const { return {light_.resource()}; }

private:
    gl::Program base_, next_level_;
    gl::Texture light_;
};

struct PyramidViewParams {
    int direction = 6;  // -x +x -y +y -z +z, or the side that is seen
};
void add_parameters(ParameterTable& table, PyramidViewParams& params);

class PyramidViewPass {
public:
    explicit PyramidViewPass(gl::Shaders& shaders);
    // RGBA16F, alpha 0 where no voxel is met. `show_coverage`: A as grey instead of radiance.
    const gl::Texture& run(const VoxelGrid& grid, const gl::Texture& occupancy, const LightPyramid& pyramid, int level,
                           const PyramidViewParams& params, bool show_coverage, const gl::Buffer& camera,
                           glm::ivec2 size);

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
