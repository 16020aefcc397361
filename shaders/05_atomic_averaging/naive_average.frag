#version 450 core
// Two ways to put many fragments into one 8-bit texel, for comparison with the sums; the material is the same.
// RACING_STORE: the last writer wins. Otherwise: running mean by compare-and-swap with the count in alpha
// (Crassin & Green 2012, listing 22.2; Villegas 2016, section 4.2): C(i+1) = (i C(i) + x(i+1)) / (i+1).
#include "04_conservative_voxelization/triangle_voxels.glsl"
#include "05_atomic_averaging/triangle_attributes.glsl"
#include "05_atomic_averaging/triangle_part.glsl"
#include "05_atomic_averaging/voxel_material.glsl"

flat in TriangleAttributes attributes;
layout(r32ui, binding = 0) uniform uimage3D mean_color;  // RGBA8 in 32 bits

const int kMaxTries = 255;  // as published; the fragment is lost after them

void visit(GridTriangle t, ivec3 voxel_t)
{
    ivec3 voxel = axis_from_z(voxel_t, t.axis);
    TrianglePart part = part_in_voxel(t, voxel_t);
    vec3 albedo = voxel_material(t, attributes, vec3(voxel_t) + part.center, part.area).albedo;
#if RACING_STORE
    imageStore(mean_color, voxel, uvec4(packUnorm4x8(vec4(albedo, 1.0))));
#else
    // snippet: compare_and_swap
    uint expected = 0u, wanted = packUnorm4x8(vec4(albedo, 1.0 / 255.0));
    for (int i = 0; i < kMaxTries; ++i) {
        uint found = imageAtomicCompSwap(mean_color, voxel, expected, wanted);
        if (found == expected) break;
        vec4 mean = unpackUnorm4x8(found);
        float count = round(mean.a * 255.0);
        vec3 next = (mean.rgb * count + albedo) / (count + 1.0);
        expected = found;
        wanted = packUnorm4x8(vec4(next, mod(count + 1.0, 256.0) / 255.0));
    }
    // end snippet
#endif
}
#include "04_conservative_voxelization/voxelize_fragment.glsl"
