// The octree and its bricks against a dense lattice on the CPU in double precision: which nodes there are, what every
// sample holds, that copies agree, and what goes wrong with fewer border nodes or an averaging transfer.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

#include "17_sparse_voxel_octree/brick_pool.hpp"
#include "17_sparse_voxel_octree/photons.hpp"
#include "lit_scene.hpp"
#include "scene_builder.hpp"

namespace conebook {
namespace {

constexpr int kSide = 16;  // voxels of 1 m; voxel i is [i - 0.5, i + 0.5)
const Bounds kBounds{glm::vec3(0.0f), glm::vec3(kSide - 1)};

// Values at the corners of cells, whole lattice, one level and direction.
struct Lattice {
    int count = 0;  // along a side
    std::vector<glm::dvec4> values;
    glm::dvec4& at(const glm::ivec3& p) { return values[std::size_t((p.z * count + p.y) * count + p.x)]; }
    glm::dvec4 get(const glm::ivec3& p) const
    {
        const bool inside =
            glm::all(glm::greaterThanEqual(p, glm::ivec3(0))) && glm::all(glm::lessThan(p, glm::ivec3(count)));
        return inside ? values[std::size_t((p.z * count + p.y) * count + p.x)] : glm::dvec4(0.0);
    }
    explicit Lattice(int n) : count(n), values(std::size_t(n) * std::size_t(n) * std::size_t(n), glm::dvec4(0.0)) {}
};

template <typename Function>
void for_each_place(int count, Function function)
{
    for (int z = 0; z < count; ++z)
        for (int y = 0; y < count; ++y)
            for (int x = 0; x < count; ++x) function(glm::ivec3(x, y, z));
}

// Voxels, tree and bricks of a scene, and the dense lattices that they should agree with.
struct TreeScene {
    VoxelScene voxels;
    ShadowMaps shadow_maps;
    VoxelShading shading;
    Octree tree;
    BrickPool bricks;

    explicit TreeScene(const Scene& source, const OctreeParams& tree_params = {}, Transfer transfer = Transfer::sum)
        : voxels(source, kBounds, kSide),
          shadow_maps(test_gl().shaders),
          shading(test_gl().shaders),
          tree(test_gl().shaders),
          bricks(test_gl().shaders)
    {
        voxels.average();
        shadow_maps.draw(voxels.scene, {});
        shading.run(voxels.scene, voxels.grid, voxels.voxelizer, voxels.faces, shadow_maps, {});
        tree.build(voxels.grid, voxels.faces, tree_params);
        bricks.fill(voxels.grid, voxels.faces, tree, shading.radiance(), shading.revision(),
                    {transfer, BrickFormat::rgba32f});
    }

    // The samples of all bricks: (level, direction, place) -> values, one for each copy.
    using Samples = std::map<std::tuple<int, int, int, int, int>, std::vector<glm::dvec4>>;
    Samples samples() const
    {
        const std::vector<float> texels = gl::read_floats(bricks.pool(), 0, 4);
        const glm::ivec3 size = bricks.pool().size();
        const auto list = tree.brick_list().read<GLuint>();
        const auto places = tree.places().read<GLuint>();
        Samples all;
        for (int level = 0; level < tree.depth(); ++level)
            for (GLuint brick = tree.level(level).bricks; brick < tree.bricks_end(level); ++brick) {
                const GLuint place = places[list[brick] >> 3];
                const glm::ivec3 corner = 2 * glm::ivec3(place & 1023u, place >> 10 & 1023u, place >> 20 & 1023u);
                const glm::ivec3 texel = 3 * glm::ivec3(brick % 128, brick / 128 % 128, brick / (128 * 128));
                for_each_place(3, [&](const glm::ivec3& k) {
                    const glm::ivec3 t = texel + k, p = corner + k;
                    const float* v = &texels[4 * std::size_t((t.z * size.y + t.y) * size.x + t.x)];
                    all[{level, int(list[brick] & 7u), p.x, p.y, p.z}].emplace_back(v[0], v[1], v[2], v[3]);
                });
            }
        return all;
    }

