// The scenes of assets/: the committed files are what the generator writes, and their geometry is what they claim.
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/constants.hpp>

#include "scene/scene.hpp"

namespace {

namespace fs = std::filesystem;
using conebook::Scene;

constexpr std::array scene_names = {"cornell_box",     "cornell_area", "cornell_empty", "white_furnace",
                                    "thin_wall",       "lights",       "glossy_room",   "emissive_shapes",
                                    "thin_wall_solid", "materials",    "colonnade",     "door",
                                    "walking_lamp",    "spinning_shapes", "figure"};

fs::path from_environment(const char* name) {
    const char* value = std::getenv(name);
    if (value == nullptr) {
        throw std::runtime_error(std::string(name) + " is not set; run through ctest");
    }
    return value;
}

fs::path asset(const std::string& name) { return from_environment("CONEBOOK_ROOT") / "assets" / (name + ".glb"); }

std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::set<std::string> glb_names(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == ".glb") {
            names.insert(entry.path().filename().string());
        }
    }
    return names;
}

struct Triangle {
    std::array<glm::dvec3, 3> position;
    std::array<glm::dvec3, 3> normal;
    const conebook::Material* material = nullptr;
    const conebook::Draw* draw = nullptr;
    // Twice the area times the unit normal of the front face.
    glm::dvec3 cross() const { return glm::cross(position[1] - position[0], position[2] - position[0]); }
};

// All triangles, with positions in world space.
std::vector<Triangle> triangles_of(const Scene& scene) {
    std::vector<Triangle> triangles;
    for (const conebook::Draw& draw : scene.draws) {
        for (std::uint32_t i = 0; i < draw.index_count; i += 3) {
            Triangle triangle;
            for (std::uint32_t corner = 0; corner < 3; ++corner) {
                const conebook::Vertex& vertex = scene.vertices.at(scene.indices.at(draw.first_index + i + corner));
                triangle.position[corner] = glm::dvec3(vertex.position) + scene.origin_ws;
                triangle.normal[corner] = glm::dvec3(vertex.normal);
            }
            triangle.material = &scene.materials.at(static_cast<std::size_t>(draw.material));
            triangle.draw = &draw;
            triangles.push_back(triangle);
        }
    }
    return triangles;
}

// Nearest triangle along the ray (Moeller and Trumbore 1997), edges included; null when there is none.
const Triangle* nearest_hit(const std::vector<Triangle>& triangles, glm::dvec3 origin, glm::dvec3 direction) {
    constexpr double edge = 1e-9;
    const Triangle* nearest = nullptr;
    double nearest_t = 1e30;
    for (const Triangle& triangle : triangles) {
        const glm::dvec3 e1 = triangle.position[1] - triangle.position[0];
        const glm::dvec3 e2 = triangle.position[2] - triangle.position[0];
        const glm::dvec3 p = glm::cross(direction, e2);
        const double determinant = glm::dot(e1, p);
        if (std::abs(determinant) < 1e-14) {
            continue;
        }
        const glm::dvec3 s = origin - triangle.position[0], q = glm::cross(s, e1);
        const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
        const double t = glm::dot(e2, q) / determinant;
        if (u >= -edge && v >= -edge && u + v <= 1.0 + edge && t > 1e-9 && t < nearest_t) {
            nearest_t = t;
            nearest = &triangle;
        }
    }
    return nearest;
}

// Volume enclosed by the triangles (divergence theorem); positive when the fronts face outwards.
double signed_volume(const std::vector<Triangle>& triangles, const std::string& draw_name) {
    double volume = 0.0;
    for (const Triangle& t : triangles) {
        if (t.draw->name == draw_name) {
            volume += glm::dot(t.position[0], glm::cross(t.position[1], t.position[2])) / 6.0;
        }
    }
    return volume;
}

const conebook::Material& material_named(const Scene& scene, const std::string& name) {
    for (const conebook::Material& material : scene.materials) {
        if (material.name == name) {
            return material;
        }
    }
    throw std::runtime_error("no material " + name);
}

