// Set the bit of the triangle's face in the voxel; a double-sided triangle has two.
#include "04_conservative_voxelization/triangle_voxels.glsl"
#include "common/voxel_counters.glsl"
#include "common/scene_structs.glsl"

layout(std140, binding = kMaterialBlock) uniform MaterialBlock { MaterialData drawn_material; };
layout(r32ui, binding = 0) uniform uimage3D occupancy;
#if COUNT_FRAGMENTS
layout(r32ui, binding = 1) uniform uimage3D fragment_counts;
#endif

// snippet: mark
void visit(GridTriangle t, ivec3 voxel_t)
{
    int face = front_face(t);
    uint bits = 1u << face;
    if ((drawn_material.flags & kMaterialDoubleSided) != 0) bits |= 1u << (face ^ 1);
    imageAtomicOr(occupancy, axis_from_z(voxel_t, t.axis), bits);
    atomicAdd(voxel_statistics.fragments, 1u);
#if COUNT_FRAGMENTS
    imageAtomicAdd(fragment_counts, axis_from_z(voxel_t, t.axis), 1u);
#endif
}
// end snippet