    // By the formulas of the page, whole lattice: [level][direction].
    std::vector<std::vector<Lattice>> dense() const
    {
        const auto entries = voxels.faces.face_list().read<GLuint>();
        const auto means = voxels.faces.faces().read<shared::VoxelFace>();
        const auto radiance = shading.radiance().read<glm::vec4>();
        const shared::GridData& grid = voxels.grid.data();
        const int depth = tree.depth(), side = 1 << depth;
        const auto within = [&](int axis, int i) {
            const double low = std::max(double(i), double(grid.content_min[axis]));
            return i < 0 || i >= side ? 0.0 : std::max(std::min(i + 1.0, double(grid.content_max[axis])) - low, 0.0);
        };
        std::vector<std::vector<double>> weights[3];  // [axis][spacing][place]
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> now;
            for (int i = 0; i <= side; ++i) now.push_back(0.5 * (within(axis, i - 1) + within(axis, i)));
            weights[axis].push_back(now);
            for (int count = side / 2; count >= 2; count /= 2) {
                std::vector<double> next;
                const std::vector<double>& old = weights[axis].back();
                for (int i = 0; i <= count; ++i)
                    next.push_back(0.5 * old[std::size_t(2 * i)] + 0.25 * (i > 0 ? old[std::size_t(2 * i - 1)] : 0.0) +
                                   0.25 * (i < count ? old[std::size_t(2 * i + 1)] : 0.0));
                weights[axis].push_back(next);
            }
        }
        std::vector<std::vector<Lattice>> all(std::size_t(depth), std::vector<Lattice>(6, Lattice(1)));
        for (int direction = 0; direction < 6; ++direction) {
            const int axis = direction / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
            Lattice base(side);
            for (std::size_t i = 0; i < voxels.faces.face_count(); ++i) {
                const GLuint e = entries[i];
                const glm::ivec3 v(e & 511u, e >> 9 & 511u, e >> 18 & 511u);
                const double shown = std::max((direction % 2 == 1 ? 1.0 : -1.0) * double(means[i].normal[axis]), 0.0);
                if (shown > 1.0 / 2048.0)
                    base.at(v) += shown * double(means[i].albedo_area.a) *
                                  glm::dvec4(glm::dvec3(radiance[i]) + glm::dvec3(means[i].emission), 1.0);
            }
            for_each_place(side, [&](const glm::ivec3& v) {
                const double inside = within(b, v[b]) * within(c, v[c]);
                if (inside > 0.0) base.at(v) /= inside;
                base.at(v) /= std::max(base.at(v).a, 1.0);
            });
            // Leaves: the mean of eight voxels, across the direction of what is within the bounds.
            Lattice level(side + 1);
            for_each_place(side + 1, [&](const glm::ivec3& p) {
                const double weight = weights[b][0][std::size_t(p[b])] * weights[c][0][std::size_t(p[c])];
                for_each_place(2, [&](const glm::ivec3& k) {
                    const glm::ivec3 v = p - k;
                    if (weight > 0.0) level.at(p) += base.get(v) * (0.125 * within(b, v[b]) * within(c, v[c]) / weight);
                });
            });
            all[std::size_t(depth - 1)][std::size_t(direction)] = level;
            for (int l = depth - 2; l >= 0; --l) {
                const auto fine = std::size_t(depth - 2 - l), coarse = fine + 1;
                Lattice next((2 << l) + 1);
                glm::ivec3 front(0);
                front[axis] = direction % 2 == 1 ? 1 : -1;
                const auto cut = [](const glm::dvec4& v, double open) {
                    return v.a > open ? v * (std::max(open, 0.0) / v.a) : v;
                };
                for_each_place(next.count, [&](const glm::ivec3& p) {
                    const double weight = weights[b][coarse][std::size_t(p[b])] * weights[c][coarse][std::size_t(p[c])];
                    for (int i = 0; i < 9 && weight > 0.0; ++i) {
                        glm::ivec3 old = 2 * p;
                        old[b] += i % 3 - 1;
                        old[c] += i / 3 - 1;
                        if (std::min(old[b], old[c]) < 0 || std::max(old[b], old[c]) >= level.count) continue;
                        glm::dvec4 sum = 0.5 * level.get(old + front);
                        sum += cut(level.get(old), 1.0 - sum.a);
                        sum += cut(0.5 * level.get(old - front), 1.0 - sum.a);
                        const double kernel = (i % 3 == 1 ? 0.5 : 0.25) * (i / 3 == 1 ? 0.5 : 0.25);
                        next.at(p) += sum * (kernel * weights[b][fine][std::size_t(old[b])] *
                                             weights[c][fine][std::size_t(old[c])] / weight);
                    }
                });
                all[std::size_t(l)][std::size_t(direction)] = level = next;
            }
        }
        return all;
    }
};

double largest(const glm::dvec4& v)
{
    return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::max(std::abs(v.z), std::abs(v.w)));
}

