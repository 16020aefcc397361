// Chapter 09: the directional albedo against quadrature, reflections against geometry and the path tracer.
#include "09_specular_cones/directional_albedo.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "cone_pipeline.hpp"
#include "program.hpp"
#include "reference/compare_images.hpp"
#include "reference/path_tracer.hpp"
#include "temporary_folder.hpp"
#include "voxel_pipeline.hpp"

namespace conebook {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kTableSize = 32, kTableSamples = 2048;  // as SpecularCones has them

// The same two integrals without importance sampling by visible normals: midpoints over microfacet normals, with
// tan^2 = alpha^2 u / (1 - u), which makes D cos dh = du dphi / 2 pi (Walter et al. 2007, eq. 35), and the visibility
// term of Heitz 2014, eq. 99, as the shader writes it. dl = 4 (v.h) dh.
glm::dvec2 albedo_by_quadrature(double n_dot_v, double alpha)
{
    constexpr int kNormals = 1500, kAzimuths = 600;
    const glm::dvec3 v(std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
    const double a2 = alpha * alpha;
    glm::dvec2 sum(0.0);
    for (int i = 0; i < kNormals; ++i) {
        const double u = (i + 0.5) / kNormals, tan2 = a2 * u / (1.0 - u), cos_h = 1.0 / std::sqrt(1.0 + tan2);
        const double sin_h = std::sqrt(std::max(0.0, 1.0 - cos_h * cos_h));
        for (int j = 0; j < kAzimuths; ++j) {
            const double phi = kPi * (j + 0.5) / kAzimuths;  // half: the other half is its mirror image
            const glm::dvec3 h(sin_h * std::cos(phi), sin_h * std::sin(phi), cos_h);
            const double v_dot_h = glm::dot(v, h);
            const glm::dvec3 l = 2.0 * v_dot_h * h - v;
            if (v_dot_h <= 0.0 || l.z <= 0.0) continue;
            const double visibility = 0.5 / (l.z * std::sqrt(n_dot_v * n_dot_v * (1.0 - a2) + a2) +
                                             n_dot_v * std::sqrt(l.z * l.z * (1.0 - a2) + a2));
            const double grazing = std::pow(1.0 - v_dot_h, 5.0);
            sum += visibility * 4.0 * v_dot_h * l.z / cos_h * glm::dvec2(1.0 - grazing, grazing);
        }
    }
    return sum / double(kNormals * kAzimuths);
}

TEST(DirectionalAlbedo, AgreesWithQuadrature)
{
    for (const double roughness : {0.1, 0.3, 0.6, 1.0})
        for (const double n_dot_v : {0.1, 0.4, 0.8, 0.99}) {
            const double alpha = roughness * roughness;
            const glm::dvec2 expected = albedo_by_quadrature(n_dot_v, alpha);
            const glm::dvec2 a = directional_albedo(n_dot_v, alpha, 4096);
            // What a metal (F0 0.9) and a dielectric (F0 0.04) make of it.
            for (const double f0 : {0.9, 0.04}) {
                const double exact = f0 * expected.x + expected.y;
                EXPECT_NEAR(f0 * a.x + a.y, exact, 0.005 * exact) << "roughness " << roughness << ", n.v " << n_dot_v;
            }
        }
}

TEST(DirectionalAlbedo, SmoothMetalReflectsByFresnelAlone)
{
    for (const double n_dot_v : {0.2, 0.6, 1.0}) {
        const glm::dvec2 a = directional_albedo(n_dot_v, 1e-4, 256);
        const double grazing = std::pow(1.0 - n_dot_v, 5.0);
        EXPECT_NEAR(a.x, 1.0 - grazing, 1e-3);
        EXPECT_NEAR(a.y, grazing, 1e-3);
    }
}

// What a voxel sends on of the light that falls on it from all sides: rho, and the lobe's mean over the cosine. The
// shader's polynomials are within 0.003 of x and 0.0005 of y, 0.0035 together; the rest is this quadrature's.
TEST(DirectionalAlbedo, VoxelsReflectItsMean)
{
    for (const float roughness : {0.03f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f})
        for (const float metallic : {0.0f, 0.5f, 1.0f}) {
            Material m;  // dielectric of F0 0.04, or metal
            m.base_color = glm::vec4(0.8f, 0.5f, 0.2f, 1.0f);
            m.metallic = metallic;
            m.roughness = roughness;
            SceneBuilder b;
            b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(m));
            constexpr int kSteps = 128;
            glm::dvec2 mean(0.0);  // 2 integral of albedo(c) c dc
            for (int i = 0; i < kSteps; ++i) {
                const double c = (i + 0.5) / kSteps;
                mean += 2.0 * c / kSteps * directional_albedo(c, double(roughness) * double(roughness), 1024);
            }
            VoxelPipeline pipeline(b.build(), 8);
            ASSERT_FALSE(pipeline.faces().empty());
            for (const LitFace& face : pipeline.faces())
                for (int channel = 0; channel < 3; ++channel) {
                    const double base = double(m.base_color[channel]), metal = double(metallic);
                    const double f0 = 0.04 * (1.0 - metal) + base * metal;
                    const double expected = base * (1.0 - metal) + f0 * mean.x + mean.y;
                    EXPECT_NEAR(face.mean.albedo_area[channel], expected, 0.005)
                        << "roughness " << roughness << " metallic " << metallic;
                }
        }
}

TEST(DirectionalAlbedo, TheTableHoldsIt)
{
    const std::vector<glm::vec2> table = directional_albedo_table(kTableSize, kTableSamples);
    ASSERT_EQ(table.size(), std::size_t(kTableSize * kTableSize));
    double worst_entry = 0.0, worst_between = 0.0;
    for (int row = 1; row + 1 < kTableSize; row += 3)
        for (int column = 1; column + 1 < kTableSize; column += 3) {
            const auto entry = [&](int c, int r) { return glm::dvec2(table[std::size_t(r * kTableSize + c)]); };
            const double roughness = double(row) / (kTableSize - 1), n_dot_v = double(column) / (kTableSize - 1);
            const glm::dvec2 exact = directional_albedo(n_dot_v, roughness * roughness, 16384);
            const glm::dvec2 found = entry(column, row);
            // Half way to the next entries, as a linear filter reads it.
            const double r = (row + 0.5) / (kTableSize - 1), c = (column + 0.5) / (kTableSize - 1);
            const glm::dvec2 exact_between = directional_albedo(c, r * r, 16384);
            const glm::dvec2 between = 0.25 * (entry(column, row) + entry(column + 1, row) + entry(column, row + 1) +
                                               entry(column + 1, row + 1));
            for (const double f0 : {0.9, 0.04}) {
                const double e = f0 * exact.x + exact.y, b = f0 * exact_between.x + exact_between.y;
                worst_entry = std::max(worst_entry, std::abs(f0 * found.x + found.y - e) / e);
                worst_between = std::max(worst_between, std::abs(f0 * between.x + between.y - b) / b);
            }
        }
    EXPECT_LT(worst_entry, 0.005);
    EXPECT_LT(worst_between, 0.01);
}

// Unit direction of a pixel's middle, and where it meets a sphere around the origin (NaN when it misses).
glm::dvec3 pixel_direction(const Camera& camera, int x, int y, int size)
{
    const double scale = std::tan(0.5 * double(camera.y_fov));
    const glm::dvec3 d((2.0 * (x + 0.5) / size - 1.0) * scale, (1.0 - 2.0 * (y + 0.5) / size) * scale, -1.0);
    return glm::normalize(glm::dmat3(camera.world_from_camera) * d);
}

struct FurnaceError {
    double facing = 0.0, all = 0.0;  // mean of rendered / directional albedo - 1, where n.v > 0.6 and > 0.15
    int facing_pixels = 0, all_pixels = 0;
};
// A metal ball of F0 0.9 in surroundings of radiance 1 must show its directional albedo at every pixel.
FurnaceError furnace_error(ConePipeline& pipeline, const Camera& camera, const ConeParams& params, double radius,
                           double roughness, int size)
{
    const ImageF image = pipeline.reflected(params);
    const glm::dvec3 eye(camera.world_from_camera[3]);
    FurnaceError error;
    for (int y = 0; y < size; y += 2)
        for (int x = 0; x < size; x += 2) {
            const glm::dvec3 d = pixel_direction(camera, x, y, size);
            const double b = glm::dot(eye, d), c = glm::dot(eye, eye) - radius * radius, root = b * b - c;
            if (root <= 0.0) continue;
            const double n_dot_v = -glm::dot((eye + (-b - std::sqrt(root)) * d) / radius, d);
            if (n_dot_v < 0.15) continue;  // the silhouette of the facetted ball is not that of the sphere
            const glm::dvec2 a = directional_albedo(n_dot_v, roughness * roughness, 64);
            const double ratio = double(image.at(x, y).x) / (0.9 * a.x + a.y);
            error.all += ratio - 1.0;
            ++error.all_pixels;
            if (n_dot_v > 0.6) error.facing += ratio - 1.0, ++error.facing_pixels;
        }
    error.all /= std::max(error.all_pixels, 1);
    error.facing /= std::max(error.facing_pixels, 1);
    return error;
}

TEST(Furnace, MetalsOfAnyRoughnessShowTheirAlbedo)
{
    constexpr int kSize = 64;
    for (const float roughness : {0.03f, 0.2f, 0.5f, 0.8f, 1.0f}) {
        SceneBuilder room, ball;
        for (SceneBuilder* b : {&room, &ball})
            b->sphere({0, 0, 0}, 0.4f, b->material(metal(glm::vec3(0.9f), roughness)), 64);
        room.box(glm::vec3(-1), glm::vec3(1), room.material(emitter(1.0f)), true);
        const Camera camera = look_at({0.1f, 0.2f, 0.95f}, {0, 0, 0}, 0.9f);
        ConeParams dark, sky;
        dark.start_offset = sky.start_offset = 0.75f;
        sky.sky = 1.0f;
        ConePipeline in_room(room.build(), camera, glm::ivec2(kSize), 64);
        ConePipeline under_sky(ball.build(), camera, glm::ivec2(kSize), 64);
        const FurnaceError closed = furnace_error(in_room, camera, dark, 0.4, double(roughness), kSize);
        const FurnaceError open = furnace_error(under_sky, camera, sky, 0.4, double(roughness), kSize);
        ASSERT_GT(closed.facing_pixels, 200);
        for (const FurnaceError& error : {closed, open}) {
            std::printf("roughness %.2f: facing %+.4f, all %+.4f\n", double(roughness), error.facing, error.all);
            EXPECT_LT(std::abs(error.facing), 0.02) << "roughness " << roughness;
            EXPECT_LT(std::abs(error.all), 0.02) << "roughness " << roughness;
        }
    }
}

// A mirror on the floor, an upright panel behind it: its image is where the mirrored panel would be.
TEST(Mirror, ShowsThePanelWhereItsImageIs)
{
    constexpr int kSize = 160;
    const double f0 = 0.95, radiance = 2.0;
    SceneBuilder b;
    b.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, b.material(metal(glm::vec3(float(f0)), 0.03f)));
    b.quad({-0.4f, 0.6f, -1}, {0.8f, 0, 0}, {0, 0.6f, 0}, b.material(emitter(float(radiance))));
    const Camera camera = look_at({0.2f, 1.0f, 1.8f}, {0, 0, 0.1f}, 0.8f);
    ConePipeline pipeline(b.build(), camera, glm::ivec2(kSize), 128);
    const ImageF image = pipeline.reflected({});
    const glm::dvec3 eye(camera.world_from_camera[3]);
    glm::dvec2 expected_middle(0.0), found_middle(0.0);
    double expected_sum = 0.0, found_sum = 0.0, inside = 0.0, inside_expected = 0.0, outside = 0.0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const glm::dvec3 d = pixel_direction(camera, x, y, kSize);
            if (d.y >= 0.0) continue;
            const glm::dvec3 p = eye - eye.y / d.y * d;
            if (std::abs(p.x) > 2.0 || std::abs(p.z) > 2.0) continue;
            // Before the panel's own picture hides the mirror.
            if (p.z < -1.0) continue;
            const double t = (-1.0 - p.z) / d.z;
            const glm::dvec2 hit(p.x + t * d.x, -t * d.y);
            // How far within the panel, m; negative outside.
            const double depth = t > 0.0 ? std::min(0.4 - std::abs(hit.x), 0.3 - std::abs(hit.y - 0.9)) : -1.0;
            const double albedo = f0 + (1.0 - f0) * std::pow(1.0 + d.y, 5.0), found = double(image.at(x, y).x);
            const double expected = depth > 0.0 ? albedo * radiance : 0.0;
            expected_sum += expected;
            found_sum += found;
            expected_middle += expected * glm::dvec2(x, y);
            found_middle += found * glm::dvec2(x, y);
            if (depth > 3.0 * pipeline.voxel_size_m()) inside += found, inside_expected += expected;
            if (depth < -4.0 * pipeline.voxel_size_m()) outside = std::max(outside, found);
        }
    expected_middle /= expected_sum;
    found_middle /= found_sum;
    // Less than a voxel, which is 2.6 pixels wide here. Measured: 1.2 to 2.0, since the cone starts above the mirror.
    EXPECT_LT(glm::length(found_middle - expected_middle), 2.6);
    EXPECT_NEAR(inside, inside_expected, 0.02 * inside_expected);
    EXPECT_NEAR(found_sum, expected_sum, 0.1 * expected_sum);
    EXPECT_LT(outside, 0.05 * radiance);
}

