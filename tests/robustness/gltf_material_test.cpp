// Attributes, materials, textures, lights and cameras of the loader against exact answers.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "robustness/gltf_builder.hpp"

namespace conebook::test {
namespace {

template <class A, class B>
void expect_near(A actual, B expected, double tolerance)
{
    for (int i = 0; i < actual.length(); ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "component " << i;
}

const std::vector<std::uint8_t> white_pixel = {255, 255, 255, 255};

GltfBuilder triangle_with_material(const json& material)
{
    GltfBuilder gltf = one_triangle();
    gltf.append("materials", material);
    primitive(gltf)["material"] = 0;
    return gltf;
}

TEST(GltfAttributes, NormalisedIntegersAndFloatsGiveTheSameUvAndColour)
{
    // 0.2 = 51/255 = 13107/65535: exact in both integer types.
    const std::vector<float> uv = {0, 0, 0.2f, 0, 1, 0.2f}, rgba = {1, 0, 0.2f, 1, 0.2f, 1, 0, 0.2f, 0, 0.2f, 1, 0};
    for (const int type : {u8, u16, f32}) {
        GltfBuilder gltf = one_triangle();
        const auto add = [&](const std::vector<float>& values, const std::string& shape) {
            std::vector<std::uint8_t> bytes;
            std::vector<std::uint16_t> words;
            for (const float v : values) {
                bytes.push_back(static_cast<std::uint8_t>(std::lround(v * 255)));
                words.push_back(static_cast<std::uint16_t>(std::lround(v * 65535)));
            }
            if (type == u8) return gltf.add_accessor(bytes, u8, shape, true);
            return type == u16 ? gltf.add_accessor(words, u16, shape, true) : gltf.add_accessor(values, f32, shape);
        };
        primitive(gltf)["attributes"]["TEXCOORD_0"] = add(uv, "VEC2");
        primitive(gltf)["attributes"]["COLOR_0"] = add(rgba, "VEC4");
        const Scene scene = gltf.load();
        for (int v = 0; v < 3; ++v) {
            expect_near(scene.vertices[v].uv0, glm::vec2(uv[2 * v], uv[2 * v + 1]), 1e-7);
            expect_near(scene.vertices[v].color,
                        glm::vec4(rgba[4 * v], rgba[4 * v + 1], rgba[4 * v + 2], rgba[4 * v + 3]), 1e-7);
        }
    }
}

TEST(GltfAttributes, RgbColoursAreOpaqueAndThoseAboveOneAreClamped)
{
    GltfBuilder gltf = one_triangle();
    primitive(gltf)["attributes"]["COLOR_0"] = gltf.add_floats({0.5f, 0, 0, 2, 0, 0, -1, 0, 0}, 3);
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.vertices[0].color, glm::vec4(0.5f, 0, 0, 1));
    EXPECT_EQ(scene.vertices[1].color, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.vertices[2].color, glm::vec4(0, 0, 0, 1));
    EXPECT_TRUE(has_warning(scene, "vertex colours outside"));
}

TEST(GltfMaterials, TheDefaultOfTheSpecification)
{
    const Scene scene = one_triangle().load();
    const Material& material = scene.materials.at(scene.draws.at(0).material);
    EXPECT_EQ(material.base_color, glm::vec4(1));
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 1.0f);
    EXPECT_EQ(material.emission, glm::vec3(0));
    EXPECT_EQ(material.alpha_mode, AlphaMode::opaque);
    EXPECT_FALSE(material.double_sided || material.unlit);
}

TEST(GltfMaterials, FactorsAndExtensions)
{
    const Scene scene =
        triangle_with_material(
            {{"name", "m"},
             {"doubleSided", true},
             {"alphaMode", "MASK"},
             {"alphaCutoff", 0.25},
             {"emissiveFactor", {0.5, 0.25, 1}},
             {"pbrMetallicRoughness",
              {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.25}}},
             {"extensions",
              {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
               {"KHR_materials_specular", {{"specularFactor", 0}, {"specularColorFactor", {0.5, 0.6, 2}}}},
               {"KHR_materials_unlit", json::object()}}}})
            .load();
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.name, "m");
    EXPECT_TRUE(m.double_sided && m.unlit);
    EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(m.alpha_cutoff, 0.25f);
    EXPECT_EQ(m.emission, glm::vec3(4, 2, 8));
    EXPECT_EQ(m.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(m.metallic, 0.5f);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.specular, 0.0f);
    EXPECT_EQ(m.specular_color, glm::vec3(0.5f, 0.6f, 2.0f));
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMaterials, OutOfRangeFactorsAreClampedAndReported)
{
    const Scene scene =
        triangle_with_material(
            {{"pbrMetallicRoughness",
              {{"baseColorFactor", {1.5, -1, 0.5, 1}}, {"metallicFactor", 2}, {"roughnessFactor", -1}}}})
            .load();
    EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1, 0, 0.5f, 1));
    EXPECT_EQ(scene.materials[0].metallic, 1.0f);
    EXPECT_EQ(scene.materials[0].roughness, 0.0f);
    EXPECT_EQ(scene.warnings.size(), 3u);
    const std::string error = refusal(triangle_with_material({{"emissiveFactor", {0, -1, 0}}}));
    EXPECT_NE(error.find("materials[0] has a negative emission"), std::string::npos) << error;
}

