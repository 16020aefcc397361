// What of a scene can move: its nodes, animations and skins as the file gives them, and the vertices of what moves as they
// were modelled, as plain data. pose.hpp plays them. The loader places everything as the file's nodes have it, skins and
// morph targets included: the rest pose.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace conebook {

struct Bounds {
    glm::vec3 min{0.0f}, max{0.0f};
    glm::vec3 extent() const { return max - min; }
    glm::vec3 center() const { return 0.5f * (min + max); }
    float longest_side() const { auto e = extent(); return glm::max(e.x, glm::max(e.y, e.z)); }
    // 0 .. 7: bit 0, 1, 2 choose max over min in x, y, z.
    glm::vec3 corner(int i) const { return {i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z}; }
};

// Elements [first, first + count) of an array.
struct Range {
    std::uint32_t first = 0, count = 0;
    std::uint32_t end() const { return first + count; }
};

// T * R * S (glTF 2.0, 3.5.3).
struct Transform {
    glm::dvec3 translation{0.0};               // m
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};   // unit; w first, unlike in the file
    glm::dvec3 scale{1.0};
    glm::dmat4 matrix() const;
};

// Of the scene that is shown; nodes of the file that are not in it are left out. A parent stands before its children, so
// that one pass from front to back makes a pose: world_from_node = (parent's world_from_node) * local_matrix().
struct Node {
    std::string name;                   // may be empty
    int file_index = 0;                 // nodes[file_index] of the file; -1: an object that was put into the scene
    int object = -1;                    // then, which of PlacedObjects::objects(); else -1
    int parent = -1;                    // index into Scene::nodes; -1: none
    Transform local;                    // parent from node, where `matrix` is empty
    std::optional<glm::dmat4> matrix;   // of a node that has one in the file instead; nothing animates it (3.5.3)
    glm::dmat4 world_from_node{1.0};    // by the file's transforms; world space, not scene space: see Scene::origin_ws

    // What the node placed, as it lies in Scene: vertices (scene space, in the rest pose) that no other node shares, the
    // indices to them, and the draws over these. Counts are 0 where it has no triangles.
    Range vertices, indices, draws;
    Bounds bounds;                      // of these vertices, scene space
    bool mirrored = false;              // its triangles were turned round, since its transform (or its skin's) mirrors them

    // The same vertices as modelled, where the node is dynamic, has a skin or morph targets; else 0.
    Range modelled;                     // of Scene::modelled, as many as `vertices` and in their order
    std::uint32_t first_delta = 0;      // of Scene::deltas: modelled.count for each morph target, one target after the other
    std::vector<double> weights;        // of morph targets, one each: the node's or else its mesh's
    int skin = -1;                      // index into Scene::skins, -1: none
    int camera = -1, light = -1;        // index into Scene::cameras and Scene::lights that it carries, -1: none

    // Whether what it placed may move: an animation moves the node, one above it, its morph targets or a joint of its skin;
    // or the file's extras of the node or one above it say {"dynamic": true}.
    bool dynamic = false;
    std::string extras, mesh_extras;    // JSON, "" where the file has none

    glm::dmat4 local_matrix() const { return matrix ? *matrix : local.matrix(); }
};

// A vertex in the space of its mesh, before node, skin and morph targets.
struct ModelledVertex {
    glm::vec3 position;
    glm::vec3 normal;
    glm::vec4 tangent;      // w as in Vertex, before any mirroring
    glm::uvec4 joints{0};   // of the node's skin: indices into Skin::joints
    glm::vec4 weights{0};   // of these joints, sum 1; 0 without a skin
};

// What a morph target with weight 1 adds to a vertex (glTF 2.0, 3.7.2.2).
struct MorphDelta {
    glm::vec3 position{0.0f}, normal{0.0f}, tangent{0.0f};
};

enum class Interpolation { step, linear, cubic_spline };

// A curve over time (glTF 2.0, 3.11 and appendix C). `values` holds `width` floats a key, and three times as many for cubic
// splines: in-tangent, value, out-tangent, tangents per second.
struct AnimationSampler {
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times;   // s, not negative, ascending; at least one
    std::vector<float> values;  // times.size() * width, or times that by 3
    std::size_t width() const
    {
        return values.size() / times.size() / (interpolation == Interpolation::cubic_spline ? 3 : 1);
    }
};

enum class AnimationPath { translation, rotation, scale, weights };

// What a curve moves. Widths: translation (m) and scale 3, rotation 4 (quaternion x y z w; linear means slerp), weights one
// for each morph target of the node's mesh.
struct AnimationChannel {
    int node = 0;     // index into Scene::nodes
    AnimationPath path = AnimationPath::translation;
    int sampler = 0;  // index into Animation::samplers
};

struct Animation {
    std::string name;  // may be empty
    std::vector<AnimationSampler> samplers;
    std::vector<AnimationChannel> channels;
};

// A skinned vertex in world space: sum of weight_i * (world_from_node of joints[i]) * inverse_bind[i] * (vertex as modelled).
// The transform of the mesh's own node has no part in it (glTF 2.0, 3.7.3.3).
struct Skin {
    std::string name;                     // may be empty
    std::vector<int> joints;              // indices into Scene::nodes; at least one
    std::vector<glm::mat4> inverse_bind;  // joint from mesh, one a joint; identity where the file has none
    int skeleton = -1;                    // index into Scene::nodes: root of the joints where the file names it
};

}  // namespace conebook
