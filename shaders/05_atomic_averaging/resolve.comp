#version 450 core
// Sums to means, one thread a face.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"

layout(std430, binding = kFaceListBinding) readonly buffer FaceListBuffer { uint face_list[]; };
layout(std430, binding = kFaceBinding) writeonly buffer FaceBuffer { VoxelFace faces[]; };
uniform uint first_face, face_count;

#include "05_atomic_averaging/face_mean.glsl"

void main()
{
    if (item_index() >= face_count) return;
    uint place = first_face + item_index();
    faces[place] = face_mean(place, face_list[place]);
}
