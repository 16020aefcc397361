#version 450 core
// Streams out the pieces of a triangle: where each is, which way it faces, what it is made of. Nothing is rasterized.
#include "common/material.glsl"
#include "common/voxel_grid.glsl"
#include "18_voxel_ray_marching/cut.glsl"
#include "18_voxel_ray_marching/piece.glsl"

layout(points) in;
layout(points, max_vertices = 128) out;  // kMostOutputs
in vec3 point_position[][3];
in vec4 point_uv[][3];
in vec4 point_color[][3];
flat in ivec4 point_cut[];
flat in ivec2 point_block[];
// snippet: stream_out
// A Piece, as transform feedback writes it.
layout(xfb_buffer = 0, xfb_stride = 32) out;
layout(xfb_offset = 0) flat out uvec4 piece_place;
layout(xfb_offset = 16) flat out uvec4 piece_light;
// end snippet

// Level of detail at which a texel is as large as a piece.
float piece_lod(ivec2 texels, int k)
{
    vec2 e = (point_uv[0][1].xy - point_uv[0][0].xy) * vec2(texels);
    vec2 f = (point_uv[0][2].xy - point_uv[0][0].xy) * vec2(texels);
    return 0.5 * log2(max(0.5 * abs(e.x * f.y - e.y * f.x) / float(k * k), 1e-6));
}

bool is_cut_out(MaterialData m, SurfaceMaterial s, vec4 uv, int k)
{
    if ((m.flags & kMaterialMasked) == 0) return false;
    if (m.uv_row[2 * kBaseColorSlot + 1].w < 0.5) return s.alpha < m.emission.a;
    vec2 place = texture_uv(m, kBaseColorSlot, uv.xy, uv.zw);
    return textureLod(coverage_texture, place, piece_lod(textureSize(coverage_texture, 0), k)).r < 0.5;
}

void emit_piece(ivec2 cell, int k, vec3 normal)
{
    MaterialData m = drawn_material;
    vec2 b = cell_middle(cell, k);
    vec3 weights = vec3(1.0 - b.x - b.y, b);
    vec3 position = mat3(point_position[0][0], point_position[0][1], point_position[0][2]) * weights;
    vec3 place = grid_from_scene(position);
    // What lies outside of the cube is left out.
    if (any(lessThan(place, vec3(0.0))) || any(greaterThanEqual(place, vec3(grid.size.xyz)))) return;
    vec4 uv = point_uv[0][0] * weights.x + point_uv[0][1] * weights.y + point_uv[0][2] * weights.z;
    vec4 tint = point_color[0][0] * weights.x + point_color[0][1] * weights.y + point_color[0][2] * weights.z;
    TextureSamples t;
#define SAMPLE(texture_of_slot, slot)                                  \
    textureLod(texture_of_slot, texture_uv(m, slot, uv.xy, uv.zw), piece_lod(textureSize(texture_of_slot, 0), k))
    t.base_color = SAMPLE(base_color_texture, kBaseColorSlot);
    t.metallic_roughness = SAMPLE(metallic_roughness_texture, kMetallicRoughnessSlot);
    t.emission = SAMPLE(emission_texture, kEmissionSlot).rgb;
    t.specular = SAMPLE(specular_texture, kSpecularSlot).a;
    t.specular_color = SAMPLE(specular_color_texture, kSpecularColorSlot).rgb;
    SurfaceMaterial s = material_at(m, t, tint);
    if (is_cut_out(m, s, uv, k)) return;
    int sides = (m.flags & kMaterialDoubleSided) != 0 ? 2 : 1;
    for (int side = 0; side < sides; ++side) {
        vec3 outward = side == 0 ? normal : -normal;
        piece_place = uvec4(floatBitsToUint(position), packSnorm2x16(octahedral_encode(outward)));
        piece_light = uvec4(floatBitsToUint(s.emission), pack_albedo(s.albedo));
        EmitVertex();
    }
}

void main()
{
    vec3 n = cross(point_position[0][1] - point_position[0][0], point_position[0][2] - point_position[0][0]);
    float area = length(n);
    if (!(area > 0.0)) return;
    int k = point_cut[0].x;
    ivec2 block = point_cut[0].yz, first = point_block[0] * block;
    for (int i = 0; i < block.x * block.y; ++i) {
        ivec2 cell = first + ivec2(i % block.x, i / block.x);
        if (all(lessThan(cell, ivec2(k)))) emit_piece(cell, k, n / area);
    }
}
