// Triangles for shaders that fetch their vertices themselves (GpuScene::bind_triangles()).
// Included after 04_conservative_voxelization/triangle_voxels.glsl.
layout(std430, binding = kVertexBinding) readonly buffer VertexBuffer { float vertex_words[]; };  // struct Vertex
layout(std430, binding = kIndexBinding) readonly buffer IndexBuffer { uint vertex_indices[]; };

const int kVertexWords = 18;

uint vertex_of(uint triangle, int corner) { return vertex_indices[3u * triangle + uint(corner)]; }

vec3 vertex_vec3(uint vertex, int word)
{
    uint i = vertex * uint(kVertexWords) + uint(word);
    return vec3(vertex_words[i], vertex_words[i + 1u], vertex_words[i + 2u]);
}

GridTriangle fetch_triangle(uint triangle)
{
    return grid_triangle(vertex_vec3(vertex_of(triangle, 0), 0), vertex_vec3(vertex_of(triangle, 1), 0),
                         vertex_vec3(vertex_of(triangle, 2), 0));
}
