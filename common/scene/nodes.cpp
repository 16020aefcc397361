#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "scene/parts.hpp"

namespace conebook {

glm::dmat4 Transform::matrix() const
{
    glm::dmat4 result = glm::mat4_cast(rotation);
    for (int column = 0; column < 3; ++column) result[column] *= scale[column];
    result[3] = glm::dvec4(translation, 1.0);
    return result;
}

}  // namespace conebook

namespace conebook::gltf {

std::size_t shown_scene(const Document& document)
{
    return document.model.defaultScene < 0 ? 0 : static_cast<std::size_t>(document.model.defaultScene);
}

namespace {

// glTF 2.0, 3.5.3: a column-major matrix, or T * R * S.
void read_transform(const tinygltf::Node& source, const std::string& where, Node& node)
{
    if (source.matrix.size() == 16) {
        glm::dmat4 matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = source.matrix[static_cast<std::size_t>(i)];
        const bool affine = std::abs(matrix[0].w) < 1e-6 && std::abs(matrix[1].w) < 1e-6 &&
                            std::abs(matrix[2].w) < 1e-6 && std::abs(matrix[3].w - 1.0) < 1e-6;
        if (!affine) fail(where + ".matrix has a last row that is not (0, 0, 0, 1)");
        for (int column = 0; column < 4; ++column) matrix[column].w = column == 3 ? 1.0 : 0.0;
        node.matrix = matrix;
        return;
    }
    if (source.rotation.size() == 4) {
        const auto& r = source.rotation;
        const glm::dquat rotation(r[3], r[0], r[1], r[2]);  // the file has x, y, z, w
        const double length = glm::length(rotation);
        if (!(length > 1e-12) || !std::isfinite(length)) fail(where + ".rotation is not a rotation");
        node.local.rotation = rotation / length;
    }
    if (source.scale.size() == 3) node.local.scale = {source.scale[0], source.scale[1], source.scale[2]};
    if (source.translation.size() == 3) {
        node.local.translation = {source.translation[0], source.translation[1], source.translation[2]};
    }
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

std::vector<Node> read_nodes(const Document& document)
{
    const tinygltf::Model& model = document.model;
    std::vector<int> roots = find_roots(model.nodes);
    // glTF 2.0, 3.5.1 leaves open what to show when no scene is named; the first is what exporters mean.
    if (!model.scenes.empty()) roots = model.scenes.at(shown_scene(document)).nodes;
    struct Open {
        int file_index, parent;
    };
    std::vector<Node> result;
    std::vector<Open> open;
    std::vector<std::uint8_t> visited(model.nodes.size(), 0);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({*root, -1});
    // A stack of our own: a file may nest a hundred thousand nodes.
    while (!open.empty()) {
        const auto [file_index, parent] = open.back();
        open.pop_back();
        const auto index = static_cast<std::size_t>(file_index);
        if (visited.at(index)) fail(node_name(index) + " is in the scene twice");
        visited[index] = 1;
        const tinygltf::Node& source = model.nodes[index];
        Node node;
        node.name = source.name;
        node.file_index = file_index;
        node.parent = parent;
        read_transform(source, node_name(index), node);
        node.world_from_node = node.local_matrix();
        if (parent >= 0) {
            node.world_from_node = result[static_cast<std::size_t>(parent)].world_from_node * node.world_from_node;
        }
        node.extras = source.extras_json_string;
        if (source.mesh >= 0) {
            const tinygltf::Mesh& mesh = model.meshes.at(static_cast<std::size_t>(source.mesh));
            // glTF 2.0, 3.7.2.2: a node's weights stand for its mesh's.
            node.weights = source.weights.empty() ? mesh.weights : source.weights;
            const std::size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives[0].targets.size();
            for (const tinygltf::Primitive& primitive : mesh.primitives) {
                if (primitive.targets.size() != targets) {
                    fail("meshes[" + std::to_string(source.mesh) +
                         "] has primitives with different numbers of morph targets");
                }
            }
            if (!node.weights.empty() && node.weights.size() != targets) {
                fail(node_name(index) + " has " + std::to_string(node.weights.size()) + " weights for " +
                     std::to_string(targets) + " morph targets");
            }
            node.weights.resize(targets, 0.0);
            node.mesh_extras = mesh.extras_json_string;
        }
        for (auto child = source.children.rbegin(); child != source.children.rend(); ++child) {
            open.push_back({*child, static_cast<int>(result.size())});
        }
        result.push_back(std::move(node));
    }
    return result;
}

}  // namespace conebook::gltf
