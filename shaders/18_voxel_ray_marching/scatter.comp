#version 450 core
// Every piece goes to the voxel of its centroid; of several in one, the larger word stays, whatever their order.
// INDEX 1: the word holds the piece's number. BRIGHTEST 1: of several pieces the brightest stays, 0: any, by lot.
// SIX_SIDES 1: each side of a voxel has a word.
#include "common/item_index.glsl"
#include "common/voxel_grid.glsl"
#include "18_voxel_ray_marching/packing.glsl"
#include "18_voxel_ray_marching/piece.glsl"
#include "18_voxel_ray_marching/piece_counts.glsl"

layout(std430, binding = kPieceBinding) readonly buffer PieceBuffer { Piece pieces[]; };
layout(r32ui, binding = 0) uniform uimage3D voxels;  // with six sides: a bit for each that there is
layout(r32ui, binding = 1) uniform uimage3D sides;   // six volumes side by side along x
uniform uint piece_count;

// A number 0..127 that depends on where the piece is alone: of several in a voxel each is as likely as the others to
// have the largest, so that what the voxels hold is right in the mean.
uint lot_of(Piece piece)
{
    uvec3 h = piece.place.xyz * 1664525u + 1013904223u;
    h.x += h.y * h.z;
    h.y += h.z * h.x;
    h.z += h.x * h.y;
    return ((h.x ^ h.y ^ h.z ^ piece.place.w) * 2654435769u) >> 25;
}

void main()
{
    uint item = item_index();
    if (item >= piece_count) return;
    Piece piece = pieces[item];
    vec3 normal = piece_normal(piece);
    ivec3 voxel = ivec3(floor(grid_from_scene(uintBitsToFloat(piece.place.xyz))));
    // snippet: scatter
    vec3 c = uintBitsToFloat(piece.light.xyz) / max(uintBitsToFloat(largest_radiance), 1e-30);
#if INDEX
#if BRIGHTEST
    uint rank = uint(round(127.0 * length(c) / sqrt(3.0)));
#else
    uint rank = lot_of(piece);
#endif
    uint word = pack_index(rank, item);
#else
    uint word = pack_payload(c, normal);
#endif
#if SIX_SIDES
    int side = side_of(normal);
    imageAtomicMax(sides, voxel + ivec3(side * grid.size.x, 0, 0), word);
    uint before = imageAtomicOr(voxels, voxel, 1u << side);
#else
    uint before = imageAtomicMax(voxels, voxel, word);
#endif
    if (before == 0u) atomicAdd(occupied_voxels, 1u);
    // end snippet
}