TEST(GltfMaterials, BlendIsAMaskOnlyWhereSomethingIsTranslucent)
{
    GltfBuilder solid = triangle_with_material({{"alphaMode", "BLEND"}});
    EXPECT_EQ(solid.load().materials[0].alpha_mode, AlphaMode::opaque);
    EXPECT_TRUE(solid.load().warnings.empty());

    std::vector<GltfBuilder> translucent(3, solid);
    translucent[0].root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
    const int texture = translucent[1].add_texture({255, 255, 255, 255, 255, 255, 255, 0}, 2, 1);
    translucent[1].root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = texture;
    primitive(translucent[2])["attributes"]["COLOR_0"] =
        translucent[2].add_floats({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0}, 4);
    for (const GltfBuilder& gltf : translucent) {
        const Scene scene = gltf.load();
        EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::mask);
        EXPECT_EQ(scene.materials[0].alpha_cutoff, 0.5f);
        EXPECT_TRUE(has_warning(scene, "blends"));
    }
}

// A half float ends at 65504. The texture counts too, and what no triangle uses does not.
TEST(GltfMaterials, AnEmissionBeyondHalfFloatsIsNoted)
{
    const auto note_of = [](float strength, std::uint8_t texel, bool used) {
        GltfBuilder gltf = triangle_with_material(json::object());
        const int texture = gltf.add_texture({texel, 0, 0, 255}, 1, 1);
        gltf.root["materials"][0] = {
            {"name", "lamp"},
            {"emissiveFactor", {1, 0.5, 0}},
            {"emissiveTexture", {{"index", texture}}},
            {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", strength}}}}}};
        if (!used) primitive(gltf).erase("material");
        const Scene scene = gltf.load();
        EXPECT_EQ(scene.materials[0].emission.r, strength);
        for (const std::string& line : scene.warnings) {
            if (line.find("half float") != std::string::npos) return line;
        }
        return std::string();
    };
    EXPECT_EQ(note_of(1e7f, 255, true).substr(0, 60), "materials[0] 'lamp' emits a radiance of 1e+07 W/(sr m^2); th");
    EXPECT_EQ(note_of(65504.0f, 255, true), "");
    EXPECT_NE(note_of(65600.0f, 255, true), "");
    EXPECT_EQ(note_of(1e7f, 255, false), "");
    // sRGB 12 is 0.00368 of the light: ((12/255 + 0.055) / 1.055)^2.4.
    EXPECT_EQ(note_of(1.7e7f, 12, true), "");
    EXPECT_NE(note_of(1.8e7f, 12, true), "");
    EXPECT_EQ(note_of(1e30f, 0, true), "");
}

TEST(GltfTextures, PixelsSamplersAndSharedImages)
{
    const std::vector<std::uint8_t> rgba = {255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 10, 20, 30, 40};
    GltfBuilder gltf = triangle_with_material(json::object());
    gltf.add_texture(rgba, 2, 2);
    gltf.append("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9729}});
    gltf.append("samplers", {{"minFilter", 9984}});
    gltf.root["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}, {"sampler", 1}}, {{"source", 0}}};
    gltf.root["materials"][0] = {
        {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
        {"emissiveTexture", {{"index", 2}}}};
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.images.size(), 1u) << "one image, though three textures use it";
    EXPECT_EQ(scene.images[0].width, 2);
    EXPECT_EQ(scene.images[0].height, 2);
    EXPECT_EQ(scene.images[0].rgba, rgba);
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.base_color_texture.wrap_s, Wrap::clamp_to_edge);
    EXPECT_EQ(m.base_color_texture.wrap_t, Wrap::mirrored_repeat);
    EXPECT_EQ(m.base_color_texture.mag_filter, Filter::nearest);
    EXPECT_EQ(m.base_color_texture.min_filter, Filter::linear);
    EXPECT_FALSE(m.base_color_texture.mipmapped);
    EXPECT_EQ(m.metallic_roughness_texture.min_filter, Filter::nearest);
    EXPECT_TRUE(m.metallic_roughness_texture.mipmapped);
    EXPECT_EQ(m.emission_texture.wrap_s, Wrap::repeat);
    EXPECT_TRUE(m.emission_texture.mipmapped);
    EXPECT_FALSE(m.normal_texture.present());
}

// 16384 texels are the most that every driver takes. Black and white in turn: half of the light, which is 188 in sRGB.
TEST(GltfTextures, WiderImagesThanATextureMayBeAreShrunkAndSaidSo)
{
    for (const bool upright : {false, true}) {
        const int side = 2 * 16384, width = upright ? 1 : side, height = upright ? side : 1;
        std::vector<std::uint8_t> rgba;
        for (int i = 0; i < side; ++i) rgba.insert(rgba.end(), {std::uint8_t(i % 2 * 255), 0, 255, 255});
        GltfBuilder gltf = triangle_with_material(json::object());
        const int color = gltf.add_texture(rgba, width, height), normal = gltf.add_texture(rgba, width, height);
        gltf.root["images"][0]["name"] = "ribbon";
        gltf.root["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", color}}}}},
                                     {"normalTexture", {{"index", normal}}}};
        const Scene scene = gltf.load();
        ASSERT_EQ(scene.images.size(), 2u);
        EXPECT_EQ(scene_fault(scene), "");
        EXPECT_EQ(scene.images[0].width, upright ? 1 : 16384);
        EXPECT_EQ(scene.images[0].height, upright ? 16384 : 1);
        for (std::size_t i = 0; i < 16384; ++i) {
            ASSERT_EQ(scene.images[0].rgba[4 * i], 188);
            ASSERT_EQ(scene.images[1].rgba[4 * i], 128);
        }
        EXPECT_TRUE(
            has_warning(scene, "images[0] 'ribbon' has " + std::to_string(width) + "x" + std::to_string(height)));
    }
}

