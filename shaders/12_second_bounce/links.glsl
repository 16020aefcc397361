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

// Radiance as three shares, of 16 bits, of the power of two above the largest of them: of any size, to 1/65535 of that.
uvec2 pack_radiance(vec3 radiance)
{
    uint exponent = (floatBitsToUint(max(radiance.r, max(radiance.g, radiance.b))) >> 23) + 1u;  // as floats have it
    uvec3 shares = uvec3(round(radiance / uintBitsToFloat(exponent << 23) * 65535.0));
    return uvec2(shares.r | shares.g << 16, shares.b | exponent << 16);
}
vec3 unpack_radiance(uvec2 bits)
{
    return vec3(uvec3(bits.x, bits.x >> 16, bits.y) & 0xffffu) * (uintBitsToFloat(bits.y >> 16 << 23) / 65535.0);
}
