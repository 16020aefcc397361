// Voxelization against exact overlap of triangle and box in double precision (Schwarz & Seidel 2010).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "robustness/gltf_builder.hpp"
#include "voxel_oracle.hpp"
#include "soup_pipeline.hpp"

namespace conebook {
namespace {

using Soup = std::vector<std::array<glm::vec3, 3>>;

struct Comparison {
    std::size_t exact = 0, missed = 0, extra = 0, far_extra = 0;  // far: further than the reach from every triangle
};

// `reach_voxels`: how far a voxel may be from the triangle that marked it.
Comparison compare(const Scene& scene, const Bounds& bounds, int voxels, Voxelizer voxelizer, double reach_voxels = 1e-4)
{
    SoupPipeline pipeline(scene, bounds, voxels, voxelizer);
    pipeline.voxelize();
    const auto triangles = oracle::triangles_of(scene, pipeline.grid().data());
    const auto exact = oracle::overlapped(triangles, pipeline.grid().size(), 0.0);
    const auto grown = oracle::overlapped(triangles, pipeline.grid().size(), reach_voxels);
    const auto marked = pipeline.occupancy();
    Comparison result;
    for (std::size_t i = 0; i < marked.size(); ++i) {
        result.exact += exact[i] != 0;
        result.missed += exact[i] != 0 && marked[i] == 0u;
        result.extra += exact[i] == 0 && marked[i] != 0u;
        result.far_extra += grown[i] == 0 && marked[i] != 0u;
    }
    return result;
}

void expect_exact(const Scene& scene, const Bounds& bounds, int voxels, const std::string& what,
                  double reach_voxels = 1e-4)
{
    for (const Voxelizer voxelizer : {Voxelizer::raster, Voxelizer::compute}) {
        const Comparison c = compare(scene, bounds, voxels, voxelizer, reach_voxels);
        std::printf("%s, %s: %zu voxels, %zu missed, %zu extra\n", what.c_str(),
                    voxelizer == Voxelizer::raster ? "raster" : "compute", c.exact, c.missed, c.extra);
        EXPECT_GT(c.exact, 0u) << what;
        EXPECT_EQ(c.missed, 0u) << what;
        EXPECT_LE(double(c.extra), 0.01 * double(c.exact)) << what;
        EXPECT_EQ(c.far_extra, 0u) << what;
    }
}
void expect_exact(const Scene& scene, int voxels, const std::string& what, double reach_voxels = 1e-4)
{
    expect_exact(scene, scene.bounds, voxels, what, reach_voxels);
}

TEST(Voxelization, TriangleSoups)
{
    for (const unsigned seed : {1u, 2u, 3u}) {
        std::mt19937 random(seed);
        // 0.01 to 100 voxels. Few large ones, or the grid would be full and nothing could be missed.
        Soup soup = random_triangles(random, 9000, unit_bounds(128), 0.01f, 3.0f);
        for (const auto& t : random_triangles(random, 900, unit_bounds(128), 3.0f, 20.0f)) soup.push_back(t);
        for (const auto& t : random_triangles(random, 100, unit_bounds(128), 20.0f, 100.0f)) soup.push_back(t);
        expect_exact(triangle_soup(soup), 128, "soup " + std::to_string(seed));
    }
}

// The list of fragments has every pair of a triangle and a voxel that overlap, each once.
void expect_exact_pairs(const Soup& soup, const Bounds& bounds, int voxels)
{
    const Scene scene = triangle_soup(soup);
    using Pair = std::pair<std::size_t, std::array<int, 3>>;
    std::set<Pair> exact, grown;
    const shared::GridData grid = make_grid(bounds, {voxels});
    const glm::ivec3 size(grid.size);
    const auto triangles = oracle::triangles_of(scene, grid);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        oracle::for_each_voxel(triangles[i], size, 0.0, [&](glm::ivec3 v) { exact.insert({i, {v.x, v.y, v.z}}); });
        oracle::for_each_voxel(triangles[i], size, 1e-4, [&](glm::ivec3 v) { grown.insert({i, {v.x, v.y, v.z}}); });
    }
    for (const Voxelizer voxelizer : {Voxelizer::raster, Voxelizer::compute}) {
        SoupPipeline pipeline(scene, bounds, voxels, voxelizer);
        pipeline.voxelize();
        const auto list = pipeline.voxelizer().fragments().buffer().read<glm::uvec2>();
        std::set<Pair> found;
        for (std::size_t i = 0; i < pipeline.fragment_count(); ++i) {
            const GLuint p = list[i].y;
            found.insert({list[i].x, {int(p & 511u), int(p >> 9 & 511u), int(p >> 18 & 511u)}});
        }
        std::printf("%zu pairs of triangle and voxel, %zu found, %zu within 1e-4\n", exact.size(), found.size(),
                    grown.size());
        EXPECT_EQ(found.size(), pipeline.fragment_count());  // each once
        EXPECT_TRUE(std::includes(found.begin(), found.end(), exact.begin(), exact.end()));
        EXPECT_TRUE(std::includes(grown.begin(), grown.end(), found.begin(), found.end()));
    }
}

TEST(Voxelization, EveryTriangleByItself)
{
    // In a soup a voxel that one triangle misses may be marked by another; fragments are counted one by one.
    std::mt19937 random(4);
    Soup soup = random_triangles(random, 10000, unit_bounds(128), 0.01f, 100.0f);
    std::erase_if(soup, [](const auto& t) {
        return oracle::area_of({glm::dvec3(t[0]), glm::dvec3(t[1]), glm::dvec3(t[2])}) == 0.0;
    });
    expect_exact_pairs(soup, triangle_soup(soup).bounds, 128);
}

// Small triangles round the corners of voxels meet six to eight each, and not the one or two that are usual: more than
// the list has room for at first.
TEST(Voxelization, MoreFragmentsThanExpected)
{
    std::mt19937 random(5);
    std::uniform_int_distribution<int> corner(2, 14);
    const float s = 0.05f;
    Soup soup;
    for (int i = 0; i < 3000; ++i) {
        const glm::vec3 p(corner(random), corner(random), corner(random));
        soup.push_back({p + s * glm::vec3(2, -1, -1), p + s * glm::vec3(-1, 2, -1), p + s * glm::vec3(-1, -1, 2)});
    }
    expect_exact_pairs(soup, unit_bounds(16), 16);
}

TEST(Voxelization, RasterAndComputeAgree)
{
    std::mt19937 random(5);
    const Scene scene = triangle_soup(random_triangles(random, 2000, unit_bounds(96), 0.01f, 100.0f));
    SoupPipeline raster(scene, 96, Voxelizer::raster), compute(scene, 96, Voxelizer::compute);
    raster.voxelize();
    compute.voxelize();
    EXPECT_EQ(raster.occupancy(), compute.occupancy());
    EXPECT_EQ(raster.fragment_count(), compute.fragment_count());
}

// Normals with equal components. Two axis tests with `>` fall through to z and see (1,1,0) edge-on: nothing is drawn.
TEST(Voxelization, NormalsWithTies)
{
    Soup soup;
    int place = 0;
    const auto add = [&](const glm::vec3& u, const glm::vec3& v) {
        const glm::vec3 corner(8.0f + 16.0f * float(place % 7), 8.0f + 16.0f * float(place / 7 % 7), 8.3f + 16.0f * float(place / 49));
        soup.push_back({corner, corner + 4.0f * u, corner + 4.0f * v});
        soup.push_back({corner, corner + 4.0f * v, corner + 4.0f * u});
        ++place;
    };
    for (const float a : {-1.0f, 1.0f})
        for (const float b : {-1.0f, 1.0f}) {
            add({a, -b, 0}, {0, 0, 1});  // normals +-(b, a, 0)
            add({a, 0, -b}, {0, 1, 0});
            add({0, a, -b}, {1, 0, 0});
            for (const float c : {-1.0f, 1.0f}) add({a, -b, 0}, {0, b, -c});  // +-(bc, ac, ab): all signs
        }
    const Scene scene = triangle_soup(soup);
    expect_exact(scene, unit_bounds(128), 128, "ties");
    SoupPipeline pipeline(scene, unit_bounds(128), 128);
    pipeline.average();
    // Edge-on they would have no area.
    double area = 0.0;
    for (const auto& t : oracle::triangles_of(scene, pipeline.grid().data())) area += oracle::area_of(t);
    EXPECT_NEAR(pipeline.total_area_voxels() / area, 1.0, 1e-4);
    EXPECT_EQ(pipeline.statistics().degenerate, 0u);
}

TEST(Voxelization, SliversLeaveNoHole)
{
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    Soup soup;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 center = 20.0f + 88.0f * glm::vec3(unit(random), unit(random), unit(random));
        glm::vec3 along = random_direction(random);
        if (i % 3 == 0) along = glm::vec3(i % 9 == 0, i % 9 == 3, i % 9 == 6);
        const float length = 5.0f + 30.0f * unit(random);
        const glm::vec3 across = 1e-6f * length * random_direction(random);
        const float where = unit(random);  // sharp at both ends, or a needle
        soup.push_back({center - 0.5f * length * along, center + 0.5f * length * along,
                        center + (where - 0.5f) * length * along + across});
    }
    // The oracle takes the vertices as they were rounded to float, which makes some of these wider and some have no
    // area at all: those are left out and counted.
    const Scene scene = triangle_soup(soup);
    SoupPipeline pipeline(scene, unit_bounds(128), 128);
    pipeline.voxelize();
    std::size_t without_area = 0;
    Soup with_area;
    for (const auto& t : soup) {
        const bool none = oracle::area_of({glm::dvec3(t[0]), glm::dvec3(t[1]), glm::dvec3(t[2])}) == 0.0;
        without_area += none;
        if (!none) with_area.push_back(t);
    }
    EXPECT_EQ(pipeline.statistics().degenerate, without_area);
    ASSERT_GT(with_area.size(), 200u);
    expect_exact(triangle_soup(with_area), unit_bounds(128), 128, "slivers");
}