double copies_differ(const TreeScene::Samples& samples)
{
    double most = 0.0;
    for (const auto& [key, copies] : samples)
        for (const glm::dvec4& copy : copies) most = std::max(most, largest(copy - copies[0]));
    return most;
}

// Of all samples of the dense lattice: the largest difference, and how many are not 0 where no brick has them.
struct Against {
    double error = 0.0;
    int missing = 0;
};
Against against_dense(const TreeScene& scene)
{
    const TreeScene::Samples samples = scene.samples();
    const auto dense = scene.dense();
    Against result;
    for (int level = 0; level < scene.tree.depth(); ++level)
        for (int direction = 0; direction < 6; ++direction) {
            const Lattice& lattice = dense[std::size_t(level)][std::size_t(direction)];
            for_each_place(lattice.count, [&](const glm::ivec3& p) {
                const auto found = samples.find({level, direction, p.x, p.y, p.z});
                if (found == samples.end()) {
                    result.missing += int(largest(lattice.get(p)) > 0.0);
                    return;
                }
                for (const glm::dvec4& copy : found->second)
                    result.error = std::max(result.error, largest(copy - lattice.get(p)));
            });
        }
    return result;
}

// A plane at z = 5 m through the whole root, and quads of a voxel's size at 60 random places, turned in every way.
Scene plane_and_pieces(bool with_plane = true)
{
    SceneBuilder b;
    const int grey = b.material(emitter(2.0f, 0.5f)), red = b.material(emitter({3.0f, 0.5f, 0.1f}, 0.5f));
    if (with_plane) b.quad({0, 0, 5}, {kSide - 1, 0, 0}, {0, kSide - 1, 0}, grey);
    std::mt19937 random(17);
    std::uniform_real_distribution<float> place(0.5f, kSide - 1.5f), side(-1.0f, 1.0f);
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 p(place(random), place(random), place(random));
        const glm::vec3 u(side(random), side(random), side(random)), v(side(random), side(random), side(random));
        b.quad(glm::clamp(p - 0.5f * (u + v), 0.0f, kSide - 1.0f), u * 0.5f, v * 0.5f, red);
    }
    b.point_light({7, 7, 12}, glm::vec3(500.0f));
    return b.build();
}

Scene plane()
{
    SceneBuilder b;
    b.quad({0, 0, 5}, {kSide - 1, 0, 0}, {0, kSide - 1, 0}, b.material(emitter(2.0f)));
    return b.build();
}

TEST(Octree, SamplesAreThoseOfTheDenseLatticeAndCopiesAgree)
{
    const TreeScene scene(plane_and_pieces());
    EXPECT_EQ(copies_differ(scene.samples()), 0.0);
    const Against found = against_dense(scene);
    EXPECT_EQ(found.missing, 0) << "samples that are not 0 and that no brick has";
    // Floats of values up to 100: 2^-24 of it a rounding, a few of them a sample.
    EXPECT_LT(found.error, 1e-5 * 100.0);
    RecordProperty("error", std::to_string(found.error));
}

TEST(Octree, PlaneHasThreeLayersOfNodes)
{
    const TreeScene scene(plane());
    ASSERT_EQ(scene.tree.depth(), 4);
    for (int level = 2; level < 4; ++level) {
        EXPECT_EQ(scene.tree.level(level).geometry_end - scene.tree.level(level).begin, 1u << 2 * level);
        EXPECT_EQ(scene.tree.level(level).end - scene.tree.level(level).begin, 3u << 2 * level);
    }
}

TEST(Octree, WallCoversOnceAlongEveryLineAtEveryLevel)
{
    const TreeScene scene(plane());
    for (int level = 0; level < scene.tree.depth(); ++level) {
        std::map<std::pair<int, int>, double> sums;
        for (const auto& [key, copies] : scene.samples())
            if (std::get<0>(key) == level && std::get<1>(key) == 5)
                sums[{std::get<2>(key), std::get<3>(key)}] += copies[0].a;
        EXPECT_EQ(sums.size(), std::size_t((2 << level) + 1) * std::size_t((2 << level) + 1));
        for (const auto& [line, sum] : sums) EXPECT_NEAR(sum, 1.0, 1e-6) << "level " << level;
    }
}

