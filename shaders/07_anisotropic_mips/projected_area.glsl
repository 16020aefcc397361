// Area of a voxel's face as seen along a direction of the pyramid, in voxel sides squared.
#include "common/voxel_grid.glsl"

float projected_area(VoxelFace face, int direction)
{
#if ISOTROPIC
    vec3 n = abs(face.normal.xyz);  // every direction sees what the best one sees
    return face.albedo_area.a * max(n.x, max(n.y, n.z));
#else
    return face.albedo_area.a * max(dot(face.normal.xyz, face_normal(direction)), 0.0);
#endif
}
