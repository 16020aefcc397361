// The visibility that chapter 06 found for the faces, between the centres of voxels (after Villegas 2016, section
// 3.4.1).
#include "07_anisotropic_mips/pyramid.glsl"

layout(binding = 16) uniform sampler3D visibility_volume;  // rgb: visible shares of lights 0..2, a: 1 at a face

// snippet: kept
// Each of the three faces that the normal leans to counts with n_a^2, and only where there is one.
float kept_visibility(vec3 position, vec3 normal, int light)
{
    if (light > 2) return 1.0;
    vec3 p = clamp(grid_from_scene(position), vec3(0.5), vec3(grid.size.xyz) - 0.5);
    vec4 sum = vec4(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        int face = 2 * axis + (normal[axis] > 0.0 ? 1 : 0);
        sum += normal[axis] * normal[axis] * textureLod(visibility_volume, atlas_place(face, p, 0), 0.0);
    }
    return sum.a > 0.0 ? clamp(sum[light] / sum.a, 0.0, 1.0) : 1.0;
}
// end snippet
