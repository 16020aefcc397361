#version 450 core
// One bounce from voxel to voxel: every face reflects the mean of what the faces at the ends of its links reflect, and
// what emitters and the sky send. One thread a face. EMITTERS 1: some surface shines. FIRST, LAST 1: the first bounce
// of a run, the last one. WARM 1: the first one begins with the last solution.
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "12_second_bounce/links.glsl"

layout(std430, binding = kRadianceBinding) readonly buffer DirectBuffer { vec4 direct[]; };          // reflected of direct light: R(0)
layout(std430, binding = kLinkBinding) readonly buffer LinkBuffer { uint links[]; };
#if EMITTERS
layout(std430, binding = kFromEmittersBinding) readonly buffer EmittedBuffer { vec4 from_emitters[]; };  // E / pi
#endif
layout(std430, binding = kAlbedoBinding) readonly buffer AlbedoBuffer { uint albedo[]; };
#if WARM
layout(std430, binding = kRadianceBeforeBinding) readonly buffer BeforeBuffer { vec4 before[]; };         // of the last run
uniform uint known_faces;  // the faces from here on have come since then
#else
layout(std430, binding = kRadianceBeforeBinding) readonly buffer BeforeBuffer { uvec2 before[]; };         // R(k - 1)
#endif
#if LAST
layout(std430, binding = kRadianceAfterBinding) writeonly buffer AfterBuffer { vec4 after[]; };   // R(k)
#else
layout(std430, binding = kRadianceAfterBinding) writeonly buffer AfterBuffer { uvec2 after[]; };  // R(k)
#endif
layout(std430, binding = kChangeBinding) buffer ChangeBuffer { uint largest_change, largest_radiance; };  // float bits, >= 0
uniform int links_per_face;
uniform vec3 sky_radiance;

#if WARM
vec3 radiance_before(uint place) { return place < known_faces ? before[place].rgb : direct[place].rgb; }
#elif FIRST
vec3 radiance_before(uint place) { return direct[place].rgb; }
#else
vec3 radiance_before(uint place) { return unpack_radiance(before[place]); }
#endif

#if MEASURE
shared float group_change[64], group_radiance[64];

// The largest of the work group first: one atomic for all its faces. Floats that are not negative have the order of
// their bits.
void measure(vec3 change, vec3 radiance)
{
    uint i = gl_LocalInvocationIndex;
    group_change[i] = max(change.r, max(change.g, change.b));
    group_radiance[i] = max(radiance.r, max(radiance.g, radiance.b));
    barrier();
    for (uint half_count = 32u; half_count > 0u; half_count >>= 1) {
        if (i < half_count) {
            group_change[i] = max(group_change[i], group_change[i + half_count]);
            group_radiance[i] = max(group_radiance[i], group_radiance[i + half_count]);
        }
        barrier();
    }
    if (i > 0u) return;
    atomicMax(largest_change, floatBitsToUint(group_change[0]));
    atomicMax(largest_radiance, floatBitsToUint(group_radiance[0]));
}
#endif

void main()
{
    uint place = item_index();
    vec3 change = vec3(0.0), radiance = vec3(0.0);
    if (place < voxel_statistics.faces) {
        // snippet: bounce
        vec3 sum = vec3(0.0);
        for (int i = 0; i < links_per_face; ++i) {
            uint link = links[place * uint(links_per_face) + uint(i)];
            sum += link < kSkyLink ? radiance_before(link) : link == kSkyLink ? sky_radiance : vec3(0.0);
        }
        vec3 gathered = sum / float(links_per_face);
#if EMITTERS
        gathered += from_emitters[place].rgb;
#endif
        radiance = direct[place].rgb + unpack_albedo(albedo[place]) * gathered;
        // end snippet
#if MEASURE
        change = abs(radiance - radiance_before(place));
#endif
#if LAST
        after[place] = vec4(radiance, direct[place].a);
#else
        after[place] = pack_radiance(radiance);
#endif
    }
#if MEASURE
    measure(change, radiance);
#endif
}
