// Chapter 08: cone sets, and gathered light against closed forms.
#include "08_diffuse_cones/cone_sets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "cone_pipeline.hpp"
#include "program.hpp"
#include "scene_builder.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kCounts[] = {5, 6, 9, 16, 32};

// Mean of cos over directions uniform within half_angle of an axis, by the midpoint rule in (cos, azimuth).
double mean_cos_by_quadrature(glm::dvec3 axis, double half_angle)
{
    constexpr int kSteps = 100;
    const glm::dvec3 other = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 t = glm::normalize(glm::cross(axis, other));
    const glm::dvec3 b = glm::cross(axis, t);
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const double c = 1.0 - (1.0 - std::cos(half_angle)) * (i + 0.5) / kSteps, s = std::sqrt(1.0 - c * c);
            const double phi = 2.0 * kPi * (j + 0.5) / kSteps;
            sum += (c * axis + s * std::cos(phi) * t + s * std::sin(phi) * b).z;
        }
    return sum / (kSteps * kSteps);
}

glm::dvec3 axis_of(const glm::vec4& cone) { return glm::normalize(glm::dvec3(cone)); }

TEST(ConeSets, WeightsSumToOneAndDirectionsAreUnitAndAboveTheSurface)
{
    for (const int count : kCounts)
        for (const ConeTable table : {ConeTable::tilted, ConeTable::thesis, ConeTable::thesis_added})
            for (const int sets : {1, 4, 16}) {
                const ConeSet all = make_interleaved_cones(count, table, 0.0, sets);
                ASSERT_EQ(all.cones.size(), std::size_t(count * sets));
                for (int set = 0; set < sets; ++set) {
                    double weights = 0.0;
                    for (int i = 0; i < count; ++i) {
                        const glm::vec4& cone = all.cones[std::size_t(set * count + i)];
                        weights += double(cone.w);
                        EXPECT_NEAR(glm::length(glm::dvec3(cone)), 1.0, 1e-6);
                        EXPECT_GT(cone.z, 0.0f);
                        EXPECT_GT(cone.w, 0.0f);
                    }
                    EXPECT_NEAR(weights, 1.0, 1e-6) << count << " cones, set " << set << " of " << sets;
                }
            }
}

TEST(ConeSets, FirstMomentIsThatOfTheHemisphere)
{
    struct Case {
        int count, sets;
        double aperture_deg;  // of the cones; 0: as the set asks
    };
    // Not here: single sets of 9 and 32 cones with 60 degrees, whose innermost rings would have to be closer to the
    // normal than upright (moments 0.6644 and 0.6656).
    const Case cases[] = {{5, 1, 0}, {6, 1, 0},  {9, 1, 0},  {16, 1, 0},  {32, 1, 0},  {5, 1, 60}, {6, 1, 60},
                          {5, 16, 0}, {6, 16, 0}, {9, 16, 0}, {16, 16, 0}, {32, 16, 0}, {6, 4, 0},  {6, 16, 60},
                          {16, 16, 60}, {6, 1, 20}, {6, 16, 20}};
    for (const Case& c : cases) {
        const ConeSet all = make_interleaved_cones(c.count, ConeTable::tilted, glm::radians(c.aperture_deg), c.sets);
        double moment = 0.0;
        glm::dvec2 sideways(0.0);
        for (const glm::vec4& cone : all.cones) {
            moment += double(cone.w) * mean_cos_by_quadrature(axis_of(cone), double(all.half_angle_rad)) / c.sets;
            sideways += double(cone.w) * glm::dvec2(cone) / double(c.sets);
        }
        const std::string name = std::to_string(c.count) + " cones, " + std::to_string(c.sets) + " sets";
        EXPECT_NEAR(moment, 2.0 / 3.0, 1e-4) << name;
        EXPECT_NEAR(first_moment(all) / c.sets, moment, 1e-4) << name;
        // No side is preferred: measured 0.002 with 16 sets of 6 (0.1 degrees), 0.0085 with 4.
        EXPECT_LT(glm::length(sideways), c.sets == 4 ? 0.01 : 0.003) << name;
    }
}

