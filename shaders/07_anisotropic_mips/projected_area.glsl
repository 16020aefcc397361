// Area of a voxel's face as seen along a direction of the pyramid, in voxel sides squared.
#include "common/voxel_grid.glsl"

// The direction of the pyramid that a face looks to most.
int nearest_direction(vec3 normal)
{
    vec3 n = abs(normal);
    int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
    return 2 * axis + (normal[axis] > 0.0 ? 1 : 0);
}

float projected_area(VoxelFace face, int direction)
{
    return face.albedo_area.a * max(dot(face.normal.xyz, face_normal(direction)), 0.0);
}
