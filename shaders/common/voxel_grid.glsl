// The grid of this frame.
#include "common/bindings.glsl"
#include "common/voxel_structs.glsl"

layout(std140, binding = kGridBlock) uniform GridBlock { GridData grid; };

vec3 grid_from_scene(vec3 position) { return (position - grid.origin.xyz) / grid.origin.w; }
vec3 scene_from_grid(vec3 position_grid) { return position_grid * grid.origin.w + grid.origin.xyz; }

// A voxel, or a face of it, in 32 bits: 9 bits an axis, 3 bits for the face.
uint pack_voxel(ivec3 voxel) { return uint(voxel.x) | uint(voxel.y) << 9 | uint(voxel.z) << 18; }
ivec3 unpack_voxel(uint packed_voxel)
{
    return ivec3(packed_voxel & 511u, (packed_voxel >> 9) & 511u, (packed_voxel >> 18) & 511u);
}

vec3 face_normal(int face)
{
    vec3 n = vec3(0.0);
    n[face >> 1] = (face & 1) == 0 ? -1.0 : 1.0;
    return n;
}
