#version 450 core
// A point for each block of cells: no triangles are made, only places in the square.
layout(quads, equal_spacing, point_mode) in;
in vec3 corner_position[];
in vec4 corner_uv[];
in vec4 corner_color[];
patch in ivec4 patch_cut;
out vec3 point_position[3];
out vec4 point_uv[3];
out vec4 point_color[3];
flat out ivec4 point_cut;     // as patch_cut
flat out ivec2 point_block;

void main()
{
    for (int i = 0; i < 3; ++i) {
        point_position[i] = corner_position[i];
        point_uv[i] = corner_uv[i];
        point_color[i] = corner_color[i];
    }
    point_cut = patch_cut;
    point_block = ivec2(round(gl_TessCoord.xy * vec2(gl_TessLevelInner[0], gl_TessLevelInner[1])));
    point_block.x += patch_cut.w;
}
