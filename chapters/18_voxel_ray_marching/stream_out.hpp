// Triangles cut into pieces smaller than a voxel and streamed out, with the light that leaves each.
#pragma once

#include "03_shadow_map/shadow_maps.hpp"
#include "04_conservative_voxelization/voxel_grid.hpp"

namespace conebook {

struct CubeParams {
    // Along the longest side of the scene, or of the cube, 4 .. 512.
    VoxelGridParams grid;
    // scene: a tight grid round all poses; 40: the document's cube of 40 m about the origin of the world, beyond which
    // nothing counts.
    int cube = 0;
};
void add_parameters(ParameterTable& table, CubeParams& params);
// `bounds` and `origin_ws`: of the scene (Scene::origin_ws), all its poses.
void fit_cube(VoxelGrid& grid, const Bounds& bounds, glm::dvec3 origin_ws, const CubeParams& params);

struct CutParams {
    // Longest edge of a piece in voxels, 0.25 .. 16. Up to 0.75 no voxel of a wall along the axes stays empty.
    float piece = 0.75f;
};
void add_parameters(ParameterTable& table, CutParams& params);

// 32 bytes each; shaders/18_voxel_ray_marching/piece.glsl is the same.
struct Piece {
    glm::vec3 centroid;        // scene space, m
    std::uint32_t normal = 0;  // of the triangle, octahedral, 2 x 16 bits
    glm::vec3 radiance;        // W/(sr m^2): emitted; after light() all that leaves
    std::uint32_t albedo = 0;  // roots of the channels, 3 x 10 bits
};

class StreamOut {
public:
    explicit StreamOut(gl::Shaders& shaders);

    // Cuts all triangles again. Pieces outside of the grid are left out; those of double-sided materials count twice,
    // once for each side. Throws std::runtime_error where a list that long, or a triangle that large, is not
    // possible.
    void cut(const GpuScene& scene, const VoxelGrid& grid, const CutParams& params);
    // Direct light on each piece.
    void light(const GpuScene& scene, const ShadowMaps& shadow_maps);

    GLuint count() const { return count_; }               // pieces, after cut()
    const gl::Buffer& pieces() const { return pieces_; }  // Piece, and room behind them
    const gl::Buffer& counts() const { return counts_; }  // piece_counts.glsl
    std::vector<gl::Resource> resources() const { return {pieces_.resource()}; }

private:
    gl::Program cut_, light_;
    gl::Buffer pieces_, counts_;
    gl::Framebuffer nowhere_;  // a draw wants a complete one, even one that discards all
    gl::Handle<gl::delete_query> generated_;
    GLuint count_ = 0;
};

}  // namespace conebook
