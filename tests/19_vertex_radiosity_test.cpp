// Vertex radiosity against closed forms: form factors, flux that is kept, the reduction on the CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lit_patches.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

constexpr double kPiD = std::numbers::pi;

// What the patches of `scene` get of one disc.
std::vector<glm::vec3> lit_by(const Lit& lit, const std::vector<shared::PatchLight>& lights, FormFactor form_factor)
{
    std::vector<LightNode> nodes;
    for (const shared::PatchLight& light : lights) nodes.push_back({light, 0, 0, true});
    RadiosityMap map(test_gl().shaders);
    map.clear(int(lit.radiosity.mesh().patches.size()));
    map.add_indirect(lit.radiosity.buffers(), nodes,
                     sight_of(lit.radiosity.tracer(), lit.radiosity.mesh().patches, nodes, 0.0f), form_factor, true);
    return lit.irradiance(map.indirect());
}

// --- Form factors

// A floor of one small triangle below a disc: on its axis at height h, E = Phi / (pi (h^2 + R^2)) exactly.
TEST(FormFactors, OnTheAxisOfADiscExact)
{
    SceneBuilder b;
    b.triangle({-1e-3f, 0, 1e-3f}, {1e-3f, 0, 1e-3f}, {0, 0, -2e-3f}, b.material(lambert(0.5f)));
    const Lit lit(b.build(), with(1.0f, 0));
    for (const double h : {0.1, 0.5, 2.0, 10.0})
        for (const double radius : {0.05, 0.5, 3.0}) {
            const shared::PatchLight disc{{0, h, 0, kPiD * radius * radius}, {0, -1, 0, 0}, {3, 2, 1, 0}};
            const double exact = 3.0 / (kPiD * (h * h + radius * radius));
            EXPECT_NEAR(lit_by(lit, {disc}, FormFactor::exact)[0].x, exact, 2e-3 * exact) << h << " " << radius;
            // Published: 2 cos cos of what the disc sends per area.
            const double area = kPiD * radius * radius;
            const double ratio = double(lit_by(lit, {disc}, FormFactor::published)[0].x) / exact;
            EXPECT_NEAR(ratio, 2.0 * (kPiD * h * h + area) / area, 4e-3 * ratio);
            // Far away, where the disc is a point: 2 pi r^2 / A.
            if (h > 10.0 * radius) {
                EXPECT_NEAR(ratio, 2.0 * kPiD * h * h / area, 0.02 * ratio);
            }
        }
}

// Every patch of one face of a cube is a light; what the others get of its flux is the form factor.
TEST(FormFactors, BetweenTheFacesOfACube)
{
    // Three faces are enough: that of the lights, the opposite one, one beside. 56 x 56 squares each.
    SceneBuilder b;
    const int white = b.material(lambert(0.5f));
    b.quad({0.5f, -0.5f, -0.5f}, {0, 0, 1}, {0, 1, 0}, white, 56);
    b.quad({-0.5f, -0.5f, -0.5f}, {0, 1, 0}, {0, 0, 1}, white, 56);
    b.quad({-0.5f, -0.5f, -0.5f}, {0, 0, 1}, {1, 0, 0}, white, 56);
    const Lit lit(b.build(), with(1.0f, 0));
    const PatchMesh& mesh = lit.radiosity.mesh();
    std::vector<shared::PatchLight> lights;
    double flux = 0.0;
    for (const shared::Patch& patch : mesh.patches) {
        if (patch.normal.x > -0.5f) continue;
        lights.push_back({patch.position, patch.normal, glm::vec4(patch.position.w)});
        flux += double(patch.position.w);
    }
    const auto e = lit_by(lit, lights, FormFactor::exact);
    double opposite = 0.0, beside = 0.0;
    for (std::size_t i = 0; i < e.size(); ++i) {
        const double arriving = double(mesh.patches[i].position.w) * double(e[i].x) / flux;
        (mesh.patches[i].normal.x > 0.5f ? opposite : beside) += arriving;
    }
    RecordProperty("cube_opposite", std::to_string(opposite));
    RecordProperty("cube_adjacent", std::to_string(beside));
    EXPECT_NEAR(opposite, 0.199825, 0.01 * 0.199825);
    EXPECT_NEAR(beside, 0.200044, 0.01 * 0.200044);
}