TEST(GltfTextures, TwoUvSetsAreMappedAndAThirdIsDropped)
{
    GltfBuilder gltf = triangle_with_material(json::object());
    const int texture = gltf.add_texture(white_pixel, 1, 1);
    for (int set = 0; set < 4; ++set) {
        const auto value = static_cast<float>(set);
        primitive(gltf)["attributes"]["TEXCOORD_" + std::to_string(set)] =
            gltf.add_floats(std::vector<float>(6, value), 2);
    }
    gltf.root["materials"][0] = {
        {"pbrMetallicRoughness",
         {{"baseColorTexture", {{"index", texture}, {"texCoord", 3}}},
          {"metallicRoughnessTexture", {{"index", texture}, {"texCoord", 0}}}}},
        {"normalTexture", {{"index", texture}, {"texCoord", 1}}},
        // The extension's texCoord replaces the texture's.
        {"emissiveTexture",
         {{"index", texture}, {"texCoord", 2}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 3}}}}}}}};
    const Scene scene = gltf.load();
    const Material& m = scene.materials[0];
    const auto uv_of = [&](const TextureSlot& slot) {
        return slot.uv_set == 0 ? scene.vertices[0].uv0 : scene.vertices[0].uv1;
    };
    EXPECT_EQ(uv_of(m.base_color_texture), glm::vec2(3));
    EXPECT_EQ(uv_of(m.normal_texture), glm::vec2(1));
    EXPECT_EQ(uv_of(m.emission_texture), glm::vec2(3));
    EXPECT_FALSE(m.metallic_roughness_texture.present());
    EXPECT_TRUE(has_warning(scene, "more than two UV sets"));
}