TEST(Voxelization, TrianglesWithoutAreaAreCounted)
{
    const glm::vec3 p(3.5f, 4.5f, 5.5f), q(9.5f, 4.5f, 5.5f), r(15.5f, 4.5f, 5.5f);
    const Soup soup = {{p, p, p}, {p, q, q}, {p, p, q}, {p, q, p}, {p, q, r}, {glm::vec3(1.0f), glm::vec3(2.0f), glm::vec3(3.0f)}};
    for (const Voxelizer voxelizer : {Voxelizer::raster, Voxelizer::compute}) {
        SoupPipeline pipeline(triangle_soup(soup), unit_bounds(32), 32, voxelizer);
        pipeline.average();
        EXPECT_EQ(pipeline.statistics().degenerate, soup.size());
        EXPECT_EQ(pipeline.fragment_count(), 0u);
        EXPECT_EQ(pipeline.statistics().voxels, 0u);
    }
}

// Voxels are closed boxes here: a triangle in the side between two voxels marks both. (Its area counts in the upper one
// only: Averaging.QuadOnAVoxelSideCountsOnce.)
TEST(Voxelization, TrianglesOnVoxelSides)
{
    Soup soup;
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 corner(4.0f), u(0.0f), v(0.0f);
        corner[axis] = 8.0f + float(axis);
        u[(axis + 1) % 3] = 9.0f;
        v[(axis + 2) % 3] = 7.0f;
        soup.push_back({corner, corner + u, corner + v});
        soup.push_back({corner + u, corner + u + v, corner + v});
    }
    const Comparison raster = compare(triangle_soup(soup), unit_bounds(32), 32, Voxelizer::raster);
    const Comparison compute = compare(triangle_soup(soup), unit_bounds(32), 32, Voxelizer::compute);
    for (const Comparison& c : {raster, compute}) {
        EXPECT_GT(c.exact, 300u);
        EXPECT_EQ(c.missed, 0u);
        EXPECT_EQ(c.extra, 0u);  // all of it is exact in floats
    }
}

