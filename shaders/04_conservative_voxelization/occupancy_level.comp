#version 450 core
// A voxel of the next level is occupied by whatever occupies its eight children.
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(r32ui, binding = 0) readonly uniform uimage3D finer;
layout(r32ui, binding = 1) writeonly uniform uimage3D coarser;

void main()
{
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(voxel, imageSize(coarser)))) return;
    uint faces = 0u;
    for (int child = 0; child < 8; ++child)
        faces |= imageLoad(finer, 2 * voxel + ivec3(child & 1, (child >> 1) & 1, child >> 2)).r;
    imageStore(coarser, voxel, uvec4(faces));
}
