#version 450 core
// A picture with the outlines of some nodes over it, where no surface is in front of them.
#include "common/camera_ray.glsl"
#include "common/g_buffer.glsl"
#include "common/voxel_grid.glsl"
#include "17_sparse_voxel_octree/octree_structs.glsl"

layout(binding = 16) uniform sampler2D picture;
// xyz: corner, w: side, voxels
layout(std430, binding = kTreeChangeBinding) readonly buffer BoxBuffer { vec4 boxes[]; };
uniform int box_count;
layout(location = 0) out vec4 color;

const float kWire = 1.2;  // pixels, half the width of a line

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    color = texelFetch(picture, pixel, 0);
    Ray ray = camera_ray(gl_FragCoord.xy), beside = camera_ray(gl_FragCoord.xy + vec2(1.0, 0.0));
    vec3 origin = grid_from_scene(ray.origin), direction = ray.direction;
    vec3 inverse = 1.0 / mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    float between = length(grid_from_scene(beside.origin) - origin), spread = length(beside.direction - direction);
    GBufferSample surface = read_g_buffer(pixel);
    float wall = surface.covered ? length(grid_from_scene(surface.position) - origin) + 1.0 : 1e30, nearest = 1e30;
    for (int i = 0; i < box_count; ++i) {
        vec3 a = (boxes[i].xyz - origin) * inverse, b = (boxes[i].xyz + boxes[i].w - origin) * inverse;
        vec3 low = min(a, b), high = max(a, b);
        vec2 ends = vec2(max(low.x, max(low.y, low.z)), min(high.x, min(high.y, high.z)));
        if (ends.x > ends.y || ends.y < 0.0) continue;
        for (int k = 0; k < 2; ++k) {
            float t = ends[k];
            if (t < 0.0 || t > min(nearest, wall)) continue;
            // Of the side that is met, the distance to its nearest edge.
            vec3 q = origin + direction * t - boxes[i].xyz, to_edge = min(abs(q), abs(boxes[i].w - q));
            float first = min(to_edge.x, min(to_edge.y, to_edge.z)), last = max(to_edge.x, max(to_edge.y, to_edge.z));
            float second = to_edge.x + to_edge.y + to_edge.z - first - last;
            float width = kWire * (between + t * spread);
            if (second > width) continue;
            nearest = t;
            float share = float(i) / max(float(box_count - 1), 1.0);
            color = vec4(mix(vec3(1.0, 0.2, 0.05), vec3(0.1, 0.4, 1.0), share), 1.0);
        }
    }
}
