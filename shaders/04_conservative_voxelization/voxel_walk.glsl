// Walk along a ray from voxel to voxel (Amanatides & Woo 1987) until one is occupied.
#include "common/voxel_grid.glsl"

#ifdef OCCUPANCY_STORAGE
#include OCCUPANCY_STORAGE
#else
layout(binding = kOccupancyUnit) uniform usampler3D occupancy;
bool is_occupied(ivec3 voxel, int level) { return texelFetch(occupancy, voxel, level).r != 0u; }
#endif

struct VoxelHit {
    bool hit;
    ivec3 voxel;    // of the level that was walked
    vec3 normal;    // of the side of the cube that the ray came in through
    float t;        // ray parameter where it came in, in level voxels
};

// `origin` and `direction` in the grid space of `level` (voxel size 2^level), direction with any length.
VoxelHit walk_voxels(vec3 origin, vec3 direction, int level)
{
    ivec3 size = max(grid.size.xyz >> level, ivec3(1));
    direction = mix(direction, vec3(1e-8), lessThan(abs(direction), vec3(1e-8)));
    vec3 inverse = 1.0 / direction;
    vec3 to_low = -origin * inverse, to_high = (vec3(size) - origin) * inverse;
    vec3 enter = min(to_low, to_high), leave = max(to_low, to_high);
    float t = max(0.0, max(enter.x, max(enter.y, enter.z)));
    float t_end = min(leave.x, min(leave.y, leave.z));
    VoxelHit hit = VoxelHit(false, ivec3(0), vec3(0.0), t);
    hit.normal = -sign(direction) * vec3(equal(enter, vec3(t)));
    ivec3 voxel = clamp(ivec3(floor(origin + direction * (t + 1e-4))), ivec3(0), size - 1);
    ivec3 step_by = ivec3(sign(direction));
    vec3 next = (vec3(voxel) + max(vec3(step_by), vec3(0.0)) - origin) * inverse;
    int steps = t < t_end ? size.x + size.y + size.z : 0;
    for (int i = 0; i < steps; ++i) {
        if (is_occupied(voxel, level)) {
            hit.hit = true;
            hit.voxel = voxel;
            hit.t = t;
            break;
        }
        t = min(next.x, min(next.y, next.z));
        bvec3 crossed = next.x <= next.y && next.x <= next.z ? bvec3(true, false, false)
                        : next.y <= next.z                   ? bvec3(false, true, false)
                                                             : bvec3(false, false, true);
        vec3 mask = vec3(crossed);
        voxel += step_by * ivec3(mask);
        next += mask * abs(inverse);
        hit.normal = -vec3(step_by) * mask;
        if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, size))) break;
    }
    return hit;
}
