#include "mesh.hpp"

#include <cmath>
#include <initializer_list>

#include <glm/gtc/constants.hpp>

namespace conebook::generator {
namespace {

constexpr double two_pi = glm::two_pi<double>();

glm::vec3 snapped(const glm::dvec3& v) {
    using generator::snapped;
    return {snapped(v.x), snapped(v.y), snapped(v.z)};
}

// Grid of (columns + 1) x (rows + 1) vertices, row by row, that starts at `first`; two triangles per cell with the
// front towards (column direction) x (row direction).
void add_grid_triangles(Mesh& mesh, std::uint32_t first, int columns, int rows) {
    const auto stride = static_cast<std::uint32_t>(columns + 1);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const auto a = first + static_cast<std::uint32_t>(row) * stride + static_cast<std::uint32_t>(column);
            mesh.triangle(a, a + 1, a + stride + 1);
            mesh.triangle(a, a + stride + 1, a + stride);
        }
    }
}

}  // namespace

float snapped(double value) {
    constexpr double steps_per_unit = 1048576.0;  // 2^20
    return static_cast<float>(std::round(value * steps_per_unit) / steps_per_unit + 0.0);  // + 0.0: no negative zero
}

std::uint32_t Mesh::vertex(const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec2& uv) {
    positions.push_back(snapped(position));
    normals.push_back(snapped(glm::normalize(normal)));
    uvs.push_back({snapped(uv.x), snapped(uv.y)});
    return static_cast<std::uint32_t>(positions.size() - 1);
}

void Mesh::add_target(const Mesh& other) {
    Target& target = targets.emplace_back();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        target.positions.push_back(other.positions.at(i) - positions[i]);
        target.normals.push_back(other.normals.at(i) - normals[i]);
    }
}

// Triangles that collapse to a line (the grid's cells at a sphere's poles) are left out.
void Mesh::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (positions[a] == positions[b] || positions[b] == positions[c] || positions[c] == positions[a]) {
        return;
    }
    indices.insert(indices.end(), {a, b, c});
}

glm::dvec3 Place::direction(const glm::dvec3& local) const {
    const double c = std::cos(glm::radians(turn)), s = std::sin(glm::radians(turn));
    return {c * local.x + s * local.z, local.y, -s * local.x + c * local.z};
}

glm::dvec3 Place::point(const glm::dvec3& local) const { return position + direction(local); }

void add_quad(Mesh& mesh, glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v, glm::dvec3 outward, glm::dvec2 uv_repeat) {
    glm::dvec3 normal = glm::cross(u, v);
    if (glm::dot(normal, outward) < 0.0) {
        // Start at the other end of u, so that the picture on the quad is not mirrored.
        corner += u;
        u = -u;
        normal = -normal;
    }
    const auto a = mesh.vertex(corner, normal, {0.0, uv_repeat.y});
    const auto b = mesh.vertex(corner + u, normal, uv_repeat);
    const auto c = mesh.vertex(corner + u + v, normal, {uv_repeat.x, 0.0});
    const auto d = mesh.vertex(corner + v, normal, {0.0, 0.0});
    mesh.triangle(a, b, c);
    mesh.triangle(a, c, d);
}

void add_box(Mesh& mesh, const Place& place, glm::dvec3 size, unsigned leave_out) {
    const glm::dvec3 low(-0.5 * size.x, 0.0, -0.5 * size.z);
    for (int axis = 0; axis < 3; ++axis) {
        for (int positive = 0; positive < 2; ++positive) {
            if (leave_out & (1u << (2 * axis + positive))) {
                continue;
            }
            glm::dvec3 outward(0.0), across(0.0), up(0.0), corner = low;
            outward[axis] = positive ? 1.0 : -1.0;
            corner[axis] += positive ? size[axis] : 0.0;
            const int up_axis = axis == 1 ? 2 : 1, across_axis = 3 - axis - up_axis;
            across[across_axis] = size[across_axis];
            up[up_axis] = size[up_axis];
            add_quad(mesh, place.point(corner), place.direction(across), place.direction(up),
                     place.direction(outward));
        }
    }
}

