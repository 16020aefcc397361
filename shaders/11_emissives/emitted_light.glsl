// What surfaces emit, beside what they reflect: included before chapter 08's cones, which then bring both.
#include "07_anisotropic_mips/pyramid.glsl"

// Premultiplied with the coverage.
vec3 emitted_light(ivec3 faces, vec3 weight, vec3 p, int level)
{
    return weight.x * emission_at(faces.x, p, level) + weight.y * emission_at(faces.y, p, level) +
           weight.z * emission_at(faces.z, p, level);
}
#define EMITTED_LIGHT(faces, weight, p, level, t) emitted_light(faces, weight, p, level)
