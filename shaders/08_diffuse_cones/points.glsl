// The points that gather: one of every gather_scale x gather_scale pixels, what neighbours need to know of it in one texel.
// xyz: position in grid space, as bits of floats, infinite where nothing was drawn; w: shading normal, octahedral.
#include "common/octahedral.glsl"
#include "common/voxel_grid.glsl"

layout(binding = 16) uniform usampler2D points;
uniform int gather_scale;
uniform ivec2 gather_offset;  // of the pixel that gathers within its gather_scale x gather_scale pixels

ivec2 gathering_pixel(ivec2 point) { return point * gather_scale + gather_offset; }

uvec4 pack_point(vec3 position_grid, vec3 normal)
{
    return uvec4(floatBitsToUint(position_grid), packSnorm2x16(octahedral_encode(normal)));
}

const float kMinCosine = 0.9;       // between normals of one surface
const float kPlaneTolerance = 1.0;  // voxels

// Whether a point lies on the surface through `position` (grid space) with these normals.
bool same_surface(uvec4 point, vec3 position, vec3 geometric_normal, vec3 normal)
{
    vec3 to_point = uintBitsToFloat(point.xyz) - position;
    return abs(dot(to_point, geometric_normal)) < kPlaneTolerance &&
           dot(octahedral_decode(unpackSnorm2x16(point.w)), normal) > kMinCosine;
}
