// Light of emitting surfaces by rays that are aimed at them. Included after 08_diffuse_cones/gather.glsl.
#include "common/brdf.glsl"

layout(std430, binding = kEmitterBinding) readonly buffer EmitterBuffer { EmitterPart emitters[]; };
uniform int emitters_per_set;
uniform int emitter_sets;

// Rays end this far in front of an emitter, in voxels, where its own blur and that of what it hangs on do not hide it.
const float kLift = 1.5;

// E / pi of the emitters' far share: the sum over parts of L A cos cos' / (pi d^2), each by what is open on the way. Near
// a part the disc of its area stands for it: L A / (d^2 + A / pi) is exact on the disc's axis, and finite.
// snippet: gather_emitters
vec3 gather_emitters(RayStart start, vec3 geometric_normal, vec3 normal, vec3 position_grid, int set)
{
    int first = set % emitter_sets * emitters_per_set;
    vec3 sum = vec3(0.0);
    for (int i = first; i < first + emitters_per_set; ++i) {
        EmitterPart part = emitters[i];
        vec3 to_part = part.position.xyz - position_grid;
        float d2 = dot(to_part, to_part);
        vec3 direction = to_part * inversesqrt(max(d2, 1e-6));
        float facing = max(dot(normal, direction), 0.0) * max(-dot(part.normal.xyz, direction), 0.0);
        if (facing <= 0.0 || dot(geometric_normal, direction) <= 0.0) continue;
        vec3 way = part.position.xyz + kLift * part.normal.xyz - start.position;
        float end = length(way), far_share = 1.0 - near_share(sqrt(d2));
        float open = 1.0 - covered_share(start, way / max(end, 1e-6), end);
        sum += part.intensity.rgb * (facing * far_share * open / (kPi * (d2 + part.position.w)));
    }
    return float(emitter_sets) * sum;  // a set holds 1 / emitter_sets of the parts
}
// end snippet