// From every point of a sphere every other is seen under the same form factor: E = Phi / (4 pi R^2), but for the clamp.
TEST(FormFactors, InsideASphereConstant)
{
    SceneBuilder b;
    b.sphere(glm::vec3(0.0f), 1.0f, b.material(lambert(0.6f)), 24, true);
    b.point_light({0, 0, 0}, glm::vec3(1.0f));
    VertexRadiosityParams params = with(1.0f);
    params.pick.cells = 8;
    params.near = 0.0f;
    const Lit lit(b.build(), params);
    const auto direct = lit.direct(), indirect = lit.indirect();
    const PatchMesh& mesh = lit.radiosity.mesh();
    for (std::size_t i = 0; i < direct.size(); ++i) {
        const glm::dvec3 p(mesh.patches[i].position), n(mesh.patches[i].normal);
        ASSERT_NEAR(direct[i].x, -glm::dot(p, n) * std::pow(glm::dot(p, p), -1.5), 1e-4);  // I cos / d^2
        double expected = 0.0;  // sum of Phi / (4 pi R^2) times what the clamp leaves
        for (const PickedLight& picked : lit.radiosity.second()) {
            const double squared = double(glm::dot(glm::vec3(picked.light.position - mesh.patches[i].position),
                                                   glm::vec3(picked.light.position - mesh.patches[i].position)));
            const double left = kPiD * squared / (kPiD * squared + double(picked.light.position.w));
            expected += double(picked.light.flux.x) / (4.0 * kPiD) * left;
        }
        ASSERT_NEAR(indirect[i].x, expected, 0.03 * expected) << i;
        ASSERT_NEAR(indirect[i].x, 0.6, 0.06);  // rho 4 pi I / (4 pi R^2)
    }
}

// --- Flux

// In a closed room all of the light's flux is met, and all of what a bounce sends.
TEST(Flux, ClosedRoomKeepsItsShare)
{
    const glm::vec3 light(3.0f, 2.0f, 1.0f);
    const float rho = 0.6f;
    SceneBuilder b = room(rho);
    b.point_light({0.3f, 0.2f, -0.4f}, light);
    for (const Pick pick : {Pick::maximum, Pick::flux}) {
        VertexRadiosityParams params = with(0.25f, 2);
        params.pick.pick = pick;
        params.pick.cells = 8;
        params.further.rays = 1;
        const Lit lit(b.build(), params);
        const glm::dvec3 first = double(rho) * 4.0 * kPiD * glm::dvec3(light);
        const glm::dvec3 second = total_flux(lit.radiosity.second()), third = total_flux(lit.radiosity.third());
        EXPECT_EQ(lit.radiosity.second().size(), 6u * 64u);
        EXPECT_EQ(lit.radiosity.third().size(), 6u * 64u);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(second[c], first[c], 1e-4 * first[c]);
            EXPECT_NEAR(third[c], double(rho) * first[c], 1e-4 * first[c]);
        }
    }
}

TEST(Flux, SpotAndDirectionalLight)
{
    SceneBuilder b;
    b.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, b.material(lambert(0.5f)));
    b.quad({-1, 1, 1}, {0, 0, -2}, {2, 0, 0}, b.material(lambert(0.5f)));  // turned down: a back that stops light
    b.directional_light({0, -1, 0}, glm::vec3(2.0f));
    b.spot_light({3, 2, 0}, {0, -1, 0}, glm::vec3(5.0f), 0.0f, 0.5f);
    VertexRadiosityParams params = with(0.5f);
    params.pick.m = 512;
    params.pick.cells = 8;
    const Lit lit(b.build(), params);
    double sun = 0.0, spot = 0.0;
    for (const PickedLight& picked : lit.radiosity.second())
        (glm::length(picked.incoming - glm::vec3(0, -1, 0)) < 1e-6f ? sun : spot) += double(picked.light.flux.x);
    // 64 - 4 m^2 of floor; the sheet reflects nothing. 1 % is a row of texels at the edge.
    EXPECT_NEAR(sun, 0.5 * 2.0 * 60.0, 0.01 * 60.0);
    // I ((cos t - cos b) / (1 - cos b))^2 over the cone: 2 pi I (1 - cos b) / 3.
    const double cone = 2.0 * kPiD * 5.0 * (1.0 - std::cos(0.5)) / 3.0;
    EXPECT_NEAR(spot, 0.5 * cone, 0.005 * cone);
}

