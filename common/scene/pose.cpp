#include "scene/pose.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "scene/parts.hpp"

namespace conebook {
namespace {

double length_of(const Animation& animation)
{
    float last = 0.0f;
    for (const AnimationSampler& sampler : animation.samplers) last = std::max(last, sampler.times.back());
    return static_cast<double>(last);
}

// The curve at a time (glTF 2.0, 3.11 and appendix C). Before the first key and after the last one it stays as it is there.
std::vector<double> value_at(const AnimationSampler& curve, AnimationPath path, double time_s)
{
    const std::size_t width = curve.width();
    const bool spline = curve.interpolation == Interpolation::cubic_spline;
    // Of key k: 0 its value, or of a spline -1 the in-tangent, 0 the value, 1 the out-tangent.
    const auto at = [&](std::size_t key, int part, std::size_t i) {
        const std::size_t row = spline ? 3 * key + static_cast<std::size_t>(1 + part) : key;
        return static_cast<double>(curve.values[row * width + i]);
    };
    const auto& times = curve.times;
    const auto after = std::upper_bound(times.begin(), times.end(), time_s,
                                        [](double t, float key) { return t < static_cast<double>(key); });
    const auto next = static_cast<std::size_t>(after - times.begin());
    const std::size_t key = next == 0 ? 0 : next - 1;
    std::vector<double> result(width);
    for (std::size_t i = 0; i < width; ++i) result[i] = at(key, 0, i);
    if (next == 0 || next == times.size() || curve.interpolation == Interpolation::step) return result;

    const double span_s = static_cast<double>(times[next]) - static_cast<double>(times[key]);
    const double u = (time_s - static_cast<double>(times[key])) / span_s;  // times[key] <= time_s < times[next]
    if (spline) {
        const double u2 = u * u, u3 = u2 * u;
        for (std::size_t i = 0; i < width; ++i) {
            result[i] = (2.0 * u3 - 3.0 * u2 + 1.0) * at(key, 0, i) + span_s * (u3 - 2.0 * u2 + u) * at(key, 1, i) +
                        (3.0 * u2 - 2.0 * u3) * at(next, 0, i) + span_s * (u3 - u2) * at(next, -1, i);
        }
    } else if (path == AnimationPath::rotation) {
        const auto quaternion = [&](std::size_t k) {
            return glm::normalize(glm::dquat(at(k, 0, 3), at(k, 0, 0), at(k, 0, 1), at(k, 0, 2)));
        };
        const glm::dquat q = glm::slerp(quaternion(key), quaternion(next), u);
        result = {q.x, q.y, q.z, q.w};
    } else {
        for (std::size_t i = 0; i < width; ++i) result[i] += u * (at(next, 0, i) - at(key, 0, i));
    }
    return result;
}

void apply(const std::vector<double>& value, AnimationPath path, Transform& local, std::vector<double>& weights)
{
    switch (path) {
        case AnimationPath::translation:
            local.translation = {value[0], value[1], value[2]};
            break;
        case AnimationPath::scale:
            local.scale = {value[0], value[1], value[2]};
            break;
        case AnimationPath::rotation: {
            const glm::dquat q(value[3], value[0], value[1], value[2]);
            if (glm::length(q) > 1e-12) local.rotation = glm::normalize(q);
            break;
        }
        case AnimationPath::weights:
            weights = value;
            break;
    }
}

// Modelled vertex v of the node, its morph targets applied.
Vertex morphed(const Scene& scene, const Node& node, const std::vector<double>& weights, std::uint32_t v)
{
    const ModelledVertex& modelled = scene.modelled[node.modelled.first + v];
    Vertex vertex = scene.vertices[node.vertices.first + v];
    vertex.position = modelled.position;
    vertex.normal = modelled.normal;
    vertex.tangent = modelled.tangent;
    for (std::size_t t = 0; t < weights.size(); ++t) {
        const MorphDelta& delta = scene.deltas[node.first_delta + t * node.modelled.count + v];
        const float weight = static_cast<float>(weights[t]);
        vertex.position += weight * delta.position;
        vertex.normal += weight * delta.normal;
        vertex.tangent += glm::vec4(weight * delta.tangent, 0.0f);
    }
    return vertex;
}

}  // namespace

double duration(const Scene& scene)
{
    double longest = 0.0;
    for (const Animation& animation : scene.animations) longest = std::max(longest, length_of(animation));
    return longest;
}

Bounds swept_bounds(const Scene& scene, int samples)
{
    Bounds all = scene.bounds;
    for (int i = 0; i < samples && !scene.animations.empty(); ++i) {
        const Bounds now = pose(scene, duration(scene) * i / samples).bounds;
        all.min = glm::min(all.min, now.min);
        all.max = glm::max(all.max, now.max);
    }
    return all;
}

std::vector<NodePose> rest_pose(const Scene& scene)
{
    std::vector<NodePose> poses;
    for (const Node& node : scene.nodes) poses.push_back({node.world_from_node, node.weights});
    return poses;
}

std::vector<NodePose> pose_nodes(const Scene& scene, double time_s)
{
    std::vector<NodePose> poses = rest_pose(scene);
    std::vector<Transform> local;
    for (const Node& node : scene.nodes) local.push_back(node.local);
    std::set<std::pair<int, AnimationPath>> moved;
    for (const Animation& animation : scene.animations) {
        const double length_s = length_of(animation);
        const double t = time_s > length_s && length_s > 0.0 ? std::fmod(time_s, length_s) : time_s;
        for (const AnimationChannel& channel : animation.channels) {
            if (!moved.insert({channel.node, channel.path}).second) continue;
            const auto node = static_cast<std::size_t>(channel.node);
            const AnimationSampler& curve = animation.samplers[static_cast<std::size_t>(channel.sampler)];
            apply(value_at(curve, channel.path, t), channel.path, local[node], poses[node].weights);
        }
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Node& node = scene.nodes[i];
        const glm::dmat4 parent_from_node = node.matrix ? *node.matrix : local[i].matrix();
        poses[i].world_from_node =
            node.parent < 0 ? parent_from_node
                            : poses[static_cast<std::size_t>(node.parent)].world_from_node * parent_from_node;
    }
    return poses;
}

std::vector<glm::dmat4> scene_from_mesh(const Scene& scene, const std::vector<NodePose>& nodes, std::size_t node)
{
    std::vector<glm::dmat4> matrices = gltf::world_from_mesh(scene, nodes, node);
    // Weights of joints have the sum 1, so that the origin may be taken from each of them.
    for (glm::dmat4& matrix : matrices) matrix[3] -= glm::dvec4(scene.origin_ws, 0.0);
    return matrices;
}

std::vector<Vertex> posed_vertices(const Scene& scene, const std::vector<NodePose>& nodes, std::size_t index)
{
    const Node& node = scene.nodes[index];
    const auto first = scene.vertices.begin() + node.vertices.first;
    std::vector<Vertex> vertices(first, first + node.vertices.count);
    if (node.modelled.count == 0) return vertices;
    const std::vector<glm::dmat4> matrices = scene_from_mesh(scene, nodes, index);
    const auto matrix_of = [&](std::uint32_t v) {
        const ModelledVertex& modelled = scene.modelled[node.modelled.first + v];
        return node.skin < 0 ? matrices[0] : gltf::blended(matrices, modelled.joints, modelled.weights);
    };
    for (std::uint32_t v = 0; v < node.modelled.count; ++v) {
        vertices[v] = gltf::placed(morphed(scene, node, nodes[index].weights, v), matrix_of(v), glm::dvec3(0.0));
    }
    for (std::uint32_t d = node.draws.first; d < node.draws.end(); ++d) {
        const Draw& draw = scene.draws[d];
        if (!draw.flat_normals) continue;
        for (std::uint32_t v = draw.vertices.first - node.vertices.first; v < draw.vertices.end() - node.vertices.first;
             v += 3) {
            const glm::dvec3 a = vertices[v].position, b = vertices[v + 1].position, c = vertices[v + 2].position;
            const glm::dvec3 normal = glm::cross(b - a, c - a) * (node.mirrored ? -1.0 : 1.0);
            const double length = glm::length(normal);
            for (std::uint32_t corner = v; corner < v + 3 && length > 0.0; ++corner) {
                vertices[corner].normal = glm::vec3(normal / length);
            }
        }
    }
    for (Vertex& vertex : vertices) {
        if (vertex.normal == glm::vec3(0.0f)) vertex.normal = glm::vec3(0.0f, 1.0f, 0.0f);
        gltf::finish_tangent(vertex);
    }
    return vertices;
}

std::vector<Light> posed_lights(const Scene& scene, const std::vector<NodePose>& nodes)
{
    std::vector<Light> lights = scene.lights;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const int light = scene.nodes[i].light;
        if (light >= 0) gltf::place(lights[static_cast<std::size_t>(light)], nodes[i].world_from_node, scene.origin_ws);
    }
    return lights;
}

