#version 450 core
// Vertices of a node as modelled -> scene space: morph targets, then joints of a skin or the node's matrix (glTF 2.0,
// 3.7.2.2 and 3.7.3.3). One thread a vertex. Twin: common/scene/pose.cpp, posed_vertices.
#include "common/bindings.glsl"

layout(local_size_x = 64) in;
// Position, normal, tangent, uv0, uv1, colour: 18 floats a vertex, of which the first ten are written.
layout(std430, binding = kVertexBinding) writeonly buffer VertexBuffer { float vertex_words[]; };
// Position, normal, tangent, joints, weights of joints: 18 words a vertex.
layout(std430, binding = kModelledBinding) readonly buffer ModelledBuffer { uint modelled_words[]; };
// Position, normal, tangent: 9 floats a vertex.
layout(std430, binding = kMorphDeltaBinding) readonly buffer MorphDeltaBuffer { float delta_words[]; };
layout(std430, binding = kPoseMatrixBinding) readonly buffer PoseMatrixBuffer { mat4 scene_from_mesh[]; };
layout(std430, binding = kMorphWeightBinding) readonly buffer MorphWeightBuffer { float morph_weights[]; };
uniform uint vertex_count, first_vertex, first_modelled, first_delta, first_matrix, first_weight;
uniform uint target_count, target_stride;  // stride: vertices of the node
uniform bool has_skin, flat_normals, is_mirrored;

const uint kVertexWords = 18u, kDeltaWords = 9u;

vec3 modelled_vec3(uint v, uint word)
{
    uint i = (first_modelled + v) * kVertexWords + word;
    vec3 sum = uintBitsToFloat(uvec3(modelled_words[i], modelled_words[i + 1u], modelled_words[i + 2u]));
    for (uint t = 0u; t < target_count; ++t) {
        uint d = (first_delta + t * target_stride + v) * kDeltaWords + word;
        sum += morph_weights[first_weight + t] * vec3(delta_words[d], delta_words[d + 1u], delta_words[d + 2u]);
    }
    return sum;
}

mat4 matrix_of(uint v)
{
    if (!has_skin) return scene_from_mesh[first_matrix];
    uint i = (first_modelled + v) * kVertexWords + 10u;
    mat4 sum = mat4(0.0);
    float total = 0.0;
    for (uint k = 0u; k < 4u; ++k) {
        float weight = uintBitsToFloat(modelled_words[i + 4u + k]);
        if (weight != 0.0) sum += weight * scene_from_mesh[first_matrix + modelled_words[i + k]];
        total += weight;
    }
    return sum / total;
}

vec3 position_of(uint v) { return (matrix_of(v) * vec4(modelled_vec3(v, 0u), 1.0)).xyz; }

vec3 unit_or_zero(vec3 v)
{
    float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));  // scaled by it first: cofactors may be tiny
    return largest > 0.0 ? normalize(v / largest) : vec3(0.0);
}

// Any unit vector perpendicular to a unit one (Duff et al. 2017, JCGT 6(1)).
vec3 perpendicular(vec3 n)
{
    float s = n.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (s + n.z);
    return vec3(1.0 + s * n.x * n.x * a, s * n.x * n.y * a, -s * n.x);
}

void write(uint v, uint word, vec3 value)
{
    uint i = (first_vertex + v) * kVertexWords + word;
    vertex_words[i] = value.x;
    vertex_words[i + 1u] = value.y;
    vertex_words[i + 2u] = value.z;
}

void main()
{
    uint v = gl_GlobalInvocationID.x;
    if (v >= vertex_count) return;
    mat4 m = matrix_of(v);
    // Cofactors: det * inverse transpose, which exists for flattened nodes (scale 0) too.
    mat3 cofactors = mat3(cross(m[1].xyz, m[2].xyz), cross(m[2].xyz, m[0].xyz), cross(m[0].xyz, m[1].xyz));
    float sign = dot(m[0].xyz, cofactors[0]) < 0.0 ? -1.0 : 1.0;

    vec3 normal = sign * unit_or_zero(cofactors * modelled_vec3(v, 3u));
    if (flat_normals) {
        uint t = v - v % 3u;
        vec3 a = position_of(t);
        vec3 face = unit_or_zero(cross(position_of(t + 1u) - a, position_of(t + 2u) - a)) * (is_mirrored ? -1.0 : 1.0);
        normal = face == vec3(0.0) ? normal : face;
    }
    if (normal == vec3(0.0)) normal = vec3(0.0, 1.0, 0.0);

    vec3 along = unit_or_zero(mat3(m) * modelled_vec3(v, 6u));
    vec3 tangent = unit_or_zero(along - normal * dot(normal, along));
    if (tangent == vec3(0.0)) tangent = perpendicular(normal);

    write(v, 0u, position_of(v));
    write(v, 3u, normal);
    write(v, 6u, tangent);
    float handedness = uintBitsToFloat(modelled_words[(first_modelled + v) * kVertexWords + 9u]);
    vertex_words[(first_vertex + v) * kVertexWords + 9u] = sign * handedness;
}
