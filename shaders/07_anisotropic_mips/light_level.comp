#version 450 core
// Next level: of two voxels behind each other the front one hides as much of the back one as must overlap, four columns
// beside each other are averaged (after Crassin 2011, section 5; Villegas 2016, section 3.5.1).
#include "07_anisotropic_mips/store_light.glsl"
#include "07_anisotropic_mips/column_weight.glsl"
#include "common/item_index.glsl"
#include "07_anisotropic_mips/occupied_levels.glsl"

uniform int level;
uniform uint begin;  // of the level's part of the list

vec4 finer(int face, ivec3 voxel) { return light_of(face, voxel, level - 1); }

vec4 filtered(int face, ivec3 voxel)
{
    vec4 sum = vec4(0.0);
    float weights = 0.0;
#if DIRECTIONS == 2
    // Isotropic, as mipmaps of volumes are usually made: the mean of the eight, whatever hides what.
    for (int i = 0; i < 8; ++i) {
        ivec3 child = 2 * voxel + ivec3(i & 1, (i >> 1) & 1, i >> 2);
        float weight = inside_share(child, 0, level - 1) * inside_share(child, 1, level - 1) *
                       inside_share(child, 2, level - 1);
        sum += weight * finer(face, child);
        weights += weight;
    }
#else
    int axis = face >> 1;
    ivec3 along = ivec3(face_normal(face | 1));
    // The side that the face looks to is in front.
    ivec3 to_front = (face & 1) == 1 ? along : ivec3(0), to_back = along - to_front;
    for (int column = 0; column < 4; ++column) {
        ivec3 child = 2 * voxel;
        child[(axis + 1) % 3] += column & 1;
        child[(axis + 2) % 3] += column >> 1;
        // snippet: front_and_back
        vec4 front = finer(face, child + to_front), back = finer(face, child + to_back);
        float weight = column_weight(child, face, level - 1);
        float seen = back.a > 0.0 ? min((1.0 - front.a) / back.a, 1.0) : 0.0;
        sum += weight * (front + back * seen);
        weights += weight;
        // end snippet
    }
#endif
    return sum / weights;
}

void main()
{
    uint place = item_index();
    if (place >= levels[level].count) return;
    ivec3 voxel = unpack_voxel(occupied[begin + place]);
    for (int face = 0; face < kFaceCount; ++face) store_texel(face, voxel, level, filtered(face, voxel));
}
