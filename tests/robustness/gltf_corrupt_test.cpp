// Damage without a plan: a small .glb that uses most of the format, truncated and with random bytes changed. Whatever
// comes out must be a sound scene or one line of error; never a crash, a hang or a large allocation.
#include <sys/resource.h>

#include <chrono>
#include <random>

#include <gtest/gtest.h>

#include "robustness/gltf_builder.hpp"

namespace conebook::test {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool address_sanitizer = true;  // it reserves terabytes of address space
#else
constexpr bool address_sanitizer = false;
#endif

// Caps the address space at 1 GiB while it lives: a larger allocation fails instead of passing unnoticed.
class MemoryLimit {
public:
    MemoryLimit()
    {
        getrlimit(RLIMIT_AS, &before_);
        rlimit limit = before_;
        limit.rlim_cur = 1u << 30;
        if (!address_sanitizer) setrlimit(RLIMIT_AS, &limit);
    }
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;
    ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }

private:
    rlimit before_{};
};

GltfBuilder a_bit_of_everything()
{
    GltfBuilder gltf;
    const int position = gltf.add_floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3);
    const int normal = gltf.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    const int uv0 = gltf.add_accessor<std::uint16_t>({0, 65535, 65535, 65535, 65535, 0, 0, 0}, u16, "VEC2", true);
    const int uv1 = gltf.add_floats({0, 0, 1, 0, 1, 1, 0, 1}, 2);
    const int color =
        gltf.add_accessor<std::uint8_t>({255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 9}, u8, "VEC4", true);
    const int indices = gltf.add_accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, u8, "SCALAR");
    const int strip = gltf.add_accessor<std::uint16_t>({0, 1, 3, 2}, u16, "SCALAR");
    const int sparse_at = gltf.add_view(GltfBuilder::bytes_of(std::vector<std::uint16_t>{1, 3}));
    const int sparse_to = gltf.add_view(GltfBuilder::bytes_of(std::vector<float>{2, 0, 0, 0, 2, 0}));
    const int sparse = gltf.append("accessors", {{"bufferView", 0},
                                                 {"componentType", f32},
                                                 {"count", 4},
                                                 {"type", "VEC3"},
                                                 {"sparse",
                                                  {{"count", 2},
                                                   {"indices", {{"bufferView", sparse_at}, {"componentType", u16}}},
                                                   {"values", {{"bufferView", sparse_to}}}}}});
    std::vector<std::uint8_t> picture(8 * 8 * 4);
    for (std::size_t i = 0; i < picture.size(); ++i) picture[i] = static_cast<std::uint8_t>(i * 37);
    const int texture = gltf.add_texture(picture, 8, 8);
    gltf.root["samplers"] = {{{"wrapS", 33071}, {"minFilter", 9987}}};
    gltf.root["textures"][0]["sampler"] = 0;
    gltf.root["materials"] = {
        {{"name", "m"},
         {"alphaMode", "BLEND"},
         {"normalTexture", {{"index", texture}, {"scale", 0.5}}},
         {"emissiveFactor", {1, 1, 1}},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.5, 0.5, 0.5, 1}},
           {"baseColorTexture",
            {{"index", texture},
             {"texCoord", 1},
             {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 1}}}}}}}}},
         {"extensions",
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}},
           {"KHR_materials_specular", {{"specularFactor", 0.5}}}}}},
        {{"alphaMode", "MASK"}, {"extensions", {{"KHR_materials_unlit", json::object()}}}}};
    gltf.root["meshes"] = {
        {{"primitives",
          {{{"attributes",
             {{"POSITION", position},
              {"NORMAL", normal},
              {"TEXCOORD_0", uv0},
              {"TEXCOORD_1", uv1},
              {"COLOR_0", color}}},
            {"indices", indices},
            {"material", 0}},
           {{"attributes", {{"POSITION", sparse}}}, {"indices", strip}, {"mode", 5}, {"material", 1}}}}}};
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 3}, {"range", 4}, {"spot", {{"outerConeAngle", 0.5}}}}};
    gltf.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform"};
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"zfar", 9}}}}};
    gltf.root["nodes"] = {{{"children", {1, 2, 3}}, {"rotation", {0, 0, 1, 0}}, {"scale", {-1, 2, 1}}},
                          {{"mesh", 0}},
                          {{"camera", 0}, {"translation", {0, 0, 4}}},
                          {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    const int times = gltf.add_floats({0, 1}, 1);
    const int turns = gltf.add_floats({0, 0, 0, 1, 0, 0, 1, 0}, 4);
    const int moves = gltf.add_floats(std::vector<float>(18, 0.5f), 3);
    gltf.root["animations"] = {{{"samplers",
                                 {{{"input", times}, {"output", turns}, {"interpolation", "STEP"}},
                                  {{"input", times}, {"output", moves}, {"interpolation", "CUBICSPLINE"}}}},
                                {"channels",
                                 {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}},
                                  {{"sampler", 1}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    const int binding = gltf.add_accessor(std::vector<float>(32, 1.0f), f32, "MAT4");
    gltf.root["skins"] = {{{"joints", {2, 3}}, {"inverseBindMatrices", binding}, {"skeleton", 0}}};
    gltf.root["nodes"][1]["skin"] = 0;
    return gltf;
}

// Loads damaged bytes and says what is wrong with the outcome ("" = sound scene or one clear line).
class DamageTest : public testing::Test {
protected:
    std::string outcome(const std::string& bytes)
    {
        const auto start = std::chrono::steady_clock::now();
        const std::filesystem::path file = write_file(folder_.path() / "damaged.glb", bytes);
        std::string fault;
        try {
            fault = scene_fault(load_scene(file));
            ++loaded_;
        } catch (const std::runtime_error& e) {
            const std::string error = e.what();
            if (!error.starts_with(file.string() + ": ")) fault = "does not name the file: " + error;
            if (error.find('\n') != std::string::npos) fault = "more than one line: " + error;
            if (error.find("not enough memory") != std::string::npos) fault = "tried a large allocation";
            ++refused_;
        }
        if (std::chrono::steady_clock::now() - start > std::chrono::seconds(5)) fault = "took more than 5 s";
        return fault;
    }

    const TemporaryFolder folder_;
    const std::string sound_ = a_bit_of_everything().glb();
    int loaded_ = 0, refused_ = 0;
};

TEST_F(DamageTest, TheFileItselfIsSound)
{
    const Scene scene = a_bit_of_everything().load();
    EXPECT_EQ(scene_fault(scene), "");
    EXPECT_EQ(scene.triangle_count(), 4u);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.animations.size(), 1u);
    EXPECT_EQ(scene.skins.size(), 1u);
}

TEST_F(DamageTest, TruncatedAnywhere)
{
    const MemoryLimit limit;
    for (std::size_t size = 0; size < sound_.size(); size += 97) {
        EXPECT_EQ(outcome(sound_.substr(0, size)), "") << "cut to " << size << " bytes";
    }
    EXPECT_EQ(loaded_, 0) << "a cut file must not pass as a whole one";
}

TEST_F(DamageTest, BytesChangedAtRandom)
{
    const MemoryLimit limit;
    std::mt19937 random(20240607);
    const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
    for (int round = 0; round < 2000; ++round) {
        std::string bytes = sound_;
        const std::size_t changes = round % 2 == 0 ? 1 : 1 + below(8);
        for (std::size_t c = 0; c < changes; ++c) bytes[below(bytes.size())] = static_cast<char>(below(256));
        EXPECT_EQ(outcome(bytes), "") << "round " << round;
    }
    EXPECT_GT(loaded_, 100) << "the damage must not only hit the JSON";
    EXPECT_GT(refused_, 100);
}

// Bytes at random mostly break the JSON. Changing only values in it reaches the checks behind: counts, offsets.
TEST_F(DamageTest, NumbersOfTheJsonChanged)
{
    const MemoryLimit limit;
    const GltfBuilder sound = a_bit_of_everything();
    std::mt19937 random(7);
    const json replacements = {-1,
                               0,
                               1,
                               2,
                               7,
                               255,
                               65535,
                               2147483647,
                               2147483648u,
                               4294967295u,
                               18446744073709551615u,
                               -2147483648,
                               0.5,
                               -1e30,
                               1e30,
                               1e300,
                               36.0,
                               "x",
                               nullptr,
                               json::array(),
                               json::object(),
                               true};
    const json flat = sound.root.flatten();
    std::vector<std::string> paths;
    for (const auto& [path, value] : flat.items()) paths.push_back(path);
    int round = 0;
    for (const std::string& path : paths) {
        for (const json& replacement : replacements) {
            GltfBuilder damaged = sound;
            damaged.root[json::json_pointer(path)] = replacement;
            EXPECT_EQ(outcome(damaged.glb()), "") << path << " = " << replacement << ", round " << ++round;
        }
    }
    EXPECT_GT(loaded_, 200);
    EXPECT_GT(refused_, 1000);
}

}  // namespace
}  // namespace conebook::test