TEST(Flux, DroppedBordersLose28Of64CellsAndTheirLight)
{
    SceneBuilder b = room(0.5f);
    b.point_light({0, 0, 0}, glm::vec3(1.0f));
    VertexRadiosityParams params = with(0.25f);
    params.pick.cells = 8;
    params.pick.borders = Borders::drop;
    const Lit lit(b.build(), params);
    EXPECT_EQ(lit.radiosity.second().size(), 6u * 36u);
    // Solid angle of the inner square |x|, |y| < 3/4 of the face (appendix: atan(xy / sqrt(1 + x^2 + y^2)), four
    // corners).
    const double t = 0.75, kept = 6.0 * 4.0 * std::atan(t * t / std::sqrt(1.0 + 2.0 * t * t));
    const double flux = total_flux(lit.radiosity.second()).x;
    RecordProperty("borders_kept_percent", std::to_string(100.0 * kept / (4.0 * kPiD)));
    EXPECT_NEAR(flux, 0.5 * kept, 1e-4 * kept);
}

// Light from a surface is the first indirect bounce, and none with bounces=0.
TEST(Flux, EmittersAreLightsWithAllTheirFlux)
{
    SceneBuilder b = room(0.5f);
    b.quad({-0.5f, 0.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, b.material(emitter(2.0f)));
    for (const int most : {4, 16, 4096}) {
        VertexRadiosityParams params = with(0.1f);
        params.further.emitter_lights = most;
        const Lit lit(b.build(), params);
        EXPECT_LE(int(lit.radiosity.second().size()), most + 1);
        EXPECT_NEAR(total_flux(lit.radiosity.second()).x, 2.0 * kPiD, 1e-4);
        for (const PickedLight& picked : lit.radiosity.second()) {
            glm::dvec3 parts(0.0);
            for (const PickedLight& part : picked.parts) parts += glm::dvec3(part.light.flux);
            if (!picked.parts.empty()) {
                EXPECT_NEAR(parts.x, picked.light.flux.x, 1e-5);
            }
        }
    }
    const Lit dark(b.build(), with(0.1f, 0));
    for (const glm::vec3& e : dark.indirect()) ASSERT_EQ(e.x, 0.0f);
}

// --- The reduction

TEST(Reduction, IsThatOfTheCpuBitForBit)
{
    SceneBuilder b = room(0.5f);
    b.box({-0.3f, -1, -0.3f}, {0.2f, 0, 0.3f}, b.material(lambert({0.2f, 0.6f, 0.9f})));
    b.point_light({0.3f, 0.2f, -0.4f}, {3, 2, 1});
    VertexRadiosityParams params = with(0.25f);
    params.pick.pick = Pick::maximum;
    params.pick.cells = 8;
    Lit lit(b.build(), params);
    for (int view = 0; view < 6; ++view) {
        const LightPicker* picker = lit.radiosity.look(lit.gpu, view);
        ASSERT_NE(picker, nullptr);
        ASSERT_EQ(picker->levels().size(), 4u);  // 64, 32, 16, 8
        for (std::size_t level = 1; level < 4; ++level) {
            const auto& before = picker->levels()[level - 1];
            const auto& after = picker->levels()[level];
            const auto c = gl::read_floats(before.chosen, 0, 4), n = gl::read_floats(before.normal_energy, 0, 4),
                       f = gl::read_floats(before.flux_area, 0, 4);
            const auto c2 = gl::read_floats(after.chosen, 0, 4), n2 = gl::read_floats(after.normal_energy, 0, 4),
                       f2 = gl::read_floats(after.flux_area, 0, 4);
            const int side = after.chosen.size().x;
            int moved = 0;
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x) {
                    std::size_t from[4], best = 0;
                    for (int k = 0; k < 4; ++k)
                        from[k] = 4 * std::size_t((2 * y + (k >> 1)) * 2 * side + 2 * x + (k & 1));
                    for (std::size_t k = 1; k < 4; ++k) {
                        const float energy = n[from[k] + 3], most = n[from[best] + 3];
                        if (energy > most || (energy == most && c[from[k] + 3] > c[from[best] + 3])) best = k;
                    }
                    moved += best != 0;
                    const std::size_t to = 4 * std::size_t(y * side + x);
                    for (std::size_t i = 0; i < 4; ++i) {
                        ASSERT_EQ(c2[to + i], c[from[best] + i]);
                        ASSERT_EQ(n2[to + i], n[from[best] + i]);
                        ASSERT_EQ(f2[to + i], (f[from[0] + i] + f[from[1] + i]) + (f[from[2] + i] + f[from[3] + i]));
                    }
                }
            EXPECT_GT(moved, 0);
        }
    }
}