TEST(Assets, GeneratorWritesTheCommittedFiles) {
    const fs::path folder = fs::temp_directory_path() / ("conebook_assets_" + std::to_string(getpid()));
    fs::create_directories(folder);
    const std::string command =
        std::string("'") + (from_environment("CONEBOOK_BIN") / "make_assets").string() + "' '" + folder.string() + "' > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const fs::path committed = from_environment("CONEBOOK_ROOT") / "assets";
    EXPECT_EQ(glb_names(folder), glb_names(committed));
    for (const std::string& name : glb_names(folder)) {
        EXPECT_TRUE(bytes_of(folder / name) == bytes_of(committed / name)) << name << ": run make_assets";
    }
    fs::remove_all(folder);
}

TEST(Assets, GeneratorRefusesAFolderThatIsNotThere) {
    const std::string command =
        std::string("'") + (from_environment("CONEBOOK_BIN") / "make_assets").string() + "' /no/such/folder > /dev/null 2>&1";
    EXPECT_NE(std::system(command.c_str()), 0);
}

TEST(Assets, ListedHereAndUnderOneMegabyte) {
    std::set<std::string> expected;
    for (const char* name : scene_names) {
        expected.insert(std::string(name) + ".glb");
        EXPECT_LT(fs::file_size(asset(name)), 1000000u) << name;
    }
    EXPECT_EQ(glb_names(from_environment("CONEBOOK_ROOT") / "assets"), expected);
}

class EveryAsset : public testing::TestWithParam<const char*> {};

TEST_P(EveryAsset, LoadsWithoutWarningAndHasACamera) {
    const Scene scene = conebook::load_scene(asset(GetParam()));
    EXPECT_EQ(scene.warnings, std::vector<std::string>());
    EXPECT_FALSE(scene.has_default_light);
    EXPECT_GE(scene.cameras.size(), 1u);
    EXPECT_GT(scene.triangle_count(), 0u);
}

TEST_P(EveryAsset, NormalsAgreeWithWinding) {
    const Scene scene = conebook::load_scene(asset(GetParam()));
    for (const Triangle& triangle : triangles_of(scene)) {
        const double doubled_area = glm::length(triangle.cross());
        ASSERT_GT(doubled_area, 1e-7) << "degenerate triangle in " << triangle.draw->name;
        for (const glm::dvec3& normal : triangle.normal) {
            ASSERT_NEAR(glm::length(normal), 1.0, 1e-5);
            ASSERT_GT(glm::dot(normal, triangle.cross()), 0.0) << triangle.draw->name;
        }
    }
}

TEST_P(EveryAsset, NoTwoTrianglesCoincide) {
    const Scene scene = conebook::load_scene(asset(GetParam()));
    std::set<std::set<std::array<double, 3>>> seen;
    for (const Triangle& triangle : triangles_of(scene)) {
        std::set<std::array<double, 3>> corners;
        for (const glm::dvec3& p : triangle.position) {
            corners.insert({p.x, p.y, p.z});
        }
        ASSERT_TRUE(seen.insert(corners).second) << triangle.draw->name;
    }
}

// Whatever a camera sees, it sees from the front: nothing is inside out, and no camera stands inside a solid.
TEST_P(EveryAsset, CamerasSeeFrontFaces) {
    const Scene scene = conebook::load_scene(asset(GetParam()));
    const std::vector<Triangle> triangles = triangles_of(scene);
    for (const conebook::Camera& camera : scene.cameras) {
        const double tangent = std::tan(0.5 * camera.y_fov);
        int hits = 0;
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 24; ++x) {
                const glm::dvec4 direction_cs((2.0 * (x + 0.47) / 24.0 - 1.0) * tangent,
                                              (1.0 - 2.0 * (y + 0.53) / 24.0) * tangent, -1.0, 0.0);
                const glm::dmat4 world_from_camera(camera.world_from_camera);
                const glm::dvec3 direction = world_from_camera * direction_cs;
                const glm::dvec3 origin = glm::dvec3(world_from_camera[3]) + scene.origin_ws;
                if (const Triangle* hit = nearest_hit(triangles, origin, direction)) {
                    ++hits;
                    ASSERT_TRUE(hit->material->double_sided || glm::dot(hit->cross(), direction) < 0.0)
                        << camera.name << " sees the back of " << hit->draw->name;
                }
            }
        }
        EXPECT_GT(hits, 24 * 24 / 3) << camera.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Assets, EveryAsset, testing::ValuesIn(scene_names),
                         [](const auto& info) { return std::string(info.param); });

