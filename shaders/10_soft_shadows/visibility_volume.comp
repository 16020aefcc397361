#version 450 core
// What chapter 06 found visible, from the list of faces to a volume that pixels can sample, the six directions side by
// side as in the pyramids. One thread an occupied face.
#include "07_anisotropic_mips/pyramid.glsl"
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"

layout(std430, binding = kFaceListBinding) readonly buffer FaceListBuffer { uint face_list[]; };
layout(std430, binding = kVisibilityBinding) readonly buffer VisibilityBuffer { uint face_visibility[]; };
layout(rgba8, binding = 0) writeonly uniform image3D visibility_volume;

void main()
{
    uint place = item_index();
    if (place >= voxel_statistics.faces) return;
    int face = int(face_list[place] >> 27);
    imageStore(visibility_volume, atlas_texel(face, unpack_voxel(face_list[place]), 0),
               vec4(unpackUnorm4x8(face_visibility[place]).rgb, 1.0));
}