// Walls behind each other, one in every layer of voxels, wholly within the bounds.
TEST(Octree, FullRootIsOneEverywhere)
{
    SceneBuilder b;
    const int white = b.material(emitter(1.0f));
    for (int z = 0; z < kSide; ++z) b.quad({0, 0, float(z)}, {kSide - 1, 0, 0}, {0, kSide - 1, 0}, white);
    const TreeScene scene(b.build());
    for (const auto& [key, copies] : scene.samples()) {
        const auto [level, direction, x, y, z] = key;
        // At the root's sides along the direction a leaf's sample has a voxel on one side alone; above, the next sample
        // behind fills what it leaves open.
        const bool at_side = level == 3 && (z == 0 || z == kSide);
        if (direction == 5) {
            EXPECT_NEAR(copies[0].a, at_side ? 0.5 : 1.0, 1e-6) << level << " " << x << " " << y << " " << z;
        }
    }
}

// Small quads far from each other and from the bounds: nothing hides anything, and nothing is cut off at a side.
TEST(Octree, EveryLevelSendsTheSameLight)
{
    SceneBuilder b;
    b.quad({4, 4, 4}, {0.7f, 0, 0}, {0, 0.7f, 0}, b.material(emitter({1.0f, 2.0f, 3.0f})));
    b.quad({9, 4, 10}, {0, 0.7f, 0.3f}, {0, 0, 0.7f}, b.material(emitter(5.0f)));
    b.quad({6, 10, 7}, {0.5f, 0, 0.2f}, {0, 0, -0.6f}, b.material(emitter(1.0f)));
    const TreeScene scene(b.build());
    const TreeScene::Samples samples = scene.samples();
    for (int direction = 0; direction < 6; ++direction) {
        std::vector<glm::dvec4> sums(std::size_t(scene.tree.depth()), glm::dvec4(0.0));
        for (const auto& [key, copies] : samples)
            if (std::get<1>(key) == direction && std::get<0>(key) >= 2) {
                const double spacing = double(8 >> std::get<0>(key));
                sums[std::size_t(std::get<0>(key))] += copies[0] * spacing * spacing;
            }
        EXPECT_LT(largest(sums[2] - sums[3]), 1e-5 * std::max(largest(sums[3]), 1e-6)) << direction;
    }
}

TEST(OctreeBroken, SixNeighboursLeaveSamplesApartAndCutLightOff)
{
    const TreeScene whole(plane_and_pieces()), broken(plane_and_pieces(), {6, true}),
        bare(plane_and_pieces(), {26, false});
    EXPECT_EQ(against_dense(whole).missing, 0);
    EXPECT_GT(copies_differ(broken.samples()), 0.05);
    EXPECT_LT(broken.tree.counts().nodes, whole.tree.counts().nodes);
    // Cells next to geometry into which the lattice fades, and which the tree does not have.
    EXPECT_GT(bare.tree.counts().nodes, 0u);
    EXPECT_LT(bare.tree.counts().nodes, broken.tree.counts().nodes);
    RecordProperty("copies_differ", std::to_string(copies_differ(broken.samples())));
}

// Of a wall in one layer of leaves: the sum is 1/2 on both samples next to it, everywhere. The mean keeps what a node
// has by itself: the whole in its middle, a half on its edges, a quarter at its corners; and half of it beyond the
// leaf.
TEST(OctreeBroken, AveragingLosesHalfAtEveryBorder)
{
    const TreeScene summed(plane()), averaged(plane(), {}, Transfer::average);
    const auto right = summed.samples(), wrong = averaged.samples();
    for (int x = 2; x < 15; ++x)
        for (int y = 2; y < 15; ++y) {
            // The wall is in voxel 5, the upper one of its leaf: samples 5 (inside the leaf) and 6 (on its side).
            EXPECT_NEAR(right.at({3, 5, x, y, 5})[0].a, 0.5, 1e-6);
            EXPECT_NEAR(right.at({3, 5, x, y, 6})[0].a, 0.5, 1e-6);
            const double kept = 0.5 / (1 << (int(x % 2 == 0) + int(y % 2 == 0)));
            EXPECT_NEAR(wrong.at({3, 5, x, y, 5})[0].a, kept, 1e-6) << x << " " << y;
            EXPECT_NEAR(wrong.at({3, 5, x, y, 6})[0].a, 0.5 * kept, 1e-6) << x << " " << y;
        }
}

