// What faces keep for the bounces, in as few bytes as will do: a bounce reads all of it.

// A link: the place of a face in the list, or one of these.
const uint kSkyLink = 0xfffffffeu;  // the ray leaves the scene
const uint kNoLink = 0xffffffffu;   // it ends on nothing that it could see

// The series of bounces converges only when every surface keeps some light; a white of 1 would never settle.
const float kMaxAlbedo = 0.99;

// Reflectance in steps of 1/1023.
uint pack_albedo(vec3 albedo)
{
    uvec3 steps = uvec3(round(min(albedo, vec3(kMaxAlbedo)) * 1023.0));
    return steps.r | steps.g << 10 | steps.b << 20;
}
vec3 unpack_albedo(uint bits) { return vec3(uvec3(bits) >> uvec3(0, 10, 20) & 1023u) / 1023.0; }

// Radiance as half floats.
const float kLargestHalf = 65504.0;
uvec2 pack_radiance(vec3 radiance)
{
    vec3 r = min(radiance, vec3(kLargestHalf));
    return uvec2(packHalf2x16(r.rg), packHalf2x16(vec2(r.b, 0.0)));
}
vec3 unpack_radiance(uvec2 bits) { return vec3(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y).x); }
