// Pieces, their voxels and rays against closed forms, double precision and the path tracer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "march_pipeline.hpp"
#include "program.hpp"
#include "reference/compare_images.hpp"
#include "reference/path_tracer.hpp"
#include "temporary_folder.hpp"
#include "test_shaders.hpp"

namespace conebook {
namespace {

constexpr int kPacked = int(Payload::packed), kOneSide = 1;
constexpr int kHitVoxel = 1, kFixed = 1, kRandom = 1;

// Mean and standard deviation over the covered pixels, red channel.
struct Over {
    double mean = 0.0, deviation = 0.0, low = INFINITY, high = -INFINITY;
    int pixels = 0;
};
Over over(const ImageF& image)
{
    Over o;
    double squares = 0.0;
    for (const glm::vec4& p : image.pixels) {
        if (p.a < 0.5f) continue;
        ++o.pixels;
        o.mean += double(p.r);
        squares += double(p.r) * double(p.r);
        o.low = std::min(o.low, double(p.r));
        o.high = std::max(o.high, double(p.r));
    }
    o.mean /= o.pixels;
    o.deviation = std::sqrt(std::max(squares / o.pixels - o.mean * o.mean, 0.0));
    return o;
}

// Every point its own, without sharing.
RayParams plain(int rays)
{
    RayParams p;
    p.rays = rays;
    p.scale = 1;
    p.blur = false;
    return p;
}

// A grid of unit voxels of 1 m whose first corner is the origin.
shared::GridData unit_grid(int n)
{
    shared::GridData grid{};
    grid.origin = glm::vec4(0, 0, 0, 1);
    grid.size = glm::ivec4(glm::ivec3(n), 1);
    grid.content_max = glm::vec4(glm::vec3(float(n)), 0);
    return grid;
}

// --- Pieces ---

// Of the pieces of a triangle: k^2 of them, whose centroids sum up to that of the triangle, all of one normal.
TEST(Pieces, AreAsManyAndLieAsTheFormulaSays)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(0.5f, 15.5f);
    for (int i = 0; i < 8; ++i) {
        const auto corner = [&] { return glm::vec3(place(random), place(random), place(random)); };
        const glm::vec3 a = corner(), b = corner(), c = corner();
        for (const float piece : {0.75f, 4.0f, 16.0f, 0.25f}) {
            SceneBuilder scene;
            scene.triangle(a, b, c, scene.material(emitter(1.0f)));
            MarchPipeline p(scene.build(), 16);
            p.in_grid(unit_grid(16), {}, piece);
            const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
            const double k = std::ceil(longest / double(piece) - 1e-4);
            ASSERT_EQ(double(p.list().count()), k * k) << "triangle " << i << " piece " << piece;
            glm::dvec3 sum(0.0);
            for (const Piece& q : p.pieces()) sum += glm::dvec3(q.centroid);
            EXPECT_LT(glm::length(sum / (k * k) - glm::dvec3(a + b + c) / 3.0), 1e-4);
        }
    }
}

// Legs of 30 voxels.
TEST(Pieces, ExerciseOfTheRightTriangle)
{
    SceneBuilder scene;
    scene.triangle({0.5f, 0.5f, 8.5f}, {30.5f, 0.5f, 8.5f}, {0.5f, 30.5f, 8.5f}, scene.material(emitter(1.0f)));
    MarchPipeline p(scene.build(), 16);
    p.in_grid(unit_grid(32));
    EXPECT_EQ(p.list().count(), 57u * 57u);
}

// A wall along the axes whose plane goes through the voxels: up to 0.75 voxels no voxel of it is empty, whatever its
// triangles; well above that some are.
TEST(Pieces, LeaveNoHoleInAWall)
{
    constexpr int kN = 24;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> inside(0.05f, 0.95f), turn(0.0f, 6.28f);
    for (const float piece : {0.75f, 0.6f, 2.0f}) {
        int empty = 0, asked = 0;
        for (int wall = 0; wall < 9; ++wall) {
            const int axis = wall % 3, u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
            const float height = 10.0f + inside(random), angle = turn(random);
            glm::vec3 u(0.0f), v(0.0f), middle(12.3f, 11.8f, 12.1f);
            u[u_axis] = 7.0f * std::cos(angle), u[v_axis] = 7.0f * std::sin(angle);
            v[u_axis] = -7.0f * std::sin(angle), v[v_axis] = 7.0f * std::cos(angle);
            middle[axis] = height;
            SceneBuilder scene;
            scene.quad(middle - u - v, 2.0f * u, 2.0f * v, scene.material(emitter(1.0f)));
            PieceVoxelParams one;
            one.sides = kOneSide;
            MarchPipeline p(scene.build(), kN);
            p.in_grid(unit_grid(kN), one, piece);
            const std::vector<GLuint> words = gl::read_uints(p.voxels().voxels());
            for (int b = 0; b < kN; ++b)
                for (int a = 0; a < kN; ++a) {
                    glm::ivec3 voxel;
                    voxel[axis] = int(height), voxel[u_axis] = a, voxel[v_axis] = b;
                    const glm::vec3 from =
                        glm::vec3(voxel) + 0.5f - middle;  // its middle lies on the wall: is it inside?
                    if (std::abs(glm::dot(from, u)) > 49.0f || std::abs(glm::dot(from, v)) > 49.0f) continue;
                    ++asked;
                    empty += words[std::size_t((voxel.z * kN + voxel.y) * kN + voxel.x)] == 0u ? 1 : 0;
                }
        }
        EXPECT_GT(asked, 1500);
        if (piece <= 0.75f)
            EXPECT_EQ(empty, 0) << "piece " << piece;
        else
            EXPECT_GT(empty, asked / 8) << "piece " << piece;
    }
}

// L = Le + rho / pi E, E of a lamp straight above and at 60 degrees.
TEST(Pieces, HoldTheLightThatLeavesThem)
{
    SceneBuilder scene;
    Material m = lambert({0.8f, 0.4f, 0.02f});
    m.emission = {0.25f, 0.0f, 3.0f};
    const glm::vec3 base(7.0f, 3.0f, 8.0f);
    scene.triangle(base, base + glm::vec3(0.02f, 0, 0), base + glm::vec3(0, 0, -0.02f), scene.material(m));
    scene.point_light(base + 2.0f * glm::vec3(std::sqrt(0.75f), 0.5f, 0.0f), glm::vec3(12.0f, 10.0f, 20.0f));
    MarchPipeline p(scene.build(), 16);
    p.in_grid(unit_grid(16));
    ASSERT_EQ(p.list().count(), 1u);
    const glm::vec3 expected =
        m.emission + glm::vec3(m.base_color) / std::numbers::pi_v<float> * glm::vec3(12.0f, 10.0f, 20.0f) / 4.0f * 0.5f;
    // The roots of albedos are kept in 1023 steps: half a step of 0.14 is 0.7 % of 0.02; the piece is 0.5 % of the
    // way wide.
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(p.pieces()[0].radiance[i], expected[i], 0.015f * expected[i]);
}

// --- Words ---

// The word that Ropret's packing, corrected, gives, in double precision.
std::uint32_t packed(glm::dvec3 c, glm::dvec3 n)
{
    const auto round = [](double x) { return std::uint32_t(std::floor(x + 0.5)); };
    std::uint32_t word = 1u << 31 | round(15.0 * glm::length(c) / std::sqrt(3.0)) << 27;
    for (int i = 0; i < 3; ++i)
        word |= round(31.0 * (0.5 * n[i] + 0.5)) << (12 + 5 * i) | round(15.0 * c[i]) << (4 * i);
    return word;
}

PieceVoxelParams document()
{
    PieceVoxelParams p;
    p.payload = kPacked;
    p.sides = kOneSide;
    return p;
}

// Small triangles of given light in voxels of their own, of which one is the brightest.
TEST(Words, AreThoseOfThePacking)
{
    SceneBuilder scene;
    const std::vector<glm::vec3> light = {{5, 2, 1}, {0, 0, 0}, {0.4f, 4.8f, 2.2f}, {5, 5, 5}};
    for (std::size_t i = 0; i < light.size(); ++i) {
        const glm::vec3 at(2.5f + 3.0f * float(i), 4.5f, 6.5f);
        scene.triangle(at, at + glm::vec3(0.1f, 0, 0), at + glm::vec3(0, 0.06f, 0.08f),
                       scene.material(emitter(light[i])));
    }
    MarchPipeline p(scene.build(), 16);
    p.in_grid(unit_grid(16), document());
    const std::vector<GLuint> words = gl::read_uints(p.voxels().voxels());
    for (std::size_t i = 0; i < light.size(); ++i) {
        const GLuint word = words[std::size_t((6 * 16 + 4) * 16) + 2u + 3u * i];
        EXPECT_EQ(word, packed(glm::dvec3(light[i]) / 5.0, {0.0, -0.8, 0.6})) << "triangle " << i;
        EXPECT_NE(word & 1u << 31, 0u) << "black is solid";
    }
    // White is the brightest there is, and stays within its four bits.
    EXPECT_EQ(words[std::size_t((6 * 16 + 4) * 16) + 11u] >> 27 & 15u, 15u);
    EXPECT_EQ(p.voxels().occupied(), 4u);
}

TEST(Words, TheBrighterOneStays)
{
    for (const int payload : {int(Payload::index), kPacked})
        for (const bool white_first : {false, true}) {
            SceneBuilder scene;
            for (const bool first : {true, false}) {
                const float light = first == white_first ? 1.0f : 0.3f;
                scene.triangle({2.2f, 2.5f, 2.5f}, {2.3f, 2.5f, 2.5f}, {2.2f, 2.6f, 2.5f},
                               scene.material(emitter(light)));
            }
            PieceVoxelParams params = document();
            params.payload = payload;
            params.winner = 1;
            MarchPipeline p(scene.build(), 8);
            p.in_grid(unit_grid(8), params);
            const GLuint word = gl::read_uints(p.voxels().voxels())[(2 * 8 + 2) * 8 + 2];
            if (payload == kPacked)
                EXPECT_EQ(word & 15u, 15u);
            else
                EXPECT_EQ(p.pieces()[word & 0xFFFFFFu].radiance.r, 1.0f);
        }
}

Scene soup(unsigned shuffle)
{
    std::mt19937 random(3), order(shuffle);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    struct Part {
        glm::vec3 a, b, c, light;
    };
    std::vector<Part> parts;
    for (int i = 0; i < 400; ++i) {
        const glm::vec3 at = vector();
        parts.push_back({at, at + 0.2f * vector(), at + 0.2f * vector(), vector()});
    }
    if (shuffle > 0) std::shuffle(parts.begin(), parts.end(), order);
    SceneBuilder scene;
    for (const Part& p : parts) scene.triangle(p.a, p.b, p.c, scene.material(emitter(p.light)));
    return scene.build();
}

TEST(Words, DoNotDependOnTheOrderOfTriangles)
{
    for (const int sides : {0, kOneSide}) {
        PieceVoxelParams params = document();
        params.sides = sides;
        MarchPipeline first(soup(0), 32, params);
        EXPECT_GT(first.voxels().occupied(), 2000u);
        for (const unsigned shuffle : {1u, 2u}) {
            MarchPipeline other(soup(shuffle), 32, params);
            EXPECT_EQ(gl::read_uints(first.voxels().voxels()), gl::read_uints(other.voxels().voxels()));
            EXPECT_EQ(gl::read_uints(first.voxels().sides()), gl::read_uints(other.voxels().sides()));
        }
    }
}

// --- Rays ---

// xyz: directions of 30 rays each of 4096 points, w: their cosines.
std::vector<glm::vec4> directions(glm::vec3 normal, int sequence, float spread)
{
    TestShaders test;
    const gl::Program program = test.shaders->load({"tests/march_directions.comp"});
    constexpr std::size_t kRays = 30 * 4096;
    const gl::Buffer out("directions", kRays * sizeof(glm::vec4));
    out.bind(GL_SHADER_STORAGE_BUFFER, 0);
    program.use();
    program.set("normal", normal);
    program.set("ray_count", 30);
    program.set("spread", spread);
    program.set("random_rays", sequence);
    glDispatchCompute(gl::group_count(kRays, 64), 1, 1);
    return out.read<glm::vec4>();
}

TEST(Rays, AreDistributedAsTheCosine)
{
    for (const int sequence : {0, kRandom})
        for (const glm::vec3 normal : {glm::vec3(0, 0, 1), glm::normalize(glm::vec3(-0.3f, 0.9f, -0.2f))}) {
            const std::vector<glm::vec4> all = directions(normal, sequence, 1.0f);
            double mean = 0.0, square = 0.0;
            glm::dvec3 side(0.0);
            for (const glm::vec4& d : all) {
                mean += double(d.w) / double(all.size());
                square += double(d.w) * double(d.w) / double(all.size());
                side += glm::dvec3(d) / double(all.size());
                ASSERT_NEAR(glm::length(glm::vec3(d)), 1.0f, 1e-5f);
            }
            // Standard errors: sqrt(1/2 - 4/9) and sqrt(1/3 - 1/4), over the root of 122,880: 0.0007 and 0.0008.
            EXPECT_NEAR(mean, 2.0 / 3.0, 0.0025) << sequence;
            EXPECT_NEAR(square, 0.5, 0.0025) << sequence;
            EXPECT_LT(glm::length(side - mean * glm::dvec3(normal)), 0.004) << sequence;
        }
}

// A cone of 30 degrees half angle: w = 1/2, mean cosine 1 - w^2 / 3.
TEST(Rays, ExerciseOfTheCone)
{
    double mean = 0.0;
    const std::vector<glm::vec4> all = directions({0, 0, 1}, 0, 0.5f);
    for (const glm::vec4& d : all) {
        mean += double(d.w) / double(all.size());
        ASSERT_GT(double(d.w), std::cos(std::numbers::pi / 6.0) - 1e-5);
    }
    EXPECT_NEAR(mean, 1.0 - 0.25 / 3.0, 0.0005);
}

// Le and rho of 0.5 in a closed room of any turn: with one bounce the room has 1 - 2^-2, so that E / pi is Le.
TEST(Rays, OneBounceInAFurnace)
{
    for (const float angle : {0.0f, 0.4f, 0.785f}) {
        SceneBuilder scene;
        scene.box({-1, -1, -1}, {1, 1, 1}, scene.material(emitter(0.5f, 0.5f)), true);
        const float c = std::cos(angle), s = std::sin(angle);
        scene.transform(glm::mat3(c, s * c, s * s, -s, c * c, s * c, 0, -s, c));  // about two axes
        MarchPipeline p(scene.build(), 48);
        const Over o = over(p.gathered(look_at({0.1f, 0, 0.1f}, {1, 0.2f, -0.5f}, 1.5f), {32, 32}, plain(64)));
        EXPECT_EQ(o.pixels, 32 * 32);
        EXPECT_NEAR(0.5 + 0.5 * o.mean, 1.0 - std::exp2(-2.0), 0.005) << "turned by " << angle;
    }
}

// A sphere that shines with 1 from within. Rays at angle t come from where they arrive at angle t again, after 2 R
// cos t.
TEST(Rays, FactorsOfASphere)
{
    constexpr float kR = 1.0f;
    SceneBuilder scene;
    scene.sphere({0, 0, 0}, kR, scene.material(emitter(1.0f)), 48, true);
    MarchPipeline p(scene.build(), 64);
    const auto mean = [&](const RayParams& params) {
        return over(p.gathered(look_at({0, 0, 0}, {1, 0.3f, 0.2f}, 1.5f), {24, 24}, params)).mean;
    };
    RayParams params = plain(100);
    EXPECT_NEAR(mean(params), 1.0, 0.01);
    params.facing = int(Facing::cosine);
    EXPECT_NEAR(mean(params), 2.0 / 3.0, 0.01);
    params.facing = int(Facing::back_faces);
    params.falloff = 1;
    for (const int steps : {80, 200}) {
        params.steps = steps;
        const double range_m = steps * double(params.step) * double(p.grid().voxel_size_m());
        const double q = 2.0 * double(kR) / range_m;
        ASSERT_LT(q, 1.0);
        EXPECT_NEAR(mean(params), 1.0 - 4.0 / 3.0 * q + 0.5 * q * q, 0.01) << "steps " << steps;
    }
}

struct Line {
    glm::vec4 origin, direction;
};

// Isotropic lines that meet a cube of one voxel. Of a chord c, steps of s meet min(c / s, 1).
TEST(Rays, FixedStepsMissVoxels)
{
    SceneBuilder scene;
    scene.triangle({8.45f, 8.45f, 8.5f}, {8.55f, 8.45f, 8.5f}, {8.45f, 8.55f, 8.5f}, scene.material(emitter(1.0f)));
    MarchPipeline p(scene.build(), 17);
    p.in_grid(unit_grid(17));
    ASSERT_EQ(p.voxels().occupied(), 1u);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Line> lines;
    for (int i = 0; i < 400000; ++i) {
        const double z = 2.0 * unit(random) - 1.0, turn = 2.0 * std::numbers::pi * unit(random);
        const glm::dvec3 d(std::sqrt(1.0 - z * z) * std::cos(turn), std::sqrt(1.0 - z * z) * std::sin(turn), z);
        const glm::dvec3 u =
            glm::normalize(glm::cross(d, std::abs(z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
        const double r = 0.87 * std::sqrt(unit(random)), a = 2.0 * std::numbers::pi * unit(random);
        const glm::dvec3 middle = glm::dvec3(8.5) + r * (std::cos(a) * u + std::sin(a) * glm::cross(d, u));
        // Where the steps fall must not depend on where the voxel is.
        lines.push_back({glm::vec4(glm::vec3(middle - (4.0 + 4.0 * unit(random)) * d), 0), glm::vec4(glm::vec3(d), 0)});
    }
    TestShaders test;
    const gl::Buffer in("lines", lines), out("arrived", lines.size() * sizeof(glm::vec4));
    const auto met = [&](int fixed, float step) {
        gl::Defines defines = p.voxels().defines();
        defines.insert({{"FIXED_STEPS", std::to_string(fixed)}, {"ON_PLANE", "0"}, {"FACING", "2"}, {"FALLOFF", "0"}});
        const gl::Program program = test.shaders->load({"tests/march_lines.comp"}, defines);
        program.use();
        p.voxels().bind(program);
        program.set("steps", 200);
        program.set("step_length", step);
        in.bind(GL_SHADER_STORAGE_BUFFER, 0);
        out.bind(GL_SHADER_STORAGE_BUFFER, 1);
        glDispatchCompute(gl::group_count(lines.size(), 64), 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        double sum = 0.0;
        for (const glm::vec4& light : out.read<glm::vec4>()) sum += double(light.r);
        return sum;
    };
    const double all = met(0, 1.0f);
    // A cube's mean shadow is a quarter of its surface; of a disc of radius 0.87 that is this share.
    EXPECT_NEAR(all / double(lines.size()), 1.5 / (std::numbers::pi * 0.87 * 0.87), 0.003);
    EXPECT_NEAR(met(1, 0.25f) / all, 0.897, 0.004);
    EXPECT_NEAR(met(1, 0.5f) / all, 0.801, 0.004);
    EXPECT_NEAR(met(1, 1.0f) / all, 0.628, 0.004);
    EXPECT_NEAR(met(1, 2.0f) / all, 2.0 / (3.0 * 2.0), 0.004);
}

// A lit floor alone receives nothing from itself, however it lies. The document's voxels light it.
TEST(Rays, APlaneDoesNotLightItself)
{
    for (const float tilt : {0.0f, 0.1f, 0.35f, 0.785f}) {
        SceneBuilder scene;
        scene.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, scene.material(emitter(1.0f)));
        const float c = std::cos(tilt), s = std::sin(tilt);
        scene.transform(glm::mat3(c, s, 0, -s * c, c * c, s, s * s, -s * c, c));
        MarchPipeline p(scene.build(), 64);
        const Camera above = look_at({0, 1.2f, 0.02f}, {0, 0, 0}, 0.8f);
        EXPECT_EQ(over(p.gathered(above, {32, 32}, plain(32))).high, 0.0) << "tilt " << tilt;
        RayParams published = plain(32);
        published.hit = kHitVoxel;
        published.facing = int(Facing::none);
        EXPECT_GT(over(p.gathered(above, {32, 32}, published)).mean, 0.02) << "tilt " << tilt;
    }
}

// Behind a wall of zero thickness and of one voxel nothing is seen of the bright side.
TEST(Rays, WallsLetNothingThrough)
{
    for (const bool sheet : {false, true})
        for (const float turn : {0.0f, 0.3f, 0.785f}) {
            SceneBuilder scene;
            const int black = scene.material(lambert(0.0f)), bright = scene.material(emitter(1.0f));
            scene.box({-1, -1, -1}, {0, 1, 1}, bright, true);
            scene.box({sheet ? 0.0f : 0.04f, -1, -1}, {1, 1, 1}, black, true);
            const float c = std::cos(turn), s = std::sin(turn);
            scene.transform(glm::mat3(c, s, 0, -s, c, 0, 0, 0, 1));
            MarchPipeline p(scene.build(), 64);
            const glm::vec3 x(c, s, 0);
            const Over dark = over(p.gathered(look_at(0.5f * x, x, 1.5f), {32, 32}, plain(32)));
            EXPECT_LT(dark.mean, 0.01) << "sheet " << sheet << " turned by " << turn;
            const Over lit = over(p.gathered(look_at(-0.5f * x, -x, 1.5f), {32, 32}, plain(32)));
            EXPECT_NEAR(lit.mean, 1.0, 0.02) << "sheet " << sheet << " turned by " << turn;
        }
}

// A room half bright, half dark: noise of random rays falls with their root, that of the lattice faster.
TEST(Rays, NoiseFallsWithTheRootOfTheirNumber)
{
    SceneBuilder scene;
    const int dark = scene.material(lambert(0.5f)), bright = scene.material(emitter(1.0f));
    for (int face = 0; face < 6; ++face) scene.box_face({-1, -1, -1}, {1, 1, 1}, face, face == 3 ? bright : dark, true);
    MarchPipeline p(scene.build(), 32);
    const Camera camera = look_at({0, 0, 0.9f}, {0, -0.9f, -0.9f}, 0.3f);
    constexpr int kSide = 32;
    const ImageF truth = p.gathered(camera, glm::ivec2(kSide), plain(1024));
    const auto noise = [&](int rays, int sequence) {
        RayParams params = plain(rays);
        params.sequence = sequence;
        const ImageF image = p.gathered(camera, glm::ivec2(kSide), params);
        double squares = 0.0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            squares += std::pow(double(image.pixels[i].r - truth.pixels[i].r), 2.0) / (kSide * kSide);
        return std::sqrt(squares);
    };
    // 1024 pixels know their deviation to 1 / sqrt(2048): the slope to 0.015.
    const double few = noise(4, kRandom), many = noise(64, kRandom);
    EXPECT_NEAR(std::log(many / few) / std::log(16.0), -0.5, 0.05);
    EXPECT_LT(noise(64, 0), 0.85 * many);
}

TEST(Rays, ManyAreTheSumOfSeveralDraws)
{
    // 1000 rays are more than a draw traces; their mean is that of the furnace all the same.
    SceneBuilder scene;
    scene.box({-1, -1, -1}, {1, 1, 1}, scene.material(emitter(0.5f, 0.5f)), true);
    MarchPipeline p(scene.build(), 16);
    const Over o = over(p.gathered(look_at({0, 0, 0}, {1, 0.2f, -0.5f}, 1.5f), {8, 8}, plain(1000)));
    EXPECT_NEAR(o.mean, 0.5, 0.005);
}

// --- The whole ---

// One bounce on the book's default scene at 128 voxels and 30 rays, over blocks of 4 x 4 pixels; and with many rays,
// where what is left is no noise.
TEST(RayMarching, IsNearThePathTracer)
{
    const TemporaryFolder folder;
    const Scene scene = load_scene(asset("cornell_box"));
    PathTraceOptions options;
    options.width = options.height = 128;
    options.spp = 100;
    options.bounces = 1;
    options.parts = {Part::indirect_diffuse};
    const ImageF truth = path_trace(scene, choose_camera(scene, {}), options).pictures[0];
    const auto against = [&](const std::string& settings) {
        const std::filesystem::path picture = folder / "picture.exr";
        const ProgramRun run =
            run_program("18_voxel_ray_marching", "--headless --size 128x128 --view indirect_diffuse --output '" +
                                                     picture.string() + "' --set " + settings);
        EXPECT_EQ(run.code, 0) << run.output;
        CompareOptions blocks;
        blocks.block = 4;
        return compare_images(read_exr(picture), truth, blocks);
    };
    const ImageMetrics thirty = against("rays=30");
    // Measured at 256 x 256: 0.997 and 0.035.
    EXPECT_NEAR(thirty.signed_ratio, 1.0, 0.05);
    EXPECT_LT(thirty.smape, 0.06);
    // The document's choices: much too dark or too bright.
    const ImageMetrics published = against(
        "rays=30 payload=packed sides=one hit=voxel facing=none falloff=window "
        "march=fixed step=1 steps=60 min_distance=1");
    EXPECT_GT(std::abs(published.signed_ratio - 1.0), 0.1);
    EXPECT_GT(published.smape, 2.0 * thirty.smape);
}

TEST(RayMarching, MeaninglessParametersAreRefused)
{
    const TemporaryFolder folder;
    const std::filesystem::path picture = folder / "picture.png";
    for (const char* wrong : {"rays=0", "bounces=2", "payload=both", "piece=0", "min_distance=-1", "scale=3", "cube=41",
                              "time=-1", "spread=nan"}) {
        const ProgramRun run = run_program("18_voxel_ray_marching", std::string("--headless --size 16x16 --output '") +
                                                                        picture.string() + "' --set " + wrong);
        EXPECT_NE(run.code, 0) << wrong;
        EXPECT_LT(run.code, 128) << wrong;
        const std::string name = std::string(wrong).substr(0, std::string(wrong).find('='));
        EXPECT_NE(run.output.find(name), std::string::npos) << run.output;
        EXPECT_FALSE(std::filesystem::exists(picture)) << wrong;
    }
}

}  // namespace
}  // namespace conebook