struct ClosedRoom {
    const char* name;
    glm::dvec3 inside;  // a free point of the room, world space
};

class ClosedRooms : public testing::TestWithParam<ClosedRoom> {};

// Every ray from the inside ends on a surface that faces it.
TEST_P(ClosedRooms, WallsFaceInwardsWithoutGap) {
    const Scene scene = conebook::load_scene(asset(GetParam().name));
    const std::vector<Triangle> triangles = triangles_of(scene);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int ray = 0; ray < 2000; ++ray) {
        const glm::dvec3 direction(uniform(random), uniform(random), uniform(random));
        const Triangle* hit = nearest_hit(triangles, GetParam().inside, direction);
        ASSERT_NE(hit, nullptr) << "ray " << ray << " leaves the room";
        ASSERT_TRUE(hit->material->double_sided || glm::dot(hit->cross(), direction) < 0.0) << hit->draw->name;
    }
}

INSTANTIATE_TEST_SUITE_P(Assets, ClosedRooms,
                         testing::Values(ClosedRoom{"white_furnace", {0.1, 0.2, -0.3}},
                                         ClosedRoom{"thin_wall", {-0.9, 1.1, 0.1}},
                                         ClosedRoom{"thin_wall", {0.9, 1.1, 0.1}},
                                         ClosedRoom{"thin_wall_solid", {-0.9, 1.1, 0.1}},
                                         ClosedRoom{"thin_wall_solid", {0.9, 1.1, 0.1}},
                                         ClosedRoom{"glossy_room", {0.1, 1.2, 0.2}},
                                         ClosedRoom{"door", {-0.9, 1.1, 0.1}},
                                         ClosedRoom{"door", {0.9, 1.1, 0.1}},
                                         ClosedRoom{"walking_lamp", {0.4, 1.2, 0.4}},
                                         ClosedRoom{"emissive_shapes", {0.1, 1.2, 0.2}}));

TEST(Assets, WhiteFurnaceIsWatertightAndConvergesToOne) {
    const Scene scene = conebook::load_scene(asset("white_furnace"));
    const std::vector<Triangle> triangles = triangles_of(scene);
    // Vertices welded by position: every directed edge occurs once, and so does its reverse.
    using Point = std::array<double, 3>;
    std::map<std::pair<Point, Point>, int> directed_edges;
    for (const Triangle& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 a = triangle.position[corner], b = triangle.position[(corner + 1) % 3];
            ++directed_edges[{Point{a.x, a.y, a.z}, Point{b.x, b.y, b.z}}];
        }
    }
    for (const auto& [edge, count] : directed_edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(directed_edges.count({edge.second, edge.first}), 1u);
    }
    EXPECT_NEAR(signed_volume(triangles, "wall"), -8.0, 1e-9);  // negative: the walls face inwards
    EXPECT_TRUE(scene.lights.empty());
    for (const Triangle& triangle : triangles) {
        // L = Le / (1 - rho) = 1 in a closed room of one Lambert material.
        EXPECT_EQ(triangle.material->specular, 0.0f);
        EXPECT_EQ(triangle.material->metallic, 0.0f);
        for (int c = 0; c < 3; ++c) {
            EXPECT_FLOAT_EQ(triangle.material->emission[c] / (1.0f - triangle.material->base_color[c]), 1.0f);
        }
    }
}

