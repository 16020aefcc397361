// A piece of a triangle: 32 bytes in the list that the geometry shader streams out.
#include "common/bindings.glsl"
#include "common/octahedral.glsl"

struct Piece {
    uvec4 place;  // xyz: centroid, scene space, m, bits of floats; w: normal of the triangle, octahedral, 2 x 16 bits
    uvec4 light;  // xyz: radiance, W/(sr m^2), bits of floats: emitted, after light.comp all that leaves the piece;
                  // w: albedo, see pack_albedo()
};

vec3 piece_normal(Piece p) { return octahedral_decode(unpackSnorm2x16(p.place.w)); }

// 10 bits for the root of each channel: 1 % off at 0.01, 0.1 % at 0.5.
uint pack_albedo(vec3 albedo)
{
    uvec3 q = uvec3(round(1023.0 * sqrt(clamp(albedo, 0.0, 1.0))));
    return q.r | q.g << 10 | q.b << 20;
}
vec3 unpack_albedo(uint packed_albedo)
{
    vec3 root = vec3(packed_albedo & 1023u, (packed_albedo >> 10) & 1023u, (packed_albedo >> 20) & 1023u) / 1023.0;
    return root * root;
}