struct PhotonScene {
    VoxelScene voxels;
    Octree tree;
    Photons photons;
    PhotonScene(const Scene& source, int map_size)
        : voxels(source, kBounds, kSide), tree(test_gl().shaders), photons(test_gl().shaders)
    {
        voxels.average();
        tree.build(voxels.grid, voxels.faces, {});
        photons.run(voxels.scene, voxels.grid, voxels.faces, tree, {map_size});
    }
};

void add_room(SceneBuilder& b, int material)
{
    const float s = kSide - 1;
    b.quad({0, 0, 0}, {s, 0, 0}, {0, s, 0}, material);  // +z
    b.quad({0, 0, s}, {0, s, 0}, {s, 0, 0}, material);  // -z
    b.quad({0, 0, 0}, {0, s, 0}, {0, 0, s}, material);  // +x
    b.quad({s, 0, 0}, {0, 0, s}, {0, s, 0}, material);  // -x
    b.quad({0, 0, 0}, {0, 0, s}, {s, 0, 0}, material);  // +y
    b.quad({0, s, 0}, {s, 0, 0}, {0, 0, s}, material);  // -y
}

// All that leaves a point light stays in a closed room: 4 pi I, wherever the light is.
TEST(Photons, ClosedRoomGetsAllOfAPointLight)
{
    for (const glm::vec3 place : {glm::vec3(7.3f, 6.1f, 8.8f), glm::vec3(1.2f, 13.4f, 2.7f)}) {
        SceneBuilder b;
        add_room(b, b.material(lambert(0.5f)));
        b.point_light(place, {100.0f, 30.0f, 5.0f});
        const PhotonScene scene(b.build(), 256);
        const glm::dvec3 flux = scene.photons.total_flux();
        EXPECT_NEAR(flux.x, 4.0 * glm::pi<double>() * 100.0, 0.005 * 4.0 * glm::pi<double>() * 100.0);
        EXPECT_NEAR(flux.y / flux.x, 0.3, 1e-4);
        EXPECT_NEAR(flux.z / flux.x, 0.05, 1e-4);
    }
}

// A directional light gives E0 times the area that it sees; each face in the middle E0 cos.
TEST(Photons, PlaneGetsWhatItShowsToADirectionalLight)
{
    for (const glm::vec3 direction : {glm::vec3(0, 0, -1), glm::normalize(glm::vec3(0.3f, 0.5f, -1.0f))}) {
        SceneBuilder b;
        b.quad({0, 0, 5}, {kSide - 1, 0, 0}, {0, kSide - 1, 0}, b.material(lambert(0.5f)));
        b.directional_light(direction, glm::vec3(3.0f));
        const PhotonScene scene(b.build(), 512);
        const double expected = 3.0 * -double(direction.z) * (kSide - 1) * (kSide - 1);
        EXPECT_NEAR(scene.photons.total_flux().x, expected, 0.005 * expected);
        const auto irradiance = scene.photons.irradiance().read<glm::vec4>();
        const auto entries = scene.voxels.faces.face_list().read<GLuint>();
        for (std::size_t i = 0; i < scene.voxels.faces.face_count(); ++i) {
            const GLuint x = entries[i] & 511u, y = entries[i] >> 9 & 511u;
            if (x == 0 || y == 0 || x == kSide - 1 || y == kSide - 1) continue;  // half voxels
            // About 30 x 30 texels a voxel; a row of them more or less is 3 %.
            EXPECT_NEAR(double(irradiance[i].x), -3.0 * double(direction.z), 0.08 * 3.0);
        }
    }
}

TEST(Photons, AreTheSameInEveryRun)
{
    SceneBuilder b;
    add_room(b, b.material(lambert(0.5f)));
    b.point_light({5, 9, 4}, glm::vec3(100.0f));
    const Scene source = b.build();
    const PhotonScene first(source, 256), second(source, 256);
    EXPECT_EQ(first.photons.irradiance().read<glm::vec4>(), second.photons.irradiance().read<glm::vec4>());
}

}  // namespace
}  // namespace conebook