TEST(GltfTextures, TextureTransform)
{
    GltfBuilder gltf = triangle_with_material(json::object());
    const int texture = gltf.add_texture(white_pixel, 1, 1);
    const auto transformed = [&](const json& transform, glm::vec2 uv) {
        gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {
            {"index", texture}, {"extensions", {{"KHR_texture_transform", transform}}}};
        return glm::vec2(gltf.load().materials[0].base_color_texture.uv_transform * glm::vec3(uv, 1.0f));
    };
    expect_near(transformed(json::object(), {0.3f, 0.7f}), glm::vec2(0.3f, 0.7f), 1e-7);
    expect_near(transformed({{"offset", {0.1, 0.2}}, {"scale", {2, 3}}}, {0.5f, 0.5f}), glm::vec2(1.1f, 1.7f), 1e-6);
    // The extension's example: "only the lower left quadrant of the source image, rotated clockwise 90 degrees".
    // v points down, so that quadrant is u in 0..1/2, v in 1/2..1.
    const json example = {{"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}};
    expect_near(transformed(example, {0, 0}), glm::vec2(0.0f, 1.0f), 1e-6);
    expect_near(transformed(example, {1, 0}), glm::vec2(0.0f, 0.5f), 1e-6);
    expect_near(transformed(example, {0, 1}), glm::vec2(0.5f, 1.0f), 1e-6);
    expect_near(transformed(example, {1, 1}), glm::vec2(0.5f, 0.5f), 1e-6);
}

GltfBuilder triangle_with_light(const json& light, const json& node)
{
    GltfBuilder gltf = one_triangle();
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    json placed = node;
    placed["extensions"]["KHR_lights_punctual"]["light"] = 0;
    gltf.root["scenes"][0]["nodes"] = {0, gltf.add_node(placed)};
    return gltf;
}

TEST(GltfLights, DirectionalPointAndSpot)
{
    const double h = std::sqrt(0.5);  // -90 degrees about x: -z turns to -y
    const json node = {{"translation", {1, 2, 3}}, {"rotation", {-h, 0, 0, h}}, {"scale", {2, 2, 5}}, {"name", "lamp"}};
    Scene scene =
        triangle_with_light({{"type", "directional"}, {"intensity", 4}, {"color", {0.5, 0.25, 1}}, {"range", 9}}, node)
            .load();
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_FALSE(scene.has_default_light);
    EXPECT_EQ(scene.lights[0].type, LightType::directional);
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(2, 1, 4));
    EXPECT_EQ(scene.lights[0].name, "lamp");
    expect_near(scene.lights[0].direction, glm::vec3(0, -1, 0), 1e-6);

    scene = triangle_with_light({{"type", "point"}, {"range", 7}}, node).load();
    EXPECT_EQ(scene.lights[0].type, LightType::point);
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(1));
    EXPECT_EQ(scene.lights[0].range, 7.0f) << "the node's scale does not reach the light";
    expect_near(glm::dvec3(scene.lights[0].position) + scene.origin_ws, glm::dvec3(1, 2, 3), 1e-6);

    scene = triangle_with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}, node)
                .load();
    EXPECT_EQ(scene.lights[0].type, LightType::spot);
    EXPECT_EQ(scene.lights[0].range, 0.0f);
    EXPECT_EQ(scene.lights[0].inner_cone_angle, 0.25f);
    EXPECT_EQ(scene.lights[0].outer_cone_angle, 0.5f);
    expect_near(scene.lights[0].direction, glm::vec3(0, -1, 0), 1e-6);

    const std::string error = refusal(triangle_with_light({{"type", "point"}, {"intensity", -1}}, node));
    EXPECT_NE(error.find("negative colour or intensity"), std::string::npos) << error;
}

