#version 450 core
// What the pyramids give at places, for tests. One thread a place.
#include "07_anisotropic_mips/pyramid.glsl"

struct Place {
    vec4 p;      // xyz: voxels of the level
    ivec4 what;  // x: face, y: level
};
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer PlaceBuffer { Place places[]; };
layout(std430, binding = 1) writeonly buffer FoundBuffer { vec4 found[]; };
uniform int which;  // 0: a voxel's own light, 1: light between, 2: coverage between, 3: a voxel's own emission, 4: between

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(places.length())) return;
    int face = places[i].what.x, level = places[i].what.y;
    vec3 p = places[i].p.xyz;
    ivec3 voxel = ivec3(floor(p));
    if (which == 0) found[i] = light_of(face, voxel, level);
    if (which == 1) found[i] = light_at(face, p, level);
    if (which == 2) found[i] = vec4(coverage_at(face, p, level));
    if (which == 3) found[i] = vec4(emission_of(face, voxel, level), 0.0);
    if (which == 4) found[i] = vec4(emission_at(face, p, level), 0.0);
}
