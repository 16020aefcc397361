// From the space of a mesh to the scene: what the loader does once and pose.cpp at every time.
#include <algorithm>
#include <cmath>

#include "scene/parts.hpp"

namespace conebook::gltf {
namespace {

// Unit vector, or (0, 0, 0) when there is no direction.
glm::dvec3 unit(glm::dvec3 v)
{
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest > 0.0 && std::isfinite(largest) ? glm::normalize(v / largest) : glm::dvec3(0.0);
}

// det * inverse transpose, which exists for flattened nodes (scale 0) too.
glm::dmat3 cofactors(const glm::dmat3& m)
{
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

}  // namespace

bool is_mirroring(const glm::dmat4& matrix) { return glm::determinant(glm::dmat3(matrix)) < 0.0; }

Vertex placed(Vertex vertex, const glm::dmat4& world_from_mesh, glm::dvec3 origin_ws)
{
    const glm::dmat3 linear(world_from_mesh);
    const double sign = is_mirroring(world_from_mesh) ? -1.0 : 1.0;
    const glm::dvec3 position_ws(world_from_mesh * glm::dvec4(vertex.position, 1.0));
    vertex.position = glm::vec3(position_ws - origin_ws);
    vertex.normal = glm::vec3(unit(cofactors(linear) * glm::dvec3(vertex.normal)) * sign);
    vertex.tangent =
        glm::vec4(glm::vec3(unit(linear * glm::dvec3(vertex.tangent))), vertex.tangent.w * static_cast<float>(sign));
    return vertex;
}

void finish_tangent(Vertex& vertex)
{
    const glm::dvec3 normal = vertex.normal, tangent = glm::dvec3(vertex.tangent);
    const glm::dvec3 flat = unit(tangent - normal * glm::dot(normal, tangent));
    const glm::vec3 direction = flat == glm::dvec3(0.0) ? perpendicular(vertex.normal) : glm::vec3(flat);
    vertex.tangent = glm::vec4(direction, vertex.tangent.w);
}

glm::dmat4 blended(const std::vector<glm::dmat4>& joint_matrices, glm::uvec4 joints, glm::vec4 weights)
{
    glm::dmat4 sum(0.0);
    double total = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (weights[i] == 0.0f) continue;
        sum += static_cast<double>(weights[i]) * joint_matrices[joints[i]];
        total += static_cast<double>(weights[i]);  // 1, but for rounding, which would count far from the origin
    }
    return sum / total;
}

std::vector<glm::dmat4> world_from_mesh(const Scene& scene, const std::vector<NodePose>& poses, std::size_t node)
{
    if (scene.nodes[node].skin < 0) return {poses[node].world_from_node};
    const Skin& skin = scene.skins[static_cast<std::size_t>(scene.nodes[node].skin)];
    std::vector<glm::dmat4> matrices;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        matrices.push_back(poses[static_cast<std::size_t>(skin.joints[j])].world_from_node *
                           glm::dmat4(skin.inverse_bind[j]));
    }
    return matrices;
}

}  // namespace conebook::gltf
