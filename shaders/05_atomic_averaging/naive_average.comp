#version 450 core
// Ways to put many fragments into one 8-bit texel, for comparison with the sums; the material is the same.
// RACING_STORE: the last writer wins. Otherwise: running mean by compare-and-swap with the count in alpha
// (Crassin & Green 2012, listing 22.2; Villegas 2016, section 3.3.2.4): C(i+1) = (i C(i) + x(i+1)) / (i+1).
// TRUNCATING: every step cuts off to 8 bits, as published; otherwise it rounds to the nearest.
#include "05_atomic_averaging/fragment.glsl"

layout(r32ui, binding = 0) uniform uimage3D mean_color;  // RGBA8 in 32 bits

const int kMaxTries = 255;  // as published; the fragment is lost after them

// Mean in 255ths and count, eight bits each; the count begins again at 256.
uint packed_mean(vec3 mean, uint count)
{
#if !TRUNCATING
    mean += 0.5;
#endif
    uvec3 c = uvec3(mean);
    return c.r | c.g << 8 | c.b << 16 | count << 24;
}

void main()
{
    uint item = item_index();
    if (item >= fragment_count) return;
    Fragment f = fetch_fragment(item);
    vec3 albedo = f.material.albedo;
#if RACING_STORE
    imageStore(mean_color, f.voxel, uvec4(packUnorm4x8(vec4(albedo, 1.0))));
#else
    // snippet: compare_and_swap
    uint expected = 0u, wanted = packed_mean(255.0 * albedo, 1u);
    for (int i = 0; i < kMaxTries; ++i) {
        uint found = imageAtomicCompSwap(mean_color, f.voxel, expected, wanted);
        if (found == expected) break;
        uint count = found >> 24;
        vec3 mean = vec3(uvec3(found, found >> 8, found >> 16) & 255u);
        expected = found;
        wanted = packed_mean((mean * float(count) + 255.0 * albedo) / float(count + 1u), count + 1u);
    }
    // end snippet
#endif
}
