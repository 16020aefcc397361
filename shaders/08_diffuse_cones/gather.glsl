// Cosine-weighted mean of the radiance over the hemisphere above a surface, by a set of cones: E / pi.
// MARCH 1: cones that march, for comparison. A chapter with a trace_cone() of its own includes that before and says so.
#ifdef OWN_TRACE_CONE
#elif MARCH
#include "08_diffuse_cones/march.glsl"
#else
#include "08_diffuse_cones/cone.glsl"
#endif
#include "common/frame.glsl"

const int kMaxCones = 1024;  // 16 KB, the least that OpenGL 4.5 promises a block (table 23.64)
// xyz: direction in the frame of the normal (z), w: weight; cone_sets sets of cone_count, weights of each sum to 1.
layout(std140, binding = kConeBlock) uniform ConeBlock { vec4 cones[kMaxCones]; };
uniform int cone_count;
uniform int cone_sets;
uniform float tan_half_aperture;
uniform float start_offset;     // voxels along the normal
uniform float first_threshold;  // 0..1

struct Gathered {
    vec3 mean_radiance;  // E / pi, W/(sr m^2)
    float ambient;       // 1: nothing near, 0: all blocked
};

// Thresholds of all cones of all sets, spread evenly and without a pattern: multiples of the golden ratio (Weyl 1916).
float threshold_of(int cone) { return kStopped * fract(first_threshold + (float(cone) + 0.5) * 0.61803399); }

// `set`: any number that differs among neighbours; it chooses their sets.
// snippet: gather_diffuse
Gathered gather_diffuse(RayStart start, vec3 geometric_normal, vec3 normal, int set)
{
    mat3 frame = frame_around(normal);
    int first = set % cone_sets * cone_count;
    Gathered sum = Gathered(vec3(0.0), 1.0);
    for (int i = first; i < first + cone_count; ++i) {
        vec3 direction = frame * cones[i].xyz;
        // Nothing comes from below the surface, whatever its shading normal says.
        if (dot(direction, geometric_normal) <= 0.0) continue;
        ConeLight light = trace_cone(start, direction, tan_half_aperture, threshold_of(i));
        sum.mean_radiance += cones[i].w * light.radiance;
        sum.ambient -= cones[i].w * light.occlusion;
    }
    return sum;
}
// end snippet