std::vector<Camera> posed_cameras(const Scene& scene, const std::vector<NodePose>& nodes)
{
    std::vector<Camera> cameras = scene.cameras;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const int camera = scene.nodes[i].camera;
        if (camera >= 0)
            gltf::place(cameras[static_cast<std::size_t>(camera)], nodes[i].world_from_node, scene.origin_ws);
    }
    return cameras;
}

Pose pose(const Scene& scene, double time_s)
{
    Pose result;
    result.nodes = pose_nodes(scene, time_s);
    result.vertices = scene.vertices;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (!scene.nodes[i].dynamic || scene.nodes[i].modelled.count == 0) continue;
        const std::vector<Vertex> vertices = posed_vertices(scene, result.nodes, i);
        std::copy(vertices.begin(), vertices.end(), result.vertices.begin() + scene.nodes[i].vertices.first);
    }
    result.bounds = {result.vertices[0].position, result.vertices[0].position};
    for (const Vertex& vertex : result.vertices) {
        result.bounds.min = glm::min(result.bounds.min, vertex.position);
        result.bounds.max = glm::max(result.bounds.max, vertex.position);
    }
    result.lights = posed_lights(scene, result.nodes);
    result.cameras = posed_cameras(scene, result.nodes);
    return result;
}

Scene posed(Scene scene, double time_s)
{
    Pose now = pose(scene, time_s);
    scene.vertices = std::move(now.vertices);
    scene.bounds = now.bounds;
    scene.lights = std::move(now.lights);
    scene.cameras = std::move(now.cameras);
    return scene;
}

}  // namespace conebook
