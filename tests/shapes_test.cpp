// The shapes made by formula: areas and volumes in closed form, Euler characteristic, normals.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include <glm/gtc/constants.hpp>

#include "scene/shapes.hpp"

namespace conebook {
namespace {

constexpr double pi = glm::pi<double>();
// Vertices are floats of at most 1/2 m: areas of some m^2 are off by no more.
constexpr double kRounding = 2e-6;

struct Corners {
    glm::dvec3 a, b, c;
    glm::dvec3 doubled_area() const { return glm::cross(b - a, c - a); }
};

std::vector<Corners> triangles_of(const ShapeMesh& mesh)
{
    const auto at = [&](std::size_t i) { return glm::dvec3(mesh.vertices[mesh.indices[i]].position); };
    std::vector<Corners> triangles;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) triangles.push_back({at(i), at(i + 1), at(i + 2)});
    return triangles;
}

double area(const ShapeMesh& mesh)
{
    double sum = 0.0;
    for (const Corners& t : triangles_of(mesh)) sum += 0.5 * glm::length(t.doubled_area());
    return sum;
}

// Divergence theorem; positive where fronts face outwards.
double volume(const ShapeMesh& mesh)
{
    double sum = 0.0;
    for (const Corners& t : triangles_of(mesh)) sum += glm::dot(t.a, glm::cross(t.b, t.c)) / 6.0;
    return sum;
}

// A regular polygon of kShapeSegments corners at distance 1: area, side, distance of a side from the middle.
const double kPolygonArea = 0.5 * kShapeSegments * std::sin(2.0 * pi / kShapeSegments);
const double kPolygonSide = 2.0 * std::sin(pi / kShapeSegments), kPolygonInside = std::cos(pi / kShapeSegments);

// Of the pieces between two polygons at distances r1 and r2 from the axis and heights y1 and y2: their sides are
// trapezoids, and they are frusta of pyramids.
double side_area(double r1, double y1, double r2, double y2)
{
    const double slant = std::hypot((r2 - r1) * kPolygonInside, y2 - y1);
    return kShapeSegments * kPolygonSide * 0.5 * (r1 + r2) * slant;
}
double frustum(double r1, double y1, double r2, double y2)
{
    return (y2 - y1) / 3.0 * kPolygonArea * (r1 * r1 + r1 * r2 + r2 * r2);
}

struct Known {
    Shape shape;
    double area, volume;                // of the polyhedron
    double smooth_area, smooth_volume;  // of what it stands for
    int euler;                          // vertices - edges + triangles
};

Known revolved(Shape shape, glm::dvec2 middle, double radius, double from, double to, double smooth_area,
               double smooth_volume, int euler)
{
    Known known{shape, 0.0, 0.0, smooth_area, smooth_volume, euler};
    for (int i = 0; i < kShapeRings; ++i) {
        const double a = from + (to - from) * i / kShapeRings, b = from + (to - from) * (i + 1) / kShapeRings;
        const double r1 = middle.x + radius * std::cos(a), r2 = middle.x + radius * std::cos(b);
        const double y1 = radius * std::sin(a), y2 = radius * std::sin(b);
        known.area += side_area(r1, y1, r2, y2);
        known.volume += frustum(r1, y1, r2, y2);
    }
    return known;
}

std::vector<Known> all_known()
{
    const double cap = 0.25 * kPolygonArea;
    // Edge a of the icosahedron in a box of side 1: a = 1 / golden ratio. Area 5 sqrt(3) a^2, volume 5/12 (3 + sqrt(5)) a^3.
    const double a = 1.0 / glm::golden_ratio<double>();
    const double ico_area = 5.0 * std::sqrt(3.0) * a * a, ico_volume = 5.0 / 12.0 * (3.0 + std::sqrt(5.0)) * a * a * a;
    return {
        {Shape::icosahedron, ico_area, ico_volume, ico_area, ico_volume, 2},
        {Shape::cube, 6.0, 1.0, 6.0, 1.0, 2},
        revolved(Shape::sphere, {0.0, 0.0}, 0.5, -0.5 * pi, 0.5 * pi, pi, pi / 6.0, 2),
        {Shape::cone, cap + side_area(0.5, -0.5, 0.0, 0.5), frustum(0.5, -0.5, 0.0, 0.5),
         0.25 * pi + 0.5 * pi * std::sqrt(1.25), pi / 12.0, 2},
        revolved(Shape::torus, {kTorusRing, 0.0}, kTorusTube, 0.0, 2.0 * pi, 4.0 * pi * pi * kTorusRing * kTorusTube,
                 2.0 * pi * pi * kTorusRing * kTorusTube * kTorusTube, 0),
        {Shape::plane, 1.0, 0.0, 1.0, 0.0, 1},
        {Shape::disc, cap, 0.0, 0.25 * pi, 0.0, 1},
        {Shape::cylinder, 2.0 * cap + side_area(0.5, 0.0, 0.5, 1.0), frustum(0.5, 0.0, 0.5, 1.0), 1.5 * pi, 0.25 * pi,
         2},
    };
}

class EveryShape : public testing::TestWithParam<Known> {
protected:
    const ShapeMesh mesh = make_shape(GetParam().shape);
};

TEST_P(EveryShape, HasItsAreaAndVolume)
{
    EXPECT_NEAR(area(mesh), GetParam().area, kRounding);
    EXPECT_NEAR(volume(mesh), GetParam().volume, kRounding);
    // What chords leave out of a circle of n segments is a share of 2/3 (pi / n)^2; of a torus's tube, twice.
    const double lost = 2.0 / 3.0 * (pi / kShapeSegments) * (pi / kShapeSegments) * (1.0 + 4.0);
    EXPECT_NEAR(area(mesh), GetParam().smooth_area, lost * GetParam().smooth_area + kRounding);
    EXPECT_NEAR(volume(mesh), GetParam().smooth_volume, lost * GetParam().smooth_volume + kRounding);
}

TEST_P(EveryShape, IsAsLargeAsItSaysAndCentred)
{
    glm::dvec3 low(1.0), high(-1.0);
    for (const Vertex& vertex : mesh.vertices) {
        low = glm::min(low, glm::dvec3(vertex.position));
        high = glm::max(high, glm::dvec3(vertex.position));
    }
    EXPECT_NEAR(glm::max(high.x - low.x, glm::max(high.y - low.y, high.z - low.z)), 1.0, kRounding);
    EXPECT_LT(glm::length(high + low), kRounding);
}

// Vertices joined by place: each edge is there once in each direction, or the shape has a rim.
TEST_P(EveryShape, IsClosedAndHasItsEulerCharacteristic)
{
    std::map<std::array<double, 3>, int> vertices;
    const auto number = [&](const glm::dvec3& p) {
        return vertices.try_emplace({p.x, p.y, p.z}, int(vertices.size())).first->second;
    };
    std::set<std::pair<int, int>> directed, edges;
    const std::vector<Corners> triangles = triangles_of(mesh);
    for (const Corners& t : triangles) {
        const int a = number(t.a), b = number(t.b), c = number(t.c);
        for (const auto& [from, to] : {std::pair(a, b), {b, c}, {c, a}}) {
            EXPECT_TRUE(directed.insert({from, to}).second) << "an edge twice the same way";
            edges.insert({std::min(from, to), std::max(from, to)});
        }
    }
    EXPECT_EQ(int(vertices.size()) - int(edges.size()) + int(triangles.size()), GetParam().euler);
    const bool has_rim = GetParam().shape == Shape::plane || GetParam().shape == Shape::disc;
    EXPECT_EQ(directed.size() == 2 * edges.size(), !has_rim);
}

TEST_P(EveryShape, NormalsAreUnitAndOutwards)
{
    const std::vector<Corners> triangles = triangles_of(mesh);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const glm::dvec3 face = glm::normalize(triangles[t].doubled_area());
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vertex& vertex = mesh.vertices[mesh.indices[3 * t + corner]];
            const glm::dvec3 normal(vertex.normal), tangent(vertex.tangent);
            ASSERT_NEAR(glm::length(normal), 1.0, kRounding);
            ASSERT_NEAR(glm::length(tangent), 1.0, kRounding);
            ASSERT_NEAR(glm::dot(normal, tangent), 0.0, kRounding);
            // A ring of the tube is 15 degrees, a segment 7.5: at a corner less than a whole step off each.
            ASSERT_GT(glm::dot(normal, face), std::cos(glm::radians(15.0 + 7.5)));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(all_known()),
                         [](const auto& info) { return shape_names()[std::size_t(info.param.shape)]; });

TEST(Shapes, AreFoundByTheirNames)
{
    for (std::size_t i = 0; i < shape_names().size(); ++i) EXPECT_EQ(shape_from_name(shape_names()[i]), Shape(i));
    EXPECT_EQ(shape_names().size(), all_known().size());
    EXPECT_FALSE(shape_from_name("sphere "));
}

}  // namespace
}  // namespace conebook