TEST(Voxelization, BorderOutsideAndLargerThanTheGrid)
{
    const float n = 32.0f;
    // On the border, from both sides.
    Soup border;
    for (int axis = 0; axis < 3; ++axis)
        for (const float at : {0.0f, n}) {
            glm::vec3 a(3.0f), b(3.0f), c(3.0f);
            a[axis] = b[axis] = c[axis] = at;
            b[(axis + 1) % 3] = 20.0f;
            c[(axis + 2) % 3] = 20.0f;
            border.push_back({a, b, c});
        }
    expect_exact(triangle_soup(border), unit_bounds(32), 32, "on the border");

    // Outside on every side, by little and by much: nothing is written, nothing comes in again on the other side.
    Soup outside;
    for (int axis = 0; axis < 3; ++axis)
        for (const float at : {-0.01f, -1.5f, -33.0f, -1e4f, n + 0.01f, n + 1.5f, n + 33.0f, 1e4f}) {
            glm::vec3 a(3.0f), b(3.0f), c(3.0f);
            a[axis] = b[axis] = at;
            c[axis] = at + (at < 0.0f ? -3.0f : 3.0f);
            b[(axis + 1) % 3] = 20.0f;
            c[(axis + 2) % 3] = 20.0f;
            outside.push_back({a, b, c});
        }
    for (const Voxelizer voxelizer : {Voxelizer::raster, Voxelizer::compute}) {
        SoupPipeline pipeline(triangle_soup(outside), unit_bounds(32), 32, voxelizer);
        pipeline.voxelize();
        EXPECT_EQ(pipeline.fragment_count(), 0u);
        for (const GLuint mask : pipeline.occupancy()) EXPECT_EQ(mask, 0u);
    }

    // Larger than the grid: rounding grows with the coordinates, and the tolerance is 4e-7 of the largest.
    for (const float size : {100.0f, 1000.0f, 10000.0f}) {
        std::mt19937 random(7);
        Soup large;
        for (int i = 0; i < 8; ++i) {
            const glm::vec3 a = random_direction(random), b = glm::normalize(glm::cross(a, random_direction(random)));
            const glm::vec3 through(10.0f + float(i));
            large.push_back({through + size * a, through + size * (-0.5f * a + 0.8f * b), through + size * (-0.5f * a - 0.8f * b)});
        }
        expect_exact(triangle_soup(large), unit_bounds(32), 32, "size " + std::to_string(int(size)), 8.4e-7 * double(size) + 1e-4);
    }
}