TEST(Lambert, ReflectsNothing)
{
    SceneBuilder b;
    b.box(glm::vec3(-1), glm::vec3(1), b.material(emitter(1.0f, 0.5f)), true);
    ConePipeline pipeline(b.build(), look_at({0, 0, 0.5f}, {0, 0, -1}, 1.2f), {32, 32}, 32);
    EXPECT_EQ(spread_of(pipeline.reflected({})).high, 0.0);
}

TEST(Reference, GlossyRoomAgainstThePathTracer)
{
    const std::string file = TestGl::root() + "/assets/glossy_room.glb";
    const Scene scene = load_scene(file);
    for (const int camera : {0, 1}) {
        PathTraceOptions options;
        options.width = options.height = 96;
        options.spp = 96;
        options.bounces = 1;
        options.parts = {Part::indirect_specular};
        const ImageF reference = path_trace(scene, choose_camera(scene, camera), options).pictures[0];
        const TemporaryFolder folder;
        const ProgramRun run = run_program("09_specular_cones", "--headless --scene '" + file + "' --output '" +
                                                                    (folder / "o.exr").string() + "' --camera " +
                                                                    std::to_string(camera) + " --size 96x96 " +
                                                                    "--view indirect_specular --set voxels=128");
        ASSERT_EQ(run.code, 0) << run.output;
        CompareOptions blocks;
        blocks.block = 4;
        blocks.flip = false;
        const ImageMetrics m = compare_images(read_exr(folder / "o.exr"), reference, blocks);
        RecordProperty("signed_ratio_camera_" + std::to_string(camera), std::to_string(m.signed_ratio));
        std::printf("camera %d: signed ratio %.3f, SMAPE %.3f\n", camera, m.signed_ratio, m.smape);
        EXPECT_GT(m.signed_ratio, 0.9);
        EXPECT_LT(m.signed_ratio, 1.1);
        EXPECT_LT(m.smape, 0.1);
    }
}

}  // namespace
}  // namespace conebook