TEST(ConeSets, ApertureIsTheOneAskedFor)
{
    for (const int sets : {1, 16})
        EXPECT_NEAR(double(make_interleaved_cones(6, ConeTable::tilted, glm::radians(50.0), sets).half_angle_rad),
                    glm::radians(25.0), 1e-6);
}

TEST(ConeSets, TheThesisTableIsReproducedAndItsMomentIsTooSmall)
{
    const ConeSet set = make_cone_set(6, ConeTable::thesis, 0.0);
    EXPECT_NEAR(double(set.half_angle_rad), kPi / 6, 1e-6);
    EXPECT_NEAR(double(set.cones[0].z), 1.0, 1e-6);
    EXPECT_NEAR(double(set.cones[0].w), 0.25, 1e-6);  // pi / 4 of pi
    for (int i = 1; i < 6; ++i) {
        const glm::vec4& cone = set.cones[std::size_t(i)];
        const glm::vec4& next = set.cones[std::size_t(i % 5 + 1)];
        EXPECT_NEAR(double(cone.z), 0.5, 1e-6);
        EXPECT_NEAR(double(cone.w), 0.15, 1e-6);  // 3 pi / 20 of pi
        // Regular pentagon: cos 72 degrees between neighbours, seen from above.
        EXPECT_NEAR(glm::dot(glm::dvec2(cone), glm::dvec2(next)) / 0.75, std::cos(glm::radians(72.0)), 1e-5);
    }
    // (1/4 + 5 * 3/20 * 1/2) (1 + cos 30) / 2 = 0.5831 instead of 0.6667
    EXPECT_NEAR(first_moment(set), 0.625 * (1.0 + std::cos(kPi / 6)) / 2.0, 1e-6);
}

ImageF picture_of(const std::string& arguments)
{
    const TemporaryFolder folder;
    const std::string output = "--headless --output '" + (folder / "o.exr").string() + "' ";
    const ProgramRun run = run_program("08_diffuse_cones", output + arguments);
    if (run.code != 0) throw std::runtime_error("08_diffuse_cones " + arguments + ": " + run.output);
    return read_exr(folder / "o.exr");
}
std::string asset(const std::string& name) { return "--scene '" + TestGl::root() + "/assets/" + name + ".glb' "; }

TEST(Parameters, WhatHasNoMeaningIsRefusedByName)
{
    const TemporaryFolder folder;
    const std::vector<std::string> all = {"cones=7", "cones=0", "aperture=180", "aperture=-1", "step=0", "step=nan",
                                          "step=-0.5", "start_offset=-1", "sky=-1", "sky=inf", "transmittance=wrong", "walk=wrong", "gather_scale=3",
                                          "ao_falloff=nan"};
    for (const std::string& bad : all) {
        const std::string output = (folder / "o.exr").string();
        const ProgramRun run =
            run_program("08_diffuse_cones", "--headless --size 16x16 --output '" + output + "' --set " + bad);
        EXPECT_NE(run.code, 0) << bad;
        EXPECT_LT(run.code, 128) << bad;
        EXPECT_NE(run.output.find(bad.substr(0, bad.find('='))), std::string::npos) << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
        EXPECT_FALSE(std::filesystem::exists(output)) << bad;
    }
}

// What the tolerances below were measured with, whatever the defaults are.
ConeParams usual()
{
    ConeParams params;
    params.start_offset = 0.75f;
    return params;
}

Scene furnace(const glm::mat3& rotation = glm::mat3(1.0f))
{
    SceneBuilder b;
    b.box(glm::vec3(-1), glm::vec3(1), b.material(emitter(0.5f, 0.5f)), true);
    b.transform(rotation);
    return b.build();
}
Camera inside_furnace() { return look_at({0.3f, 0.2f, 0.5f}, {-0.4f, -0.8f, -1}, 1.4f); }
ConeParams march_of(float step)
{
    ConeParams params = usual();
    params.walk = ConeWalk::march;
    params.step = step;
    return params;
}

