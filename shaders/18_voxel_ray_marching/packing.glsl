// One word for each voxel, of which the larger wins. After Ropret 2013, equations 2.5 to 2.9, corrected: each channel
// has four bits, so that it is scaled by 15 and not 31, and |c| of c in 0..1 reaches sqrt(3).
#include "common/bindings.glsl"

const uint kSolid = 0x80000000u;  // black is not empty
const int kIndexBits = 24;        // of the word with an index: 2^24 - 1 pieces, and 7 bits for their brightness

// snippet: packing
// `c`: radiance over the largest channel s of all pieces, 0..1.
uint pack_payload(vec3 c, vec3 normal)
{
    uvec3 color = uvec3(round(15.0 * clamp(c, 0.0, 1.0))), n = uvec3(round(31.0 * (0.5 * normal + 0.5)));
    uint brightness = uint(round(15.0 * length(c) / sqrt(3.0)));
    return kSolid | brightness << 27 | (n.x | n.y << 5 | n.z << 10) << 12 | color.r | color.g << 4 | color.b << 8;
}
vec3 unpack_color(uint word) { return vec3(word & 15u, (word >> 4) & 15u, (word >> 8) & 15u) / 15.0; }
vec3 unpack_normal(uint word)
{
    uint n = word >> 12;
    return normalize(2.0 / 31.0 * vec3(n & 31u, (n >> 5) & 31u, (n >> 10) & 31u) - 1.0);
}
// end snippet

// The piece itself instead of what fits into the word. `rank`: 0..127, the larger one stays.
uint pack_index(uint rank, uint piece) { return kSolid | rank << kIndexBits | piece; }
uint unpack_index(uint word) { return word & ((1u << kIndexBits) - 1u); }

// The side of a voxel that a piece belongs to: that which its normal is nearest to. 0 -x, 1 +x, 2 -y, ...
int side_of(vec3 normal)
{
    vec3 a = abs(normal);
    int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (normal[axis] > 0.0 ? 1 : 0);
}
