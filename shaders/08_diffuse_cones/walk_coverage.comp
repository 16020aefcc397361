#version 450 core
// Walk volume, step 4: what surfaces cover in a cell that is not empty, of its six sides: the mean of the eight voxels
// round its centre, as a linear filter would have it. One thread a cell.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "05_atomic_averaging/face_index.glsl"
#include "07_anisotropic_mips/projected_area.glsl"
#include "07_anisotropic_mips/column_weight.glsl"
#define STORES_WALK
#ifdef WALK_STORAGE
#include WALK_STORAGE
#else
#include "08_diffuse_cones/walk_volume.glsl"
#endif

layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(std430, binding = kWalkCellBinding) readonly buffer WalkCells { uint cell_count; uint cells[]; };
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };

// Of the voxel's cross-section along the axis: what looks down it, and what looks up.
vec2 covered(ivec3 voxel, int axis)
{
    uint entry = texelFetch(face_index, voxel, 0).r;
    vec2 sum = vec2(0.0);
    for (uint i = 0u; i < uint(bitCount(face_mask(entry))); ++i) {
        VoxelFace face = faces[(entry >> 6) + i];
        sum += vec2(projected_area(face, 2 * axis), projected_area(face, 2 * axis + 1));
    }
    return min(sum / column_weight(voxel, 2 * axis, 0), vec2(1.0));
}

void main()
{
    uint place = item_index();
    if (place >= cell_count) return;
    ivec3 cell = ivec3(cells[place] & 1023u, cells[place] >> 10 & 1023u, cells[place] >> 20);
    ivec3 low = ivec3(floor(grid.content_min.xyz)), high = ivec3(ceil(grid.content_max.xyz)) - 1;
    // snippet: coverage
    uint code = 1u << 31;
    for (int axis = 0; axis < 3; ++axis) {
        vec2 sum = vec2(0.0);
        for (int corner = 0; corner < 8; ++corner) {
            ivec3 voxel = cell - ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
            // Outside the bounds nothing lies across the axis; along the others the border is repeated.
            if (voxel[axis] < low[axis] || voxel[axis] > high[axis]) continue;
            sum += covered(clamp(voxel, low, high), axis);
        }
        uvec2 units = uvec2(round(sum / 8.0 * kWalkUnits));
        code |= units.x << (10 * axis) | units.y << (10 * axis + 5);
    }
    // end snippet
    store_walk(cell, code);
}
