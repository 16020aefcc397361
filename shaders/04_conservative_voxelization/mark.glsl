// What is done with a triangle and a voxel that overlap: set the bit of the triangle's face in the voxel (two bits of a
// double-sided one), and put the pair into the list of fragments, from which chapter 05 goes on.
#include "04_conservative_voxelization/triangle_voxels.glsl"
#include "common/voxel_counters.glsl"
#include "common/scene_structs.glsl"

layout(std430, binding = kTriangleMaterialBinding) readonly buffer TriangleWordBuffer { uint triangle_words[]; };
layout(std430, binding = kFragmentRangeBinding) buffer FragmentRangeBuffer { FragmentRange fragment_ranges[]; };
layout(std430, binding = kFragmentBinding) writeonly buffer FragmentBuffer { uvec2 fragments[]; };
layout(r32ui, binding = 0) uniform uimage3D occupancy;
#if COUNT_FRAGMENTS
layout(r32ui, binding = 1) uniform uimage3D fragment_counts;
#endif

// snippet: mark
void mark(GridTriangle t, uint triangle, ivec3 voxel_t)
{
    ivec3 voxel = axis_from_z(voxel_t, t.axis);
    uint material = triangle_words[triangle];
    uint bits = 1u << front_face(t);
    if ((material & kTriangleDoubleSided) != 0u) bits |= 1u << (front_face(t) ^ 1);
    // Most voxels meet several triangles of a face; an old value read here costs an atomic and nothing else.
    if ((imageLoad(occupancy, voxel).r & bits) != bits) imageAtomicOr(occupancy, voxel, bits);
    // Each material has its own part of the list, since only one material's textures are bound at a time. Beyond its
    // end fragments are counted and not kept: then the list is made longer, and the pass runs again.
    material &= ~kTriangleDoubleSided;
    uint place = atomicAdd(fragment_ranges[material].count, 1u);
    if (place < fragment_ranges[material].capacity)
        fragments[fragment_ranges[material].begin + place] = uvec2(triangle, pack_voxel(voxel));
#if COUNT_FRAGMENTS
    imageAtomicAdd(fragment_counts, voxel, 1u);
#endif
}
// end snippet

// snippet: column
void mark_column(GridTriangle t, uint triangle, ivec2 column)
{
    ivec2 range = column_range(t, column);
    for (int z = range.x; z <= range.y; ++z)
        if (overlaps(t, ivec3(column, z))) mark(t, triangle, ivec3(column, z));
}
// end snippet
