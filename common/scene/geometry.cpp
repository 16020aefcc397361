#include <algorithm>
#include <cmath>

#include "scene/parts.hpp"

namespace conebook::gltf {
namespace {

// Twice the area times the unit normal, in double: slivers and tiny triangles keep their direction.
glm::dvec3 area_normal(const std::vector<Vertex>& vertices, const std::uint32_t* triangle)
{
    const glm::dvec3 a = vertices[triangle[0]].position, b = vertices[triangle[1]].position,
                     c = vertices[triangle[2]].position;
    return glm::cross(b - a, c - a);
}

// Unit vector, or (0, 0, 0) when there is no direction.
glm::vec3 unit_or_zero(glm::dvec3 v)
{
    // Scaled by the largest component first, so that neither 1e-200 nor 1e200 squares out of range.
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0.0) || !std::isfinite(largest)) return glm::vec3(0.0f);
    return glm::normalize(v / largest);
}

}  // namespace

void make_flat_normals(LocalMesh& mesh)
{
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> source;
    vertices.reserve(mesh.indices.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        glm::vec3 normal = unit_or_zero(area_normal(mesh.vertices, &mesh.indices[i]));
        if (normal == glm::vec3(0.0f)) normal = glm::vec3(0.0f, 1.0f, 0.0f);  // no area: any will do
        for (std::size_t corner = 0; corner < 3; ++corner) {
            vertices.push_back(mesh.vertices[mesh.indices[i + corner]]);
            vertices.back().normal = normal;
            source.push_back(mesh.source[mesh.indices[i + corner]]);
        }
    }
    mesh.vertices = std::move(vertices);
    mesh.source = std::move(source);
    mesh.flat_normals = true;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = static_cast<std::uint32_t>(i);
}

NormalRepair repair_normals(std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices)
{
    NormalRepair repair;
    std::vector<std::uint32_t> bad;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const double length = glm::length(glm::dvec3(vertices[i].normal));
        if (std::isfinite(length) && length > 0.0 && std::abs(length - 1.0) > 0.02) ++repair.off_length;
        vertices[i].normal = std::isfinite(length) ? unit_or_zero(vertices[i].normal) : glm::vec3(0.0f);
        if (vertices[i].normal == glm::vec3(0.0f)) bad.push_back(static_cast<std::uint32_t>(i));
    }
    repair.replaced = bad.size();
    if (bad.empty()) return repair;

    std::vector<glm::dvec3> sums(vertices.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const glm::dvec3 normal = area_normal(vertices, &indices[i]);
        for (std::size_t corner = 0; corner < 3; ++corner) sums[indices[i + corner]] += normal;
    }
    for (const std::uint32_t i : bad) {
        vertices[i].normal = unit_or_zero(sums[i]);
        if (vertices[i].normal == glm::vec3(0.0f)) vertices[i].normal = glm::vec3(0.0f, 1.0f, 0.0f);
    }
    return repair;
}

glm::vec3 perpendicular(glm::vec3 n)
{
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    return glm::vec3(1.0f + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x);
}

void make_tangents(LocalMesh& mesh, const TextureSlot& texture)
{
    // dP/du and dP/dv of a triangle: the solution of edge_i = du_i T + dv_i B (Lengyel, Foundations of Game Engine
    // Development 2, 7.5). The corner's sums are weighted by its angle, as in MikkTSpace.
    struct Sum {
        glm::dvec3 tangent{0.0};
        bool used = false;
        std::uint32_t vertex = 0;  // after doubling
    };
    std::vector<std::array<Sum, 2>> sums(mesh.vertices.size());  // [1]: mirrored UV
    std::vector<std::uint8_t> mirrored(mesh.indices.size() / 3);
    const auto uv = [&](std::uint32_t i) {
        const Vertex& vertex = mesh.vertices[i];
        return glm::dvec2(texture.uv_transform * glm::vec3(texture.uv_set == 0 ? vertex.uv0 : vertex.uv1, 1.0f));
    };
    for (std::size_t t = 0; t < mirrored.size(); ++t) {
        const std::uint32_t* corner = &mesh.indices[3 * t];
        const glm::dvec3 p[3] = {mesh.vertices[corner[0]].position, mesh.vertices[corner[1]].position,
                                 mesh.vertices[corner[2]].position};
        const glm::dvec2 uv1 = uv(corner[1]) - uv(corner[0]), uv2 = uv(corner[2]) - uv(corner[0]);
        const double determinant = uv1.x * uv2.y - uv2.x * uv1.y;
        // glTF's v points down the image and its bitangent up it (3.9.3: +Y is up in the texture), so that a UV
        // set with negative determinant is the one that is not mirrored.
        mirrored[t] = determinant > 0.0;
        const glm::dvec3 tangent = glm::dvec3(
            unit_or_zero(((p[1] - p[0]) * uv2.y - (p[2] - p[0]) * uv1.y) * (determinant < 0.0 ? -1.0 : 1.0)));
        for (std::size_t c = 0; c < 3; ++c) {
            Sum& sum = sums[corner[c]][mirrored[t]];
            const glm::dvec3 e1 = unit_or_zero(p[(c + 1) % 3] - p[c]), e2 = unit_or_zero(p[(c + 2) % 3] - p[c]);
            sum.used = true;
            if (determinant != 0.0) sum.tangent += tangent * std::acos(glm::clamp(glm::dot(e1, e2), -1.0, 1.0));
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        bool first = true;
        for (int side = 0; side < 2; ++side) {
            Sum& sum = sums[i][static_cast<std::size_t>(side)];
            if (!sum.used) continue;
            const glm::dvec3 normal = mesh.vertices[i].normal;
            glm::vec3 tangent = unit_or_zero(sum.tangent - normal * glm::dot(normal, sum.tangent));
            if (tangent == glm::vec3(0.0f)) tangent = perpendicular(mesh.vertices[i].normal);
            sum.vertex = static_cast<std::uint32_t>(first ? i : mesh.vertices.size());
            if (!first) {
                mesh.vertices.push_back(mesh.vertices[i]);
                mesh.source.push_back(mesh.source[i]);
            }
            mesh.vertices[sum.vertex].tangent = glm::vec4(tangent, side == 0 ? 1.0f : -1.0f);
            first = false;
        }
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        mesh.indices[i] = sums[mesh.indices[i]][mirrored[i / 3]].vertex;
    }
}

}  // namespace conebook::gltf