// Every direction sees 0.5, so E / pi is 0.5 and, with rho = 0.5, one bounce adds 0.25.
TEST(Furnace, TheProgramGathersOneBounceExactly)
{
    const std::string arguments = "--size 128x128 --view indirect_diffuse --set voxels=64";
    const Spread s = spread_of(picture_of(asset("white_furnace") + arguments));
    EXPECT_NEAR(s.mean, 0.25, 0.02 * 0.25);
    EXPECT_LT(s.deviation, 0.03 * s.mean);
}

TEST(Furnace, DoesNotDependOnVoxelsOrStep)
{
    double low = INFINITY, high = 0.0;
    for (const int count : {32, 64, 128}) {
        ConePipeline pipeline(furnace(), inside_furnace(), {64, 64}, count);
        for (const ConeParams& params : {usual(), march_of(0.25f), march_of(0.5f), march_of(1.0f)}) {
            const std::string name = std::to_string(count) + " voxels, walk " + (params.walk == ConeWalk::march ? "march" : "leap") + ", step " +
                                     std::to_string(params.step);
            const Spread s = spread_of(pipeline.gathered(params));
            EXPECT_NEAR(s.mean, 0.5, 0.02 * 0.5) << name;
            EXPECT_LT(s.deviation, 0.03 * s.mean) << name;
            low = std::min(low, s.mean);
            high = std::max(high, s.mean);
        }
    }
    EXPECT_LT(high - low, 0.03 * high);
}

// Measured: 0.9995 upright, 0.992 to 0.995 rotated.
TEST(Furnace, MeansOfRotatedRoomsAgree)
{
    const glm::mat4 one(1.0f);
    const glm::mat3 rotations[] = {glm::mat3(1.0f), glm::mat3(glm::rotate(one, glm::radians(45.0f), {0, 1, 0})),
                                   glm::mat3(glm::rotate(one, 1.1f, glm::normalize(glm::vec3(0.3f, -0.8f, 0.5f)))),
                                   glm::mat3(glm::rotate(one, 2.3f, glm::normalize(glm::vec3(-0.7f, 0.1f, 0.6f))))};
    for (const int count : {64, 128}) {
        double low = INFINITY, high = 0.0;
        for (const glm::mat3& rotation : rotations) {
            ConePipeline pipeline(furnace(rotation), inside_furnace(), {64, 64}, count);
            const Spread s = spread_of(pipeline.gathered(usual()));
            EXPECT_LT(s.deviation, 0.03 * s.mean);
            low = std::min(low, s.mean);
            high = std::max(high, s.mean);
        }
        EXPECT_LT(high - low, 0.02 * high) << count << " voxels";
    }
}

// Nothing but the floor itself could send light to the floor: the true indirect light is 0.
TEST(Floor, AloneIsNotLitByItself)
{
    for (const float tilt_rad : {0.0f, 0.3f, 0.7f}) {
        const glm::mat3 rotation(glm::rotate(glm::mat4(1.0f), tilt_rad, glm::normalize(glm::vec3(1, 0, 0.4f))));
        SceneBuilder b;
        b.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, b.material(lambert(0.8f)));
        b.directional_light({0, -1, 0}, glm::vec3(float(kPi)));
        b.transform(rotation);
        ConePipeline pipeline(b.build(), look_at(rotation * glm::vec3(0, 3, 0.1f), {0, 0, 0}, 1.0f), {64, 64}, 128);
        // Direct radiance rho / pi * E = 0.8, indirect rho * gathered.
        const Spread s = spread_of(pipeline.gathered(usual()));
        EXPECT_LT(0.8 * s.mean, 0.03 * 0.8) << "tilted by " << tilt_rad;
    }
}

