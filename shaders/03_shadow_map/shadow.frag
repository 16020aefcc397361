#version 450 core
// Depth only; what an alpha mask cuts out casts no shadow.
#include "common/material.glsl"

in vec2 uv0;
in vec2 uv1;
in float vertex_alpha;

void main()
{
    MaterialData m = drawn_material;
    float alpha = m.base_color.a * vertex_alpha * texture(base_color_texture, texture_uv(m, kBaseColorSlot, uv0, uv1)).a;
    if ((m.flags & kMaterialMasked) != 0 && alpha < m.emission.a) discard;
}