TEST(Assets, ThinWallsAreAsThickAsTheySay) {
    for (const auto& [name, thickness] : {std::pair("thin_wall", 0.0), std::pair("thin_wall_solid", 4.0 / 64.0)}) {
        const Scene scene = conebook::load_scene(asset(name));
        EXPECT_FLOAT_EQ(scene.bounds.longest_side(), 4.0f);
        double low = 1e30, high = -1e30;
        for (const Triangle& triangle : triangles_of(scene)) {
            if (triangle.draw->name == "divider") {
                EXPECT_EQ(triangle.material->double_sided, thickness == 0.0);
                for (const glm::dvec3& p : triangle.position) {
                    low = std::min(low, p.x);
                    high = std::max(high, p.x);
                }
            }
        }
        EXPECT_EQ(high - low, thickness) << name;
        EXPECT_EQ(high + low, 0.0) << name;
    }
}

// The emitters' solids face outwards and have the volumes of their shapes. A polyhedron inscribed in a smooth body of
// these tessellations (32 x 16 and 48 x 20 segments) lacks under 3 % of its volume.
TEST(Assets, EmittersAreSolidsOfTheirSize) {
    const Scene scene = conebook::load_scene(asset("emissive_shapes"));
    const std::vector<Triangle> triangles = triangles_of(scene);
    const double pi = glm::pi<double>();
    const double sphere = 4.0 / 3.0 * pi * 0.25 * 0.25 * 0.25, torus = 2.0 * pi * pi * 0.25 * 0.07 * 0.07;
    EXPECT_NEAR(signed_volume(triangles, "sphere"), sphere, 0.03 * sphere);
    EXPECT_NEAR(signed_volume(triangles, "torus"), torus, 0.03 * torus);
    EXPECT_NEAR(signed_volume(triangles, "cube"), 0.06 * 0.06 * 0.06, 1e-8);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_FLOAT_EQ(material_named(scene, "cube").emission.r, 200.0f);
    EXPECT_FLOAT_EQ(material_named(scene, "sphere").emission.g, 0.5f);
    EXPECT_GE(material_named(scene, "panel").emission_texture.image, 0);
}

// The PNG writer against another reader (libpng): known texels come back.
TEST(Assets, TexturesDecode) {
    const Scene scene = conebook::load_scene(asset("colonnade"));
    const conebook::Material& floor = material_named(scene, "floor");
    const conebook::Material& lattice = material_named(scene, "lattice");
    ASSERT_GE(floor.normal_texture.image, 0);
    ASSERT_GE(lattice.base_color_texture.image, 0);
    const conebook::Image& normals = scene.images.at(static_cast<std::size_t>(floor.normal_texture.image));
    ASSERT_EQ(normals.width, 96);
    ASSERT_EQ(normals.height, 96);
    for (std::size_t i = 0; i < normals.rgba.size(); i += 4) {
        const glm::dvec3 n = glm::dvec3(normals.rgba[i], normals.rgba[i + 1], normals.rgba[i + 2]) / 127.5 - 1.0;
        ASSERT_NEAR(glm::length(n), 1.0, 0.01);  // rounding to 8 bits: at most sqrt(3) / 2 / 127.5 = 0.007
        ASSERT_GT(n.z, 0.0);
    }
    EXPECT_EQ(lattice.alpha_mode, conebook::AlphaMode::mask);
    EXPECT_TRUE(lattice.double_sided);
    const conebook::Image& bars = scene.images.at(static_cast<std::size_t>(lattice.base_color_texture.image));
    ASSERT_EQ(bars.width, 64);
    // Each of the two families of bars takes 9 of 32 diagonals: 5 of the 16 even and 4 of the 16 odd ones. x + y and
    // x - y have the same parity, so the holes are ((11/16)^2 + (12/16)^2) / 2 of the sheet.
    double opaque = 0.0;
    for (std::size_t i = 3; i < bars.rgba.size(); i += 4) {
        ASSERT_TRUE(bars.rgba[i] == 0 || bars.rgba[i] == 255);
        opaque += bars.rgba[i] == 255;
    }
    EXPECT_DOUBLE_EQ(opaque / (64.0 * 64.0), 1.0 - (121.0 + 144.0) / 512.0);
}

}  // namespace
