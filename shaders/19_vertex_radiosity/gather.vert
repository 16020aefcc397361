#version 450 core
// Every patch is drawn as a point, into the texel of the radiosity map that bears its number.
layout(location = 0) in vec4 patch_position;
layout(location = 1) in vec4 patch_normal;
uniform int map_side;
uniform float half_texel;  // 0.5; 0 aims at the corner between four texels, as the document does

flat out int patch_id;
flat out vec3 position;
flat out vec3 normal;
flat out float area;

// snippet: place
void main()
{
    patch_id = gl_VertexID;
    position = patch_position.xyz;
    normal = patch_normal.xyz;
    area = patch_position.w;
    vec2 texel = vec2(gl_VertexID % map_side, gl_VertexID / map_side) + half_texel;
    gl_Position = vec4(2.0 * texel / float(map_side) - 1.0, 0.5, 1.0);
    gl_PointSize = 1.0;
}
// end snippet