// --- The whole

// White furnace: E = pi Le (rho + rho^2 + ...) / rho after so many bounces.
TEST(Whole, FurnaceGainsItsShareWithEachBounce)
{
    SceneBuilder b;
    b.box(glm::vec3(-1), glm::vec3(1), b.material(emitter(0.5f, 0.5f)), true);
    double before = 0.0;
    for (const int bounces : {1, 2, 4, -1}) {
        const Lit lit(b.build(), with(0.13f, bounces));
        const auto e = lit.indirect();
        double mean = 0.0;
        for (std::size_t i = 0; i < e.size(); ++i)
            mean += double(e[i].x) * double(lit.radiosity.mesh().patches[i].position.w) / 24.0;
        const double exact = kPiD * (bounces < 0 ? 1.0 : 1.0 - std::pow(0.5, bounces));
        RecordProperty("furnace_" + std::to_string(bounces), std::to_string(mean / exact));
        EXPECT_NEAR(mean, exact, 0.12 * exact) << bounces;  // what the clamp takes in corners
        EXPECT_GT(mean, before);
        before = mean;
    }
}

// A shadow's edge is as sharp as the triangles: the error of direct light falls with max_edge.
TEST(Whole, ErrorOfDirectLightFallsWithMaxEdge)
{
    const TemporaryFolder folder;
    const auto picture = [&](const std::string& program, const std::string& arguments) {
        const std::filesystem::path file = folder / "x.exr";
        const ProgramRun run = run_program(program, "--size 96x96 --output '" + file.string() + "' " + arguments);
        EXPECT_EQ(run.code, 0) << run.output;
        return read_exr(file);
    };
    // Exact shadows: the maps of chapter 03, which have texels of 2 mm.
    const ImageF exact = picture("03_shadow_map", "--headless --view direct");
    double last = 1.0;
    for (const char* max_edge : {"0.5", "0.25", "0.12", "0.06"}) {
        const ImageF image = picture("19_vertex_radiosity",
                                     std::string("--headless --view direct --set bounces=0 max_edge=") + max_edge);
        double error = 0.0, sum = 0.0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            error += std::abs(double(image.pixels[i].g) - double(exact.pixels[i].g));
            sum += double(exact.pixels[i].g);
        }
        RecordProperty(std::string("direct_error_") + max_edge, std::to_string(error / sum));
        EXPECT_LT(error / sum, 0.8 * last) << max_edge;
        last = error / sum;
    }
    EXPECT_LT(last, 0.03);
}

TEST(Whole, SameBitsOnEveryRun)
{
    SceneBuilder b = room(0.5f);
    b.point_light({0.3f, 0.2f, -0.4f}, {3, 2, 1});
    const VertexRadiosityParams params = with(0.25f, -1);
    const Lit one(b.build(), params), other(b.build(), params);
    EXPECT_EQ(one.indirect(), other.indirect());
    EXPECT_EQ(one.direct(), other.direct());
}

