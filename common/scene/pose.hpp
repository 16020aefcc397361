// Where the parts of a scene are at a time: its animations played, skins and morph targets applied (glTF 2.0, 3.7.2.2,
// 3.7.3.3, 3.11). On the CPU, in double precision; gl/pose_pass.hpp does the vertices on the GPU.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace conebook {

struct NodePose {
    glm::dmat4 world_from_node{1.0};
    std::vector<double> weights;  // of its morph targets
};

// Of every node, in the order of Scene::nodes. All animations play at once, each over and over again from 0 s to its last
// key, which it still reaches. Where two of them move the same thing, the one that stands first in the file does.
// `time_s` must not be negative.
std::vector<NodePose> pose_nodes(const Scene& scene, double time_s);

// The rest pose: everything as the file's nodes have it, which is how load_scene has placed the vertices.
std::vector<NodePose> rest_pose(const Scene& scene);

// The matrices that take a node's modelled vertices into scene space: one where it has no skin, else one a joint.
std::vector<glm::dmat4> scene_from_mesh(const Scene& scene, const std::vector<NodePose>& nodes, std::size_t node);

// The vertices that a node placed, Node::vertices of them in their order. A node without modelled vertices (which nothing
// moves) has those of the scene. Not followed: a scale that changes its sign, for which triangles would have to turn round.
std::vector<Vertex> posed_vertices(const Scene& scene, const std::vector<NodePose>& nodes, std::size_t node);

// Scene::vertices at a time, and what of the scene goes with them.
struct Pose {
    std::vector<NodePose> nodes;
    std::vector<Vertex> vertices;
    Bounds bounds;                // of the vertices, scene space
    std::vector<Light> lights;    // Scene::lights where their nodes are now
    std::vector<Camera> cameras;  // Scene::cameras likewise
};
Pose pose(const Scene& scene, double time_s);

// The scene with everything where it is at a time, as if its file had it there: for those who take a scene that stands still.
Scene posed(Scene scene, double time_s);

// Lights and cameras of these nodes; one that a node without extent carries stays where it is in the scene.
std::vector<Light> posed_lights(const Scene& scene, const std::vector<NodePose>& nodes);
std::vector<Camera> posed_cameras(const Scene& scene, const std::vector<NodePose>& nodes);

// A box of all poses: of the rest pose and of `samples` times of the longest animation. What moves between two of them may
// leave it by what it travels in a sample.
Bounds swept_bounds(const Scene& scene, int samples = 64);

// s: when the longest animation has played once; 0 without animations.
double duration(const Scene& scene);

}  // namespace conebook
