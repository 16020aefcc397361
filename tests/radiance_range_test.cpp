// Light is linear: a scene whose lights and emitters send 2^n times as much has a picture that is 2^n times as bright,
// beyond half floats as well, in which pyramids are kept.
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "chapter_12_frames.hpp"

namespace conebook {
namespace {

// A copy of a .glb whose light is `factor` times as strong.
void write_brighter(const std::filesystem::path& from, const std::filesystem::path& to, double factor)
{
    std::ifstream in(from, std::ios::binary);
    const std::string glb{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    std::uint32_t length = 0;  // of the JSON chunk, which is the first (glTF 2.0, 4.4.3)
    std::memcpy(&length, &glb[12], 4);
    nlohmann::json root = nlohmann::json::parse(glb.substr(20, length));
    for (auto& material : root["materials"]) {
        if (!material.contains("emissiveFactor")) continue;
        auto& strength = material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"];
        strength = factor * (strength.is_null() ? 1.0 : double(strength));
    }
    if (root.contains("extensions"))
        for (auto& light : root["extensions"]["KHR_lights_punctual"]["lights"])
            light["intensity"] = factor * double(light["intensity"]);
    std::string json = root.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string rest = glb.substr(20 + length);
    const auto word = [](std::size_t value) {
        const auto v = std::uint32_t(value);
        return std::string(reinterpret_cast<const char*>(&v), 4);
    };
    std::ofstream(to, std::ios::binary) << glb.substr(0, 8) << word(20 + json.size() + rest.size()) << word(json.size())
                                        << glb.substr(16, 4) << json << rest;
}

TEST(RadianceRange, PicturesAreInProportionToTheLights)
{
    const TemporaryFolder folder;
    for (const std::string name : {"cornell_area", "emissive_shapes", "glossy_room"}) {
        std::vector<float> expected;
        // 1; about 1e-3, 1e2, 1e6 and 1e7.
        for (const int exponent : {0, -10, 7, 20, 24}) {
            const double factor = std::ldexp(1.0, exponent);
            write_brighter(asset(name), folder / "scene.glb", factor);
            FrameParams params = Frames::small();
            Frames frames(folder / "scene.glb", params);
            frames.draw();
            std::vector<float> pixels = frames.pixels();
            double mean = 0.0, difference = 0.0;
            for (float& value : pixels) value = float(value / factor);
            if (exponent == 0) expected = pixels;
            ASSERT_EQ(pixels.size(), expected.size());
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                if (i % 4 == 3) continue;
                mean += double(expected[i]);
                difference += std::abs(double(pixels[i]) - double(expected[i]));
            }
            std::printf("%s, light of 2^%d: mean difference %.2g of the mean\n", name.c_str(), exponent,
                        difference / mean);
            EXPECT_GT(mean, 0.0);
            // Half floats of less than 6e-5 have fewer bits, and more or fewer of the values are such.
            EXPECT_LT(difference, 1e-4 * mean) << name << ", light of 2^" << exponent;
        }
    }
}

}  // namespace
}  // namespace conebook
