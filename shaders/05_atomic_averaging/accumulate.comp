#version 450 core
// Add a fragment to the sums of its voxel's face: exact area, exact centre of area, the material there.
// EMISSION: 1 when the material shines.
#include "05_atomic_averaging/fragment.glsl"
#include "05_atomic_averaging/face_index.glsl"

layout(r32ui, binding = 0) readonly uniform uimage3D face_index;
// Of a face kSumCount low words, then as many high ones.
layout(std430, binding = kSumBinding) buffer SumBuffer { uint sums[]; };
uniform uint first_face;  // the sums of faces before it are done

// 64-bit addition in two 32-bit atomics: whoever makes the low word wrap carries one into the high word. Integer sums
// do not depend on the order of the threads, so every run gives the same bits.
// snippet: add64
void add64(uint low_word, uint low, uint high)
{
    uint before = atomicAdd(sums[low_word], low);
    uint into_high = high + (before + low < before ? 1u : 0u);
    if (into_high != 0u) atomicAdd(sums[low_word + uint(kSumCount)], into_high);
}
// end snippet

// Values of whole units of 2^-30, under 2^32.
void add_vec3(uint low_word, vec3 units)
{
    for (int i = 0; i < 3; ++i) add64(low_word + uint(i), uint(round(units[i])), 0u);
}

// Any value: radiance has no upper end.
void add_large_vec3(uint low_word, vec3 units)
{
    for (int i = 0; i < 3; ++i) {
        float value = round(units[i]), high = floor(value / 4294967296.0);
        add64(low_word + uint(i), uint(value - high * 4294967296.0), uint(high));
    }
}

// A fragment counts at least this much, so that a face that triangles merely touch has means, too.
const float kLeastWeight = 256.0;  // of 2^30: 2.4e-7 voxel sides squared; albedo then rounds to 1/512

void main()
{
    uint item = item_index();
    if (item >= fragment_count) return;
    Fragment f = fetch_fragment(item);
    VoxelMaterial m = f.material;
    uint entry = imageLoad(face_index, f.voxel).r;
    vec3 position = axis_from_z(f.part.center, f.t.axis);
    // snippet: add_fragment
    float weight = max(round(f.part.area * m.coverage * kFixedPointOne), kLeastWeight);
    int sides = m.coverage > 0.0 ? m.sides : 0;
    for (int side = 0; side < sides; ++side) {
        int face = front_face(f.t) ^ side;
        if ((face_mask(entry) & (1u << face)) == 0u) continue;  // never: chapter 04 marked it
        uint place = face_place(entry, face), word = place * uint(2 * kSumCount);
        if (place < first_face) continue;
        add64(word + uint(kSumArea), uint(weight), 0u);
        add_vec3(word + uint(kSumAlbedo), m.albedo * weight);
        add_vec3(word + uint(kSumNormal), (side == 0 ? 1.0 + m.normal : 1.0 - m.normal) * weight);
        add_vec3(word + uint(kSumPosition), position * weight);
#if EMISSION
        add_large_vec3(word + uint(kSumEmission), m.emission * weight);
#endif
    }
    // end snippet
}
