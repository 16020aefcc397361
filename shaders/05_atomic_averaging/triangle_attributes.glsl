// What a triangle's vertices have besides their positions.
// Included after 04_conservative_voxelization/scene_triangles.glsl.
// TEXTURES: not 0 when the material has textures.
struct TriangleAttributes {
    vec3 normal0, normal1, normal2;
    vec4 color0, color1, color2;  // linear
#if TEXTURES
    vec4 uv0, uv1, uv2;  // xy: UV set 0, zw: UV set 1
#endif
};

vec4 vertex_vec4(uint vertex, int word)
{
    uint i = vertex * uint(kVertexWords) + uint(word);
    return vec4(vertex_words[i], vertex_words[i + 1u], vertex_words[i + 2u], vertex_words[i + 3u]);
}

TriangleAttributes triangle_attributes(uint triangle)
{
    const int kNormalWord = 3, kUvWord = 10, kColorWord = 14;  // of struct Vertex
    uvec3 v = uvec3(vertex_of(triangle, 0), vertex_of(triangle, 1), vertex_of(triangle, 2));
    TriangleAttributes a;
    a.normal0 = vertex_vec3(v.x, kNormalWord);
    a.normal1 = vertex_vec3(v.y, kNormalWord);
    a.normal2 = vertex_vec3(v.z, kNormalWord);
    a.color0 = vertex_vec4(v.x, kColorWord);
    a.color1 = vertex_vec4(v.y, kColorWord);
    a.color2 = vertex_vec4(v.z, kColorWord);
#if TEXTURES
    a.uv0 = vertex_vec4(v.x, kUvWord);
    a.uv1 = vertex_vec4(v.y, kUvWord);
    a.uv2 = vertex_vec4(v.z, kUvWord);
#endif
    return a;
}