TEST(Floor, OpenToTheSkyGathersTheSky)
{
    SceneBuilder b;
    b.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, b.material(lambert(0.8f)));
    ConePipeline pipeline(b.build(), look_at({0, 3, 0.1f}, {0, 0, 0}, 1.0f), {64, 64}, 64);
    ConeParams params = usual();
    params.sky = 1.0f;
    const ImageF gathered = pipeline.gathered(params);
    EXPECT_NEAR(spread_of(gathered).low, 1.0, 0.002);
    EXPECT_NEAR(spread_of(gathered).high, 1.0, 0.002);
    EXPECT_NEAR(spread_of(gathered, 3).low, 1.0, 0.002);
}

// E = pi L R^2 / (R^2 + h^2) on the axis (Nusselt's analogue); a black ceiling keeps the disc off the scene's bounds. Cones
// meet a disc of a tenth of the scene by chance: narrow ones of 6 degrees 8 % too often at 0.8 m, these at most 3 %. Rays
// aimed at it do not leave it to chance (chapter 11).
TEST(ClosedForms, DiscAboveAPlane)
{
    for (const double height : {0.25, 0.5, 0.8}) {
        SceneBuilder b;
        b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(lambert(0.5f)));
        b.quad({-1, 1.5f, -1}, {2, 0, 0}, {0, 0, 2}, b.material(lambert(0.0f)));
        b.disc({0.1f, float(height), 0.05f}, {0, -1, 0}, 0.5f, b.material(emitter(1.0f)));
        ConePipeline pipeline(b.build(), at_point({0.11f, 0.1f, 0.05f}, {0.1f, 0, 0.05f}), {16, 16}, 128);
        const double expected = 0.25 / (0.25 + height * height);
        ConeParams params = usual();
        params.aperture = 10.0f;
        const double m = spread_of(pipeline.gathered(params)).mean;
        std::printf("height %.2f m: %.4f\n", height, m / expected);
        EXPECT_NEAR(m, expected, 0.05 * expected) << height;
    }
}

// Rectangle perpendicular to the floor, 4 wide and 4 high, seen from distance d of its middle (Howell C-3, twice); the
// limit at contact is E = pi L / 2. Measured: -2.4 to +3.7 %.
TEST(ClosedForms, PerpendicularWall)
{
    SceneBuilder b;
    b.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, b.material(lambert(0.5f)));
    b.quad({-2, 0, -2}, {4, 0, 0}, {0, 4, 0}, b.material(emitter(1.0f)));
    ConePipeline pipeline(b.build(), at_point({0, 1, 0}, {0, 0, 0}), {16, 16}, 128);
    for (const double distance_voxels : {0.02, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) {
        const double d = distance_voxels * pipeline.voxel_size_m(), slant = std::sqrt(d * d + 16.0);
        pipeline.look(at_point({0, 0.5f, float(d) - 1.7f}, {0, 0, float(d) - 2.0f}));
        const double expected = (std::atan(2.0 / d) - d / slant * std::atan(2.0 / slant)) / kPi;
        const double m = spread_of(pipeline.gathered(usual())).mean;
        EXPECT_NEAR(m, expected, 0.05 * expected) << distance_voxels << " voxels from the wall";
    }
}

// Required: 1 % of the lit side's radiance, direct light included (hard_cases/cones_test.cpp). This is against the indirect
// light alone, which is about half of it: measured 0.4 % through a wall one voxel thick, 1.3 and 1.0 % through a sheet at
// 64 and 128 voxels: cones that start within a voxel of the wall's edge begin in the lit room.
TEST(Leaks, LittleLightPassesAThinWall)
{
    for (const std::string& scene : std::vector<std::string>{"thin_wall", "thin_wall_solid"})
        for (const int count : {64, 128}) {
            const std::string rest = "--size 64x64 --view indirect_diffuse --set voxels=" + std::to_string(count);
            const double dark = spread_of(picture_of(asset(scene) + "--camera 0 " + rest)).mean;
            const double lit = spread_of(picture_of(asset(scene) + "--camera 1 " + rest)).mean;
            EXPECT_GT(lit, 0.05);
            EXPECT_LT(dark, (scene == "thin_wall" ? 0.015 : 0.01) * lit) << scene << ", " << count << " voxels";
        }
}

