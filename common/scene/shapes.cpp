#include "scene/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "scene/parts.hpp"

namespace conebook {
namespace {

std::uint32_t add_vertex(ShapeMesh& mesh, const glm::dvec3& position, const glm::dvec3& normal,
                         const glm::dvec3& along_u, const glm::dvec2& uv)
{
    Vertex vertex{glm::vec3(position),
                  glm::vec3(glm::normalize(normal)),
                  glm::vec4(glm::vec3(along_u), 1.0f),
                  glm::vec2(uv),
                  glm::vec2(uv),
                  glm::vec4(1.0f)};
    gltf::finish_tangent(vertex);
    mesh.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

// Not one that has shrunk to a line, as at a pole.
void add_triangle(ShapeMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c)
{
    const auto at = [&](std::uint32_t i) { return mesh.vertices[i].position; };
    if (at(a) == at(b) || at(b) == at(c) || at(c) == at(a)) return;
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

// A flat face of corners in order, counter-clockwise from its front.
void add_face(ShapeMesh& mesh, const std::vector<glm::dvec3>& corners)
{
    const glm::dvec3 u = corners[1] - corners[0], v = corners.back() - corners[0], normal = glm::cross(u, v);
    std::vector<std::uint32_t> numbers;
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 offset = corner - corners[0];
        const glm::dvec2 uv(glm::dot(offset, u) / glm::dot(u, u), 1.0 - glm::dot(offset, v) / glm::dot(v, v));
        numbers.push_back(add_vertex(mesh, corner, normal, u, uv));
    }
    for (std::size_t i = 1; i + 1 < numbers.size(); ++i) add_triangle(mesh, numbers[0], numbers[i], numbers[i + 1]);
}

// A point of a profile that turns around the y axis: distance from the axis and height (m), and the normal there.
struct Profile {
    glm::dvec2 place, normal;
};

// The front is on the right of the profile's way, seen with the axis on the left.
void add_revolution(ShapeMesh& mesh, const std::vector<Profile>& profile)
{
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    constexpr std::uint32_t stride = kShapeSegments + 1;
    for (std::size_t row = 0; row < profile.size(); ++row) {
        for (int column = 0; column <= kShapeSegments; ++column) {
            // The last column is the first one again, to the last bit.
            const double angle = glm::two_pi<double>() * (column % kShapeSegments) / kShapeSegments;
            const glm::dvec3 out(std::sin(angle), 0.0, std::cos(angle)), along(std::cos(angle), 0.0, -std::sin(angle));
            const auto turned = [&](const glm::dvec2& p) { return p.x * out + glm::dvec3(0.0, p.y, 0.0); };
            const double v = double(row) / double(profile.size() - 1);
            add_vertex(mesh, turned(profile[row].place), turned(profile[row].normal), along,
                       {double(column) / kShapeSegments, 1.0 - v});
        }
    }
    for (std::uint32_t row = 0; row + 1 < profile.size(); ++row) {
        for (std::uint32_t column = 0; column < kShapeSegments; ++column) {
            const std::uint32_t a = first + row * stride + column;
            add_triangle(mesh, a, a + 1, a + stride + 1);
            add_triangle(mesh, a, a + stride + 1, a + stride);
        }
    }
}

// A circle of radius 1/2, at this height; it faces up or down.
void add_cap(ShapeMesh& mesh, double y, double facing)
{
    Profile middle{{0.0, y}, {0.0, facing}}, edge{{0.5, y}, {0.0, facing}};
    if (facing > 0.0) std::swap(middle, edge);
    add_revolution(mesh, {middle, edge});
}

void add_cube(ShapeMesh& mesh)
{
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-0.5, 0.5}) {
            std::vector<glm::dvec3> corners;
            for (const auto& [u, v] : {std::pair(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
                glm::dvec3& corner = corners.emplace_back();
                corner[axis] = side;
                corner[(axis + 1) % 3] = u;
                corner[(axis + 2) % 3] = v;
            }
            if (side < 0.0) std::reverse(corners.begin(), corners.end());
            add_face(mesh, corners);
        }
    }
}

// Corners (0, +-1, +-phi) and their cyclic permutations (Coxeter, Regular Polytopes, 3.7). The longest side of its box is
// between two opposite edges, 2 phi.
void add_icosahedron(ShapeMesh& mesh)
{
    const double phi = glm::golden_ratio<double>(), scale = 0.5 / phi;
    std::vector<glm::dvec3> corners;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double one : {-1.0, 1.0}) {
            for (const double far : {-phi, phi}) {
                glm::dvec3& corner = corners.emplace_back();
                corner[(axis + 1) % 3] = one * scale;
                corner[(axis + 2) % 3] = far * scale;
            }
        }
    }
    // Its edges are 2 long; three corners so far apart are a face.
    const auto is_edge = [&](std::size_t a, std::size_t b) {
        return glm::distance(corners[a], corners[b]) < 2.1 * scale;
    };
    for (std::size_t a = 0; a < corners.size(); ++a) {
        for (std::size_t b = a + 1; b < corners.size(); ++b) {
            for (std::size_t c = b + 1; c < corners.size(); ++c) {
                if (!is_edge(a, b) || !is_edge(b, c) || !is_edge(c, a)) continue;
                const bool outwards =
                    glm::dot(glm::cross(corners[b] - corners[a], corners[c] - corners[a]), corners[a]) > 0.0;
                add_face(mesh, {corners[a], corners[outwards ? b : c], corners[outwards ? c : b]});
            }
        }
    }
}