TEST(Voxelization, SteepPlanesMarkAllVoxelsOfAColumn)
{
    // Slopes near 1 in both directions cross up to three voxels inside one column.
    Soup soup;
    for (int axis = 0; axis < 3; ++axis) {
        const auto point = [&](float x, float y) {
            glm::vec3 p;
            p[axis] = 40.3f - 0.98f * (x - 20.0f) - 0.97f * (y - 20.0f);
            p[(axis + 1) % 3] = x;
            p[(axis + 2) % 3] = y;
            return p;
        };
        soup.push_back({point(12.2f, 12.4f), point(33.1f, 14.7f), point(15.3f, 31.9f)});
    }
    const Scene scene = triangle_soup(soup);
    expect_exact(scene, unit_bounds(64), 64, "steep");
    SoupPipeline pipeline(triangle_soup({soup[2]}), unit_bounds(64), 64);  // axis 2: columns along z
    pipeline.voxelize();
    const auto marked = pipeline.occupancy();
    std::array<int, 4> columns_with{};
    for (std::size_t column = 0; column < 64 * 64; ++column) {
        std::size_t count = 0;
        for (std::size_t z = 0; z < 64; ++z) count += marked[column + 64 * 64 * z] != 0u;
        ASSERT_LE(count, 3u);
        ++columns_with[count];
    }
    EXPECT_GT(columns_with[3], 50);
    EXPECT_GT(columns_with[2], 20);
}

