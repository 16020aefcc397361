// Shapes made by formula, for objects that no file has. Each is centred on the origin, its longest side is 1 m, its axis is
// y. All but the plane and the disc are closed, with normals that point outwards.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace conebook {

enum class Shape { icosahedron, cube, sphere, cone, torus, plane, disc, cylinder };

// By their names, in the order of Shape.
const std::vector<std::string>& shape_names();
std::optional<Shape> shape_from_name(const std::string& name);

// How round shapes are divided: segments around the axis, rings from pole to pole and around the torus's tube.
constexpr int kShapeSegments = 48, kShapeRings = 24;
// m, of the torus: of the circle in the middle of its tube, and of the tube.
constexpr double kTorusRing = 0.35, kTorusTube = 0.15;

// Triangles as a file would have them, in the shape's own space.
struct ShapeMesh {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
};

// The plane and the disc lie in y = 0 and face +y.
ShapeMesh make_shape(Shape shape);

}  // namespace conebook
