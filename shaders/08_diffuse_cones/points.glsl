// The points that gather: one of every gather_scale x gather_scale pixels, what neighbours need to know of it in one
// texel. xyz: position in grid space, as bits of floats, infinite where nothing was drawn; w: shading normal,
// octahedral.
#include "common/octahedral.glsl"
#include "common/voxel_grid.glsl"

layout(binding = 16) uniform usampler2D gathering_points;
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

// The four points around a pixel, with the weights of those that lie on its surface: bilinear, their sum 1 if there is
// any.
struct PointWeights {
    ivec2 place[4];
    float weight[4];
    float sum;  // before it was made 1; 0: no point fits
};

// snippet: points_around
PointWeights points_around(ivec2 pixel, vec3 position, vec3 geometric_normal, vec3 normal)
{
    vec2 place = vec2(pixel - gather_offset) / float(gather_scale), first = floor(place), part = place - first;
    ivec2 last = textureSize(gathering_points, 0) - 1;
    PointWeights result;
    result.sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        result.place[i] = clamp(ivec2(first) + corner, ivec2(0), last);
        vec2 bilinear = mix(1.0 - part, part, vec2(corner)) + 1e-4;
        bool same = same_surface(texelFetch(gathering_points, result.place[i], 0), position, geometric_normal, normal);
        result.weight[i] = same ? bilinear.x * bilinear.y : 0.0;
        result.sum += result.weight[i];
    }
    for (int i = 0; i < 4; ++i) result.weight[i] /= max(result.sum, 1e-9);
    return result;
}
// end snippet