TEST(Voxelization, FlatSceneAndGridsThatAreNoPowerOfTwo)
{
    std::mt19937 random(8);
    for (const int voxels : {4, 7, 37, 100, 129}) {
        const float n = float(voxels);
        const Scene cube = triangle_soup(random_triangles(random, 300, unit_bounds(voxels), 0.05f, 0.5f * n));
        expect_exact(cube, voxels, "cube " + std::to_string(voxels));
    }
    for (int axis = 0; axis < 3; ++axis)
        for (const int voxels : {100, 128}) {
            Bounds flat{glm::vec3(-1.0f), glm::vec3(9.0f)};
            flat.max[axis] = 99.0f;  // 100 : 10 : 10
            const Scene scene = triangle_soup(random_triangles(random, 2000, flat, 0.01f, 20.0f));
            expect_exact(scene, voxels, "10:1:1");
            SoupPipeline pipeline(scene, voxels);
            pipeline.voxelize();
            // Cubic voxels in a tight grid: the padding (to a multiple of the coarsest voxel) stays empty.
            const shared::GridData grid = pipeline.grid().data();
            const glm::ivec3 size = pipeline.grid().size();
            const auto marked = pipeline.occupancy();
            const int multiple = 1 << (grid.size.w - 1);
            for (int i = 0; i < 3; ++i) {
                EXPECT_EQ(size[i] % multiple, 0);
                EXPECT_LT(float(size[i]), grid.content_max[i] + float(multiple) + 1.0f);
                EXPECT_GE(float(size[i]), grid.content_max[i]);
            }
            for (int z = 0; z < size.z; ++z)
                for (int y = 0; y < size.y; ++y)
                    for (int x = 0; x < size.x; ++x) {
                        const glm::vec3 low(x, y, z);
                        const bool padding = low.x > grid.content_max.x + 1e-3f || low.y > grid.content_max.y + 1e-3f ||
                                             low.z > grid.content_max.z + 1e-3f;
                        const std::size_t i = std::size_t(x + size.x * (y + size.y * z));
                        ASSERT_TRUE(!padding || marked[i] == 0u);
                    }
        }
}

// The same soup in a file, moved 10 km away and scaled: the loader makes positions relative to the scene's middle.
TEST(Voxelization, FarAwayAndScaled)
{
    std::mt19937 random(9);
    const Soup soup = random_triangles(random, 3000, {glm::vec3(-1.0f), glm::vec3(1.0f)}, 0.005f, 0.7f);
    const auto load = [&](double scale, const glm::dvec3& translation) {
        test::GltfBuilder gltf;
        std::vector<float> positions;
        for (const auto& t : soup)
            for (const glm::vec3& p : t) positions.insert(positions.end(), {p.x, p.y, p.z});
        gltf.add_mesh({{"attributes", {{"POSITION", gltf.add_floats(positions, 3)}}}});
        gltf.add_node({{"mesh", 0},
                       {"scale", {scale, scale, scale}},
                       {"translation", {translation.x, translation.y, translation.z}}});
        const TemporaryFolder folder;
        return load_scene(test::write_file(folder.path() / "soup.glb", gltf.glb()));
    };
    const auto voxels_of = [&](const Scene& scene) {
        SoupPipeline pipeline(scene, 128);
        pipeline.voxelize();
        return pipeline.occupancy();
    };
    const auto here = voxels_of(load(1.0, {0, 0, 0}));
    std::size_t occupied = 0;
    for (const GLuint mask : here) occupied += mask != 0u;
    for (const double scale : {1.0, 1e-3, 1e3})
        for (const double distance : {0.0, 1e4 * scale, 1e4}) {
            const auto there = voxels_of(load(scale, {distance, -distance, 0.5 * distance}));
            ASSERT_EQ(there.size(), here.size());
            std::size_t different = 0;
            for (std::size_t i = 0; i < here.size(); ++i) different += (here[i] != 0u) != (there[i] != 0u);
            std::printf("scale %g at %g m: %zu of %zu voxels differ\n", scale, distance, different, occupied);
            EXPECT_LE(double(different), 0.001 * double(occupied)) << scale << " at " << distance;
        }
}

// What plain rasterization leaves out, and that it finds nothing else.
TEST(Voxelization, PlainRasterizationLeavesHoles)
{
    std::mt19937 random(10);
    const Scene scene = triangle_soup(random_triangles(random, 3000, unit_bounds(64), 0.1f, 10.0f));
    SoupPipeline whole(scene, 64), plain(scene, scene.bounds, 64, Voxelizer::raster, false);
    whole.voxelize();
    plain.voxelize();
    const auto a = whole.occupancy(), b = plain.occupancy();
    std::size_t all = 0, lost = 0, invented = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        all += a[i] != 0u;
        lost += a[i] != 0u && b[i] == 0u;
        invented += a[i] == 0u && b[i] != 0u;
    }
    std::printf("plain rasterization loses %zu of %zu voxels\n", lost, all);
    EXPECT_GT(double(lost), 0.3 * double(all));
    // Where the triangle covers the column's middle, the plane's point there is on the triangle.
    EXPECT_LE(double(invented), 0.001 * double(all));
}

}  // namespace
}  // namespace conebook
