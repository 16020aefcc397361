// Rays from the pixels through the voxels: indirect diffuse light as the mean of what comes along them.
#pragma once

#include "08_diffuse_cones/gather_points.hpp"
#include "18_voxel_ray_marching/piece_voxels.hpp"

namespace conebook {

enum class Facing : int { back_faces = 0, cosine = 1, none = 2 };

struct RayParams {
    // Of a point that gathers, 1 .. 4096: noise falls with their root, or faster (sequence).
    int rays = 30;
    // w of normalize(n + w R), R on the unit sphere, 0 .. 4. 1: distributed as the cosine, so that their plain mean is
    // E / pi; less: a cone of half angle asin w.
    float spread = 1.0f;
    // even: a lattice that 4 x 4 neighbours share; random: independent numbers.
    int sequence = 0;
    // dda: every voxel on the way; fixed: samples at `steps` steps of `step`, which miss some.
    int march = 0;
    // piece: a ray ends on the plane of the piece that a voxel holds (payload=index and march=dda); voxel: where it
    // enters the voxel.
    int hit = 0;
    int steps = 60;     // of march=fixed, 1 .. 1024; with `step` also the range of falloff=window
    float step = 1.0f;  // voxels, 0.1 .. 8
    // hit=voxel: what is nearer is left out, so that a surface does not meet its own voxels, voxels, 0 .. 16. What is
    // near goes with it.
    float min_distance = 1.0f;
    // back_faces: pieces that turn their back send nothing; cosine: the document's factor max(-n.d, 0); none: all send.
    int facing = int(Facing::back_faces);
    // none is right: radiance does not change along a ray. window: (1 - t / (steps * step))^2; square: 1 / t^2, t in
    // m, at most 1. Both are documented ways to get it wrong.
    int falloff = 0;
    int scale = 2;     // one of every scale x scale pixels gathers: 1, 2 or 4
    bool blur = true;  // points of one surface share what they gathered
    float sky = 0.0f;  // W/(sr m^2), 0 .. 1e4: what rays bring that leave the voxels
    // 0: none of this; 1: one bounce. More would need light that has arrived in the voxels.
    int bounces = 1;
};
void add_parameters(ParameterTable& table, RayParams& params);
std::vector<Need> ray_needs(const RayParams& rays, const PieceVoxelParams& voxels);

class RayMarching {
public:
    explicit RayMarching(gl::Shaders& shaders);

    // RGBA32F of the g-buffer's size: rgb E / pi, W/(sr m^2). Valid until the next call.
    const gl::Texture& run(const GBuffer& g_buffer, const VoxelGrid& grid, const PieceVoxels& voxels,
                           const RayParams& params);
    // The same before points share it: scale x scale pixels each, alpha 1 where there is a surface.
    const gl::Texture& unblurred(glm::ivec2 size);
    std::vector<gl::Resource> resources() const;

private:
    gl::ProgramVariants rays_, upsample_;
    GatherPoints points_;
    PointFilter filter_;
    gl::VertexArray no_vertices_;
    gl::Texture gathered_, light_, shown_;
    gl::Framebuffer gathered_framebuffer_, light_framebuffer_, shown_framebuffer_;
};

}  // namespace conebook
