#version 450 core
// Direct light arrives at the pieces: L = Le + (rho / pi) E, one thread a piece. Lights and shadow maps stand in
// storage buffers, which OpenGL 4.5 does not promise to geometry shaders: else the geometry shader would do this, as
// in Ropret 2013.
#include "common/brdf.glsl"
#include "common/light.glsl"
#include "common/item_index.glsl"
#include "common/shadow_map.glsl"
#include "18_voxel_ray_marching/piece.glsl"
#include "18_voxel_ray_marching/piece_counts.glsl"

layout(std430, binding = kPieceBinding) buffer PieceBuffer { Piece pieces[]; };
uniform uint piece_count;

// snippet: light
void main()
{
    uint item = item_index();
    if (item >= piece_count) return;
    Piece piece = pieces[item];
    vec3 position = uintBitsToFloat(piece.place.xyz), normal = piece_normal(piece), irradiance = vec3(0.0);
    for (int i = 0; i < light_count; ++i) {
        LightSample light = sample_light(lights[i], position);
        float cosine = max(dot(normal, light.direction), 0.0);
        irradiance += cosine * shadow_map_visibility(i, lights[i], position, normal) * light.irradiance;
    }
    vec3 radiance = uintBitsToFloat(piece.light.xyz) + unpack_albedo(piece.light.w) / kPi * irradiance;
    pieces[item].light.xyz = floatBitsToUint(radiance);
    // The largest channel of the list: positive floats are ordered as their bits are.
    atomicMax(largest_radiance, floatBitsToUint(max(radiance.r, max(radiance.g, radiance.b))));
}
// end snippet
