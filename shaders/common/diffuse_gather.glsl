// Cosine-weighted mean of the radiance over the hemisphere above a surface, by a set of cones: E / pi.
#include "common/cone.glsl"
#include "common/frame.glsl"

const int kMaxCones = 32 * 16;
// xyz: direction in the frame of the normal (z), w: weight; cone_sets sets of cone_count, weights of each sum to 1.
layout(std140, binding = kConeBlock) uniform ConeBlock { vec4 cones[kMaxCones]; };
uniform int cone_count;
uniform int cone_sets;
uniform float tan_half_aperture;
uniform float start_offset;         // voxels along the normal

struct Gathered {
    vec3 mean_radiance;   // E / pi, W/(sr m^2)
    float ambient;        // 1: nothing near, 0: all blocked
};

// `neighbour`: any number that differs among neighbours; it chooses their sets.
Gathered gather_diffuse(vec3 position_grid, vec3 geometric_normal, vec3 normal, int neighbour)
{
    mat3 frame = frame_around(normal);
    int first = neighbour % cone_sets * cone_count;
    Gathered sum = Gathered(vec3(0.0), 1.0);
    for (int i = 0; i < cone_count; ++i) {
        vec4 axis = cones[first + i];
        vec3 direction = frame * axis.xyz;
        // Nothing comes from below the surface, whatever its shading normal says.
        if (dot(direction, geometric_normal) <= 0.0) continue;
        Cone cone = cone_above(position_grid, geometric_normal, start_offset, direction, tan_half_aperture);
        ConeLight light = trace_cone(cone, cone_end(cone));
        sum.mean_radiance += axis.w * (light.radiance + light.transmittance * sky_radiance);
        sum.ambient -= axis.w * light.ambient;
    }
    return sum;
}