// Points around a circle, from an angle to another; 0 is away from the axis.
std::vector<Profile> arc(const glm::dvec2& middle, double radius, double from, double to)
{
    std::vector<Profile> profile;
    for (int i = 0; i <= kShapeRings; ++i) {
        const double angle = from + (to - from) * i / kShapeRings;
        const glm::dvec2 out(std::cos(angle), std::sin(angle));
        profile.push_back({middle + radius * out, out});
    }
    return profile;
}

}  // namespace

const std::vector<std::string>& shape_names()
{
    static const std::vector<std::string> names = {"icosahedron", "cube",  "sphere", "cone",
                                                   "torus",       "plane", "disc",   "cylinder"};
    return names;
}

std::optional<Shape> shape_from_name(const std::string& name)
{
    const auto found = std::find(shape_names().begin(), shape_names().end(), name);
    if (found == shape_names().end()) return {};
    return static_cast<Shape>(found - shape_names().begin());
}

ShapeMesh make_shape(Shape shape)
{
    constexpr double half_pi = glm::half_pi<double>();
    ShapeMesh mesh;
    switch (shape) {
        case Shape::icosahedron:
            add_icosahedron(mesh);
            break;
        case Shape::cube:
            add_cube(mesh);
            break;
        case Shape::sphere: {
            std::vector<Profile> profile = arc({0.0, 0.0}, 0.5, -half_pi, half_pi);
            profile.front().place.x = profile.back().place.x = 0.0;  // a pole is one point
            add_revolution(mesh, profile);
            break;
        }
        case Shape::cone: {
            const glm::dvec2 normal = glm::normalize(glm::dvec2(1.0, 0.5));
            add_cap(mesh, -0.5, -1.0);
            add_revolution(mesh, {{{0.5, -0.5}, normal}, {{0.0, 0.5}, normal}});
            break;
        }
        case Shape::torus: {
            std::vector<Profile> profile = arc({kTorusRing, 0.0}, kTorusTube, 0.0, 4.0 * half_pi);
            profile.back().place = profile.front().place;
            add_revolution(mesh, profile);
            break;
        }
        case Shape::plane:
            add_face(mesh, {{-0.5, 0.0, 0.5}, {0.5, 0.0, 0.5}, {0.5, 0.0, -0.5}, {-0.5, 0.0, -0.5}});
            break;
        case Shape::disc:
            add_cap(mesh, 0.0, 1.0);
            break;
        case Shape::cylinder:
            add_cap(mesh, -0.5, -1.0);
            add_revolution(mesh, {{{0.5, -0.5}, {1.0, 0.0}}, {{0.5, 0.5}, {1.0, 0.0}}});
            add_cap(mesh, 0.5, 1.0);
            break;
    }
    return mesh;
}

}  // namespace conebook
