// Directions of the rays: normalize(n + w R) with R on the unit sphere, which for w = 1 are distributed as the cosine
// (docs/18_voxel_ray_marching.md).
uniform int ray_count;
uniform float spread;       // w
uniform int random_rays;    // 1: independent random numbers; 0: a lattice that 4 x 4 neighbours share

// PCG (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering"), three words at a time.
uvec3 pcg3d(uvec3 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Two numbers in 0..1 for ray `i` of a point. The lattice is that of Fibonacci with 16 n points, each 16th of which is
// one neighbour's: what 16 neighbours share is as good as 16 times the rays.
// snippet: directions
vec2 ray_sample(ivec2 point, int i)
{
    if (random_rays == 1) return vec2(pcg3d(uvec3(point, i)).xy >> 8) / 16777216.0;
    int set = (point.x & 3) + 4 * (point.y & 3), j = 16 * i + (5 * set & 15);
    return vec2((float(j) + 0.5) / float(16 * ray_count), fract(float(j) * 0.61803399));
}

vec3 ray_direction(vec3 normal, vec2 u)
{
    float z = 1.0 - 2.0 * u.x, r = sqrt(max(1.0 - z * z, 0.0)), turn = 6.28318531 * u.y;
    vec3 on_sphere = vec3(r * cos(turn), r * sin(turn), z);
    vec3 d = normal + spread * on_sphere;
    d = dot(d, d) > 1e-8 ? normalize(d) : normal;
    return dot(d, normal) < 0.0 ? -d : d;  // w > 1 alone
}
// end snippet
