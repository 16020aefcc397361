// One material rule: pixels (the g-buffer), voxels (the means of their faces) and the path tracer read the same
// factors, vertex colours and textures, and come to the same reflectances and radiance.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "02_g_buffer/g_buffer.hpp"
#include "09_specular_cones/directional_albedo.hpp"
#include "reference/surface.hpp"
#include "soup_pipeline.hpp"

namespace conebook {
namespace {

constexpr int kRow = 8;  // materials in a row, each on a quad of one voxel

// What the lobe reflects in the mean over the cosine: F0 x + F90 y.
glm::dvec2 lobe_mean(double alpha)
{
    static std::map<double, glm::dvec2> known;
    const auto [entry, is_new] = known.try_emplace(alpha, glm::dvec2(0.0));
    constexpr int kSteps = 128;
    for (int i = 0; is_new && i < kSteps; ++i) {
        const double c = (i + 0.5) / kSteps;
        entry->second += 2.0 * c / kSteps * directional_albedo(c, alpha, 1024);
    }
    return entry->second;
}

// Every combination of metal, specular lobe, textures and vertex colour, and some that shine.
Scene grid_of_materials()
{
    SceneBuilder builder;
    const auto plain_image = [&](glm::u8vec4 c) {
        std::vector<std::uint8_t> rgba;
        for (int i = 0; i < 4; ++i) rgba.insert(rgba.end(), {c.r, c.g, c.b, c.a});
        return builder.image(2, 2, rgba);
    };
    const int color = plain_image({200, 120, 40, 255}), metallic_roughness = plain_image({9, 180, 150, 255}),
              emission = plain_image({255, 99, 180, 255}), specular = plain_image({10, 20, 30, 128}),
              specular_color = plain_image({250, 140, 60, 255});
    std::vector<Material> materials;
    for (const float metallic : {0.0f, 0.6f, 1.0f})
        for (const float specular_factor : {0.0f, 0.7f, 1.0f})
            for (const int textures : {0, 1, 2, 3}) {  // 1: of the core model, 2: of KHR_materials_specular
                Material m;
                m.base_color = {0.9f, 0.6f, 0.3f, 1.0f};
                m.metallic = metallic;
                m.roughness = 0.3f + 0.6f * specular_factor;
                m.specular = specular_factor;
                m.specular_color = {0.5f, 1.0f, 30.0f};  // 0.04 * 30 is held at 1
                if (metallic == 0.6f) m.emission = {2.0f, 0.5f, 30.0f};
                if ((textures & 1) != 0) {
                    m.base_color_texture.image = color;
                    m.metallic_roughness_texture.image = metallic_roughness;
                    m.emission_texture.image = emission;
                }
                if ((textures & 2) != 0) {
                    m.specular_texture.image = specular;
                    m.specular_color_texture.image = specular_color;
                }
                materials.push_back(m);
            }
    for (const int textured : {0, 1}) {
        Material m;
        m.base_color = {0.9f, 0.6f, 0.3f, 1.0f};
        m.unlit = true;
        if (textured != 0) m.base_color_texture.image = color;
        materials.push_back(m);
    }
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const int x = int(i) % kRow, y = int(i) / kRow;
        builder.quad({2.0f + 2.0f * float(x), 2.0f + 2.0f * float(y), 4.5f}, {1, 0, 0}, {0, 1, 0},
                     builder.material(materials[i]));
    }
    Scene scene = builder.build();
    for (std::size_t i = 0; i < scene.draws.size(); i += 3) {  // every third has coloured vertices
        const Draw& draw = scene.draws[i];
        const glm::vec4 vertex_color(0.5f, 0.8f, i % 2 != 0 ? 1.0f : 4.0f, 1.0f);  // brighter than white: held at 1
        for (std::uint32_t k = 0; k < draw.index_count; ++k)
            scene.vertices[scene.indices[draw.first_index + k]].color = vertex_color;
    }
    return scene;
}

void expect_near(const glm::vec3& found, const glm::vec3& expected, float tolerance, const std::string& what)
{
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], tolerance * std::max(1.0f, expected[c])) << what << ", channel " << c;
}

TEST(MaterialRule, PixelsVoxelsAndPathTracerAgree)
{
    const Scene scene = grid_of_materials();
    test_gl();
    const glm::ivec2 size(2 * kRow, 2 * kRow);  // a pixel a metre, one in the middle of each quad
    const glm::vec3 middle(2.0f + kRow, 2.0f + kRow, 0.0f);
    const Camera camera = look_at_orthographic(middle + glm::vec3(0, 0, 20), middle, kRow, kRow);
    GBuffer g_buffer(test_gl().shaders, size);
    g_buffer.draw(GpuScene(scene), camera_data(camera, size, scene.bounds));
    const ImageF base_metallic = read_picture(g_buffer.base_color_metallic()),
                 fresnel = read_picture(g_buffer.f0_f90()),
                 emission_roughness = read_picture(g_buffer.emission_roughness());

    SoupPipeline pipeline(scene, unit_bounds(2 * kRow + 4), 2 * kRow + 4);
    pipeline.average();
    const auto faces = pipeline.faces_by_voxel();

    for (std::size_t i = 0; i < scene.draws.size(); ++i) {
        const std::string what = "material " + std::to_string(i);
        const SurfaceHit hit = evaluate_surface(scene, std::uint32_t(i), 0, 0.3f, 0.3f, {0, 0, -1});
        const int x = int(i) % kRow, y = int(i) / kRow;

        // Pixels. 16 bits, or floats for emission and roughness.
        const Material& m = scene.materials[i];
        const bool srgb =
            m.base_color_texture.present() || m.emission_texture.present() || m.specular_color_texture.present();
        const int px = 2 * x, py = size.y - 1 - 2 * y;
        const glm::vec4 base = base_metallic.at(px, py), f = fresnel.at(px, py), er = emission_roughness.at(px, py);
        // llvmpipe's sRGB decoding is a polynomial: largest difference seen 0.0013.
        const float pixel = srgb ? 2e-3f : 2e-5f;
        expect_near(glm::vec3(base) * (1.0f - base.a), hit.brdf.rho, pixel, what + ", rho of pixels");
        expect_near(glm::vec3(f), hit.brdf.f0, pixel, what + ", F0 of pixels");
        EXPECT_NEAR(f.a, hit.brdf.f90.x, pixel) << what;
        expect_near(glm::vec3(er), hit.emission, pixel, what + ", emission of pixels");
        if (!m.unlit) {
            EXPECT_NEAR(er.a * er.a, hit.brdf.alpha, 2e-5f) << what;
        }

        // Voxels send both lobes to all sides. The shader's polynomials are within 0.003 of x and 0.0005 of y.
        const shared::VoxelFace& face = faces.at({{2 + 2 * x, 2 + 2 * y, 4}, 5});
        const glm::dvec2 lobe = lobe_mean(double(hit.brdf.alpha));
        const glm::vec3 both = hit.brdf.rho + float(lobe.x) * hit.brdf.f0 + float(lobe.y) * hit.brdf.f90;
        expect_near(glm::vec3(face.albedo_area), glm::min(both, 1.0f), 0.005f, what + ", albedo of voxels");
        expect_near(glm::vec3(face.emission), hit.emission, srgb ? 2e-3f : 1e-4f, what + ", emission of voxels");
    }
}

}  // namespace
}  // namespace conebook
