// What cones that leap and cones that march have in common: where they start, what they bring.
// Included after 07_anisotropic_mips/pyramid.glsl.

// What a chapter adds without a copy of this one's files: it defines these before it includes them. The light that
// surfaces emit, premultiplied with their coverage, where it is stored apart (chapter 11); counters (chapter 14).
#ifndef EMITTED_LIGHT
#define EMITTED_LIGHT(faces, weight, p, level, t) vec3(0.0)
#endif
#ifndef COUNT_LIGHT_FETCHES
#define COUNT_LIGHT_FETCHES(count)
#endif

uniform vec3 sky_radiance;  // W/(sr m^2), what leaves the grid sees
uniform float ao_falloff;   // 1/m, lambda of ambient occlusion
// Beyond these nothing is seen but the sky, m; 0: none.
uniform float range_diffuse;
uniform float range_ao;

struct ConeLight {
    vec3 radiance;    // mean over the cone, the sky's included, W/(sr m^2)
    float occlusion;  // 1 / (1 + lambda r) where it ends on a surface at distance r, 0 where it leaves the scene
};

float occlusion_at(float t) { return 1.0 / (1.0 + ao_falloff * t * grid.origin.w); }

// Cones of a surface start `offset` voxels beyond the middle of the surface's own voxel along the axis that the normal
// is nearest to.
RayStart start_above(vec3 position_grid, vec3 geometric_normal, float offset)
{
    vec3 n = abs(geometric_normal);
    vec3 axis = n.x >= n.y && n.x >= n.z ? vec3(1, 0, 0) : n.y >= n.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
    float along = dot(axis, geometric_normal);
    // Rounding must not decide between two voxels for a surface on the side between them: take the farther start.
    vec3 voxel_middle = floor(position_grid + 0.01 * sign(along) * axis) + 0.5;
    float from_middle = dot(axis, voxel_middle - position_grid);
    vec3 origin = position_grid + geometric_normal * (from_middle / along + offset / abs(along));
    int back = int(dot(axis, vec3(0.0, 2.0, 4.0))) + (along > 0.0 ? 0 : 1);
    return RayStart(origin, geometric_normal, coverage_at(back, voxel_middle, 0) * axis);
}