TEST(GltfLights, ADefaultOnlyWhereNothingShines)
{
    Scene scene = one_triangle().load();
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_TRUE(scene.has_default_light);
    EXPECT_EQ(scene.lights[0].type, LightType::directional);
    // It lights what faces the camera: the triangle faces +z, where the framing camera is.
    EXPECT_LT(scene.lights[0].direction.z, -0.3f);
    EXPECT_LT(scene.lights[0].direction.y, -0.3f);

    GltfBuilder emitter = triangle_with_material({{"emissiveFactor", {0, 1, 0}}});
    EXPECT_FALSE(emitter.load().has_default_light);
    EXPECT_TRUE(emitter.load().lights.empty());
    // Emission times a texture that is black in the only channel that emits.
    emitter.root["materials"][0]["emissiveTexture"]["index"] = emitter.add_texture({255, 0, 255, 255}, 1, 1);
    EXPECT_TRUE(emitter.load().has_default_light);
    // An emissive material that no triangle has.
    GltfBuilder unused = triangle_with_material(json::object());
    unused.append("materials", {{"emissiveFactor", {1, 1, 1}}});
    EXPECT_TRUE(unused.load().has_default_light);
}

TEST(GltfCameras, RigidInNodeOrderAndWithoutScale)
{
    GltfBuilder gltf = one_triangle();
    gltf.root["cameras"] = {
        {{"type", "perspective"}, {"name", "p"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 50}}}}};
    const double h = std::sqrt(0.5);  // 90 degrees about y: z turns to x
    gltf.add_node({{"camera", 1}, {"name", "o"}});
    gltf.add_node({{"camera", 0}, {"rotation", {0, h, 0, h}}, {"scale", {2, -3, 4}}, {"translation", {7, 8, 9}}});
    gltf.root["scenes"][0]["nodes"] = {2, 1, 0};
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.cameras.size(), 2u);
    const Camera& o = scene.cameras[0];
    EXPECT_TRUE(o.orthographic);
    EXPECT_EQ(o.name, "o");
    EXPECT_EQ(o.x_mag, 2.0f);
    EXPECT_EQ(o.y_mag, 3.0f);
    EXPECT_EQ(o.z_near, 0.0f);
    EXPECT_EQ(o.z_far, 50.0f);
    const Camera& p = scene.cameras[1];
    EXPECT_FALSE(p.orthographic);
    EXPECT_EQ(p.y_fov, 0.5f);
    EXPECT_EQ(p.z_near, 0.25f);
    EXPECT_EQ(p.z_far, 0.0f);
    EXPECT_NEAR(glm::determinant(glm::mat3(p.world_from_camera)), 1.0, 1e-6);
    expect_near(p.world_from_camera[2], glm::vec4(1, 0, 0, 0), 1e-6);
    expect_near(p.world_from_camera[1], glm::vec4(0, -1, 0, 0), 1e-6);  // its up is mirrored; right-handed all the same
    expect_near(glm::dvec3(p.world_from_camera[3]) + scene.origin_ws, glm::dvec3(7, 8, 9), 1e-6);
    EXPECT_EQ(choose_camera(scene, 1).name, "p");
    EXPECT_EQ(choose_camera(scene, std::nullopt).name, "o");
    EXPECT_THROW(choose_camera(scene, 2), std::runtime_error);
    EXPECT_THROW(choose_camera(scene, -1), std::runtime_error);
}

TEST(GltfCameras, FramingHoldsTheWholeSceneWhateverItsShape)
{
    for (const glm::vec3 size : {glm::vec3(1, 1, 1), {10, 1, 1}, {0.001f, 0.002f, 0}, {1, 1000, 5}, {0, 0, 3}}) {
        Scene scene;
        scene.bounds = {glm::vec3(2) - 0.5f * size, glm::vec3(2) + 0.5f * size};
        const Camera camera = choose_camera(scene, std::nullopt);
        const glm::mat4 camera_from_world = glm::inverse(camera.world_from_camera);
        float widest = 0.0f;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 seen(camera_from_world * glm::vec4(scene.bounds.corner(corner), 1.0f));
            const float half = -seen.z * std::tan(0.5f * camera.y_fov);
            widest = std::max({widest, std::abs(seen.x) / half, std::abs(seen.y) / half});
            EXPECT_GT(-seen.z, camera.z_near);
        }
        EXPECT_LT(widest, 1.0f);
        EXPECT_GT(widest, 0.3f) << "the scene is lost in the picture";
    }
}

}  // namespace
}  // namespace conebook::test
