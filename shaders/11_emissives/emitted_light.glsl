// What surfaces emit, beside what they reflect: included before chapter 08's cones, which then bring both.
#include "07_anisotropic_mips/pyramid.glsl"

// Of an emitter far away cones gather a part only; the rest is aimed at (aimed.glsl).
uniform float near_radius2;  // voxels squared

// Power heuristic (Veach 1997, 9.2.2.2) of the densities n / pi of cones and n t^2 / A of parts of an emitter of area
// A = pi r^2, without the cosines, of which neither knows both; moved so that it ends, at 2.6 r.
// snippet: near_share
float near_share(float t)
{
    const float kEnd = 0.02;
    float q = t * t / near_radius2;
    return max((1.0 / (1.0 + q * q) - kEnd) / (1.0 - kEnd), 0.0);
}
// end snippet

// At distance t, premultiplied with the coverage.
vec3 emitted_light(ivec3 faces, vec3 weight, vec3 p, int level, float t)
{
    return near_share(t) * (weight.x * emission_at(faces.x, p, level) + weight.y * emission_at(faces.y, p, level) +
                            weight.z * emission_at(faces.z, p, level));
}
#define EMITTED_LIGHT(faces, weight, p, level, t) emitted_light(faces, weight, p, level, t)
