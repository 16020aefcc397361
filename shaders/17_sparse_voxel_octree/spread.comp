#version 450 core
// The leaves' bricks: the up to 8 voxels of a leaf are spread over its 27 samples, along each axis (1/2, 0), (1/2,
// 1/2), (0, 1/2) of the two. What lies in neighbours is missing; the border transfer adds it.
#include "17_sparse_voxel_octree/brick_data.glsl"
#include "17_sparse_voxel_octree/leaf_faces.glsl"
#include "07_anisotropic_mips/projected_area.glsl"
#include "07_anisotropic_mips/column_weight.glsl"

layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kRadianceBinding) readonly buffer RadianceBuffer { vec4 face_radiance[]; };
layout(std140, binding = kPyramidBlock) uniform PyramidBlock { float light_scale; };  // W/(sr m^2)
uniform vec2 part;          // of what is reflected and of what is emitted: 1 or 0

// As chapter 07's finest level: the faces' radiance, each by its area projected on the axis, over the voxel's
// cross-section within the bounds.
vec4 voxel_light(uint leaf, ivec3 voxel, int direction)
{
    vec4 sum = vec4(0.0);
    uint entry = leaf_entry(leaf, voxel);
    for (uint i = entry >> 6; i < (entry >> 6) + uint(bitCount(face_mask(entry))); ++i)
        sum += projected_area(faces[i], direction) *
               vec4(part.x * face_radiance[i].rgb + part.y * faces[i].emission.rgb, 1.0);
    if (sum.a > 0.0) sum /= column_weight(voxel, direction, 0);
    sum /= max(sum.a, 1.0);
    return vec4(sum.rgb / light_scale, sum.a);
}

void main()
{
    if (item_index() >= brick_count) return;
    uint brick = first_brick + item_index(), node = brick_list[brick] >> 3;
    int direction = int(brick_list[brick] & 7u), axis = direction >> 1, b = (axis + 1) % 3, c = (axis + 2) % 3;
    ivec3 corner = 2 * unpack_place(node_places[node]), texel = brick_corner(brick);
    vec4 light[8];
    for (int i = 0; i < 8; ++i) {
        ivec3 voxel = corner + ivec3(i & 1, i >> 1 & 1, i >> 2);
        // Across the direction a voxel counts by what of it lies within the bounds.
        light[i] = voxel_light(node, voxel, direction) * weight_of(-1, b, voxel[b]) * weight_of(-1, c, voxel[c]);
    }
    // snippet: spread
    for (int sampled = 0; sampled < 27; ++sampled) {
        ivec3 k = ivec3(sampled % 3, sampled / 3 % 3, sampled / 9);
        vec4 sum = vec4(0.0);
        for (int i = 0; i < 8; ++i) {
            ivec3 voxel = ivec3(i & 1, i >> 1 & 1, i >> 2);
            // Half a voxel reaches each of the two samples at its sides.
            bool reached = all(lessThanEqual(abs(2 * voxel + 1 - 2 * k), ivec3(1)));
            sum += reached ? 0.125 * light[i] : vec4(0.0);
        }
        float within = weight_of(0, b, corner[b] + k[b]) * weight_of(0, c, corner[c] + k[c]);
        imageStore(pool, texel + k, stored(within > 0.0 ? sum / within : vec4(0.0)));
    }
    // end snippet
}
