#version 450 core
// Four texels become one: it keeps one of them, and the flux and the area of all.
layout(binding = 8) uniform sampler2D chosen_before;
layout(binding = 9) uniform sampler2D normal_energy_before;
layout(binding = 10) uniform sampler2D flux_area_before;
uniform int pick;   // Pick: 0 maximum, 1 flux
uniform uint seed;  // of this level of this map

layout(location = 0) out vec4 chosen;
layout(location = 1) out vec4 normal_energy;
layout(location = 2) out vec4 flux_area;

// The finalizer of MurmurHash3 (Appleby 2008), to 0..1.
float hashed(uint h)
{
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return float((h ^ (h >> 16)) >> 8) * exp2(-24.0);
}

void main()
{
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec4 c[4], n[4], f[4];
    for (int k = 0; k < 4; ++k) {
        ivec2 from = 2 * here + ivec2(k & 1, k >> 1);
        c[k] = texelFetch(chosen_before, from, 0);
        n[k] = texelFetch(normal_energy_before, from, 0);
        f[k] = texelFetch(flux_area_before, from, 0);
    }
    int best = 0;
    if (pick == 0) {
        // snippet: maximum
        // The document's choice: the most light wins; of equals, the patch with the larger number.
        for (int k = 1; k < 4; ++k)
            if (n[k].w > n[best].w || (n[k].w == n[best].w && c[k].w > c[best].w)) best = k;
        // end snippet
    } else {
        // snippet: by_flux
        // Each is kept as often as it has a share in the flux, so the flux is on the average where it belongs.
        float weight[4], all = 0.0;
        for (int k = 0; k < 4; ++k) all += weight[k] = f[k].r + f[k].g + f[k].b;
        float left = all * hashed(seed + uint(here.x) * 0x9e3779b9u + uint(here.y) * 0x7feb352du);
        for (int k = 0; k < 4; ++k) {
            if (weight[k] > 0.0) best = k;
            if (left < weight[k]) break;
            left -= weight[k];
        }
        // end snippet
    }
    chosen = c[best];
    normal_energy = n[best];
    flux_area = (f[0] + f[1]) + (f[2] + f[3]);
}