void add_room_face(Mesh& mesh, glm::dvec3 low, glm::dvec3 high, Face face, glm::dvec2 uv_repeat) {
    int axis = 0;
    while (!(face & (3u << (2 * axis)))) {
        ++axis;
    }
    const bool positive = (face & (2u << (2 * axis))) != 0;
    const glm::dvec3 size = high - low;
    glm::dvec3 inward(0.0), across(0.0), up(0.0), corner = low;
    inward[axis] = positive ? -1.0 : 1.0;
    corner[axis] = positive ? high[axis] : low[axis];
    const int up_axis = axis == 1 ? 2 : 1, across_axis = 3 - axis - up_axis;
    across[across_axis] = size[across_axis];
    up[up_axis] = size[up_axis];
    add_quad(mesh, corner, across, up, inward, uv_repeat);
}

void add_room(Mesh& mesh, glm::dvec3 low, glm::dvec3 high, unsigned leave_out) {
    for (Face face : {face_nx, face_px, face_ny, face_py, face_nz, face_pz}) {
        if (!(leave_out & face)) {
            add_room_face(mesh, low, high, face);
        }
    }
}

void add_sphere(Mesh& mesh, glm::dvec3 center, double radius, int segments, int rings) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int ring = 0; ring <= rings; ++ring) {
        const double v = double(ring) / rings, theta = v * glm::pi<double>();  // theta 0: south pole
        for (int segment = 0; segment <= segments; ++segment) {
            const double u = double(segment) / segments, phi = u * two_pi;
            const glm::dvec3 n(std::sin(theta) * std::sin(phi), -std::cos(theta), std::sin(theta) * std::cos(phi));
            mesh.vertex(center + radius * n, n, {u, 1.0 - v});
        }
    }
    add_grid_triangles(mesh, first, segments, rings);
}

void add_torus(Mesh& mesh, const Place& place, double ring_radius, double tube_radius, int ring_segments,
               int tube_segments) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= tube_segments; ++i) {
        const double v = double(i) / tube_segments, beta = v * two_pi;
        for (int j = 0; j <= ring_segments; ++j) {
            const double u = double(j) / ring_segments, phi = u * two_pi;
            const glm::dvec3 out(std::sin(phi), 0.0, std::cos(phi));
            const glm::dvec3 n = std::cos(beta) * out + glm::dvec3(0.0, std::sin(beta), 0.0);
            mesh.vertex(place.point(ring_radius * out + tube_radius * n), place.direction(n), {u, 1.0 - v});
        }
    }
    add_grid_triangles(mesh, first, ring_segments, tube_segments);
}

void add_cylinder(Mesh& mesh, double x, double z, double y0, double y1, double radius, int segments) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int row = 0; row < 2; ++row) {
        for (int segment = 0; segment <= segments; ++segment) {
            const double u = double(segment) / segments, phi = u * two_pi;
            const glm::dvec3 n(std::sin(phi), 0.0, std::cos(phi));
            mesh.vertex(glm::dvec3(x, row ? y1 : y0, z) + radius * n, n, {u, 1.0 - row});
        }
    }
    add_grid_triangles(mesh, first, segments, 1);
}

void add_curtain(Mesh& mesh, const Place& place, double width, double height, double amplitude, double waves,
                 int segments) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double k = two_pi * waves / width;
    for (int row = 0; row < 2; ++row) {
        for (int segment = 0; segment <= segments; ++segment) {
            const double u = double(segment) / segments, x = u * width;
            const glm::dvec3 n(-amplitude * k * std::cos(k * x), 0.0, 1.0);  // gradient of z - f(x)
            const glm::dvec3 local(x - 0.5 * width, row ? 0.0 : -height, amplitude * std::sin(k * x));
            mesh.vertex(place.point(local), place.direction(n), {u, 1.0 - row});
        }
    }
    add_grid_triangles(mesh, first, segments, 1);
}

void add_extrusion_x(Mesh& mesh, const std::vector<glm::dvec2>& line_zy, double x0, double x1) {
    for (std::size_t i = 0; i + 1 < line_zy.size(); ++i) {
        const glm::dvec2 from = line_zy[i], to = line_zy[i + 1];
        const glm::dvec2 edge = to - from;
        // Seen from +x with y up, z points left: right of the edge (-dz, dy) is (dy, dz).
        const glm::dvec3 outward(0.0, edge.x, -edge.y);
        add_quad(mesh, {x0, from.y, from.x}, {x1 - x0, 0.0, 0.0}, {0.0, edge.y, edge.x}, outward);
    }
}

}  // namespace conebook::generator