// Occlusion in double precision: the mean over cosine-weighted directions of 1 / (1 + lambda r) where a wall is hit. Two
// walls 2 m high at x = -2 and z = -2 on a floor from -2 to 2.
double corner_visibility(glm::dvec2 point_xz, double falloff)
{
    constexpr int kSteps = 400;
    double occlusion = 0.0;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const double sin2 = (i + 0.5) / kSteps, phi = 2.0 * kPi * (j + 0.5) / kSteps;
            const glm::dvec3 d(std::sqrt(sin2) * std::cos(phi), std::sqrt(1.0 - sin2), std::sqrt(sin2) * std::sin(phi));
            double nearest = INFINITY;
            for (int axis = 0; axis < 3; axis += 2) {
                const double t = (-2.0 - point_xz[axis / 2]) / d[axis];
                const double other = point_xz[1 - axis / 2] + t * d[2 - axis];
                if (t > 0.0 && t * d.y < 2.0 && std::abs(other) < 2.0) nearest = std::min(nearest, t);
            }
            if (nearest < INFINITY) occlusion += 1.0 / (1.0 + falloff * nearest);
        }
    return 1.0 - occlusion / (kSteps * kSteps);
}

TEST(AmbientOcclusion, InACornerIsThatOfRays)
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, grey);
    b.quad({-2, 0, -2}, {4, 0, 0}, {0, 2, 0}, grey);
    b.quad({-2, 0, 2}, {0, 0, -4}, {0, 2, 0}, grey);
    ConePipeline pipeline(b.build(), at_point({0, 1, 0}, {0, 0, 0}), {16, 16}, 128);
    for (const float falloff : {0.0f, 1.0f})
        for (const float out : {0.05f, 0.2f, 0.6f, 1.5f, 3.0f}) {
            const float at = out - 2.0f;
            pipeline.look(at_point({at + 0.2f, 0.5f, at + 0.1f}, {at, 0, at}));
            ConeParams params = usual();
            params.ao_falloff = falloff;
            const double m = spread_of(pipeline.gathered(params), 3).mean;
            const double expected = corner_visibility(glm::dvec2(double(at)), double(falloff));
            EXPECT_NEAR(m, expected, 0.05) << "falloff " << falloff << ", " << out << " m from the walls";
        }
}

TEST(AmbientOcclusion, AClosedRoomIsWhollyOccluded)
{
    ConePipeline pipeline(furnace(), inside_furnace(), {64, 64}, 64);
    ConeParams params = usual();
    params.ao_falloff = 0.0f;
    EXPECT_LT(spread_of(pipeline.gathered(params), 3).high, 0.01);
}

TEST(Extremes, NarrowAndWideConesAreFinite)
{
    ConePipeline pipeline(furnace(), inside_furnace(), {64, 64}, 64);
    for (const float aperture_deg : {0.1f, 179.0f})
        for (const Interleave interleave : {Interleave::on, Interleave::off}) {
            ConeParams params = usual();
            params.aperture = aperture_deg;
            params.interleave = interleave;
            const ImageF gathered = pipeline.gathered(params);
            for (const glm::vec4& pixel : gathered.pixels)
                for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(pixel[c])) << aperture_deg;
            // Whatever their width, cones in a closed room see walls of 0.5 and nothing else.
            EXPECT_NEAR(spread_of(gathered).mean, 0.5, 0.02 * 0.5) << aperture_deg;
        }
}

}  // namespace
}  // namespace conebook