// What a parameter changes is what passes draw that were made with it.
TEST(Whole, ParametersActLive)
{
    SceneBuilder b = room(0.5f);
    b.quad({-0.5f, 0.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, b.material(emitter(2.0f)));
    b.point_light({0.3f, 0.2f, -0.4f}, {3, 2, 1});
    VertexRadiosityParams start = with(0.4f, 2);
    start.pick.cells = 8;
    start.further.emitter_lights = 8;
    Lit lit(b.build(), start);
    const auto run = [](const char*, Scope, const std::function<bool()>& work) { work(); };
    const std::vector<std::pair<const char*, std::function<void(VertexRadiosityParams&)>>> changes{
        {"max_edge", [](auto& p) { p.mesh.max_edge = 0.6f; }},
        {"m", [](auto& p) { p.pick.m = 32; }},
        {"cells", [](auto& p) { p.pick.cells = 4; }},
        {"pick", [](auto& p) { p.pick.pick = Pick::maximum; }},
        {"borders", [](auto& p) { p.pick.borders = Borders::drop; }},
        {"emitter_lights", [](auto& p) { p.further.emitter_lights = 3; }},
        {"ray", [](auto& p) { p.further.ray = RayDirection::mirror; }},
        {"rays", [](auto& p) { p.further.rays = 3; }},
        {"bounces", [](auto& p) { p.bounces = 1; }},
        {"steps", [](auto& p) { p.steps = 1; }},
        {"near", [](auto& p) { p.near = 0.0f; }},
        {"form_factor", [](auto& p) { p.form_factor = FormFactor::published; }},
        {"half_texel", [](auto& p) { p.half_texel = false; }}};
    const auto before = lit.indirect();
    for (const auto& [name, change] : changes) {
        lit.p = start;
        change(lit.p);
        lit.radiosity.run(run, lit.gpu);
        const auto after = lit.indirect();
        EXPECT_NE(after, before) << name;
        const Lit fresh(lit.scene, lit.p);
        EXPECT_EQ(after, fresh.indirect()) << name;
        EXPECT_EQ(lit.direct(), fresh.direct()) << name;
        lit.p = start;
        lit.radiosity.run(run, lit.gpu);
        EXPECT_EQ(lit.indirect(), before) << name;
    }
    int ran = 0;
    lit.radiosity.run([&](const char*, Scope, const std::function<bool()>& work) { ran += work(); }, lit.gpu);
    EXPECT_EQ(ran, 0) << "nothing has changed";
}

TEST(Whole, MeaninglessParametersAreRefused)
{
    const TemporaryFolder folder;
    const std::filesystem::path picture = folder / "picture.png";
    for (const char* wrong :
         {"max_edge=-1", "max_edge=0.0005", "m=48", "cells=3", "pick=first", "borders=wrap", "steps=4", "bounces=-2",
          "rays=-1", "ray=up", "near=-1", "form_factor=none", "emitter_lights=0"}) {
        const ProgramRun run = run_program("19_vertex_radiosity", std::string("--headless --size 16x16 --output '") +
                                                                      picture.string() + "' --set " + wrong);
        EXPECT_NE(run.code, 0) << wrong;
        EXPECT_LT(run.code, 128) << wrong;
        const std::string name = std::string(wrong).substr(0, std::string(wrong).find('='));
        EXPECT_NE(run.output.find(name), std::string::npos) << run.output;
        EXPECT_FALSE(std::filesystem::exists(picture)) << wrong;
    }
    const ProgramRun run = run_program(
        "19_vertex_radiosity", "--headless --size 16x16 --output '" + picture.string() + "' --set m=16 cells=32");
    EXPECT_NE(run.code, 0);
    EXPECT_NE(run.output.find("cells=32"), std::string::npos) << run.output;
}

}  // namespace
}  // namespace conebook
