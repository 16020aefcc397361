#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "scene/parts.hpp"

namespace conebook::gltf {
namespace {

// glTF 2.0, 3.5.3: a column-major matrix, or T * R * S.
glm::dmat4 local_matrix(const tinygltf::Node& node, const std::string& where)
{
    glm::dmat4 result(1.0);
    if (node.matrix.size() == 16) {
        for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
        const bool affine = std::abs(result[0].w) < 1e-6 && std::abs(result[1].w) < 1e-6 &&
                            std::abs(result[2].w) < 1e-6 && std::abs(result[3].w - 1.0) < 1e-6;
        if (!affine) fail(where + ".matrix has a last row that is not (0, 0, 0, 1)");
        for (int column = 0; column < 4; ++column) result[column].w = column == 3 ? 1.0 : 0.0;
        return result;
    }
    if (node.rotation.size() == 4) {
        const auto& r = node.rotation;
        const glm::dquat rotation(r[3], r[0], r[1], r[2]);  // the file has x, y, z, w
        const double length = glm::length(rotation);
        if (!(length > 1e-12) || !std::isfinite(length)) fail(where + ".rotation is not a rotation");
        result = glm::mat4_cast(rotation / length);
    }
    if (node.scale.size() == 3) {
        for (int column = 0; column < 3; ++column) result[column] *= node.scale[static_cast<std::size_t>(column)];
    }
    if (node.translation.size() == 3) {
        result[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1.0);
    }
    return result;
}

std::string node_name(std::size_t i) { return "nodes[" + std::to_string(i) + "]"; }

// The nodes without a parent. Throws unless the nodes are a forest (glTF 2.0, 3.5.2).
std::vector<int> find_roots(const std::vector<tinygltf::Node>& nodes)
{
    std::vector<std::uint8_t> has_parent(nodes.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const int child : nodes[i].children) {
            auto& mark = has_parent.at(static_cast<std::size_t>(child));
            if (mark) fail(node_name(static_cast<std::size_t>(child)) + " has more than one parent");
            mark = 1;
        }
    }
    std::vector<int> roots, open;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!has_parent[i]) roots.push_back(static_cast<int>(i));
    }
    // With one parent at most, a node that no root reaches is in a cycle or below one.
    std::vector<std::uint8_t> reached(nodes.size(), 0);
    open = roots;
    while (!open.empty()) {
        const auto node = static_cast<std::size_t>(open.back());
        open.pop_back();
        reached[node] = 1;
        open.insert(open.end(), nodes[node].children.begin(), nodes[node].children.end());
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!reached[i]) fail(node_name(i) + " is its own ancestor or below such a node: the nodes form a cycle");
    }
    return roots;
}

}  // namespace

std::vector<Instance> walk_nodes(const Document& document)
{
    const tinygltf::Model& model = document.model;
    std::vector<int> roots = find_roots(model.nodes);
    // glTF 2.0, 3.5.1 leaves open what to show when no scene is named; the first is what exporters mean.
    if (!model.scenes.empty()) {
        roots = model.scenes.at(static_cast<std::size_t>(model.defaultScene < 0 ? 0 : model.defaultScene)).nodes;
    }
    std::vector<Instance> result, open;
    std::vector<std::uint8_t> visited(model.nodes.size(), 0);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({*root, glm::dmat4(1.0)});
    // A stack of our own: a file may nest a hundred thousand nodes.
    while (!open.empty()) {
        const Instance parent = open.back();
        open.pop_back();
        const auto index = static_cast<std::size_t>(parent.node);
        if (visited.at(index)) fail(node_name(index) + " is in the scene twice");
        visited[index] = 1;
        const tinygltf::Node& node = model.nodes[index];
        const glm::dmat4 world_from_node = parent.world_from_node * local_matrix(node, node_name(index));
        result.push_back({parent.node, world_from_node});
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
            open.push_back({*child, world_from_node});
        }
    }
    return result;
}

}  // namespace conebook::gltf
