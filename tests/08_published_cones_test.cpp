// What the first source document (Villegas 2016) does differently, each by itself against its closed form: the cones of
// its code, opacity by sample, squared weights, occlusion of direct light.
#include <cmath>

#include <gtest/gtest.h>

#include "cone_pipeline.hpp"
#include "program.hpp"
#include "scene_builder.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

TEST(ConesOfTheCode, AreTheTableAddedToTheNormal)
{
    for (const int sets : {1, 16}) {
        const ConeSet table = make_interleaved_cones(6, ConeTable::thesis, 0.0, sets);
        const ConeSet added = make_interleaved_cones(6, ConeTable::thesis_added, 0.0, sets);
        ASSERT_EQ(added.cones.size(), table.cones.size());
        for (std::size_t i = 0; i < table.cones.size(); ++i) {
            // tan of the new tilt is sin of the old one.
            const glm::dvec4 was(table.cones[i]), is(added.cones[i]);
            EXPECT_NEAR(std::hypot(is.x, is.y) / is.z, std::hypot(was.x, was.y), 1e-5);
            EXPECT_NEAR(glm::length(glm::dvec3(is)), 1.0, 1e-6);
            EXPECT_EQ(is.w, was.w);
        }
    }
    const ConeSet set = make_cone_set(6, ConeTable::thesis_added, 0.0);
    const double tilt = std::atan(std::sin(glm::radians(60.0)));
    EXPECT_NEAR(glm::degrees(tilt), 40.9, 0.05);
    EXPECT_NEAR(double(set.cones[3].z), std::cos(tilt), 1e-6);
    // 1/4 and five times 3/20: 0.762 instead of 0.667.
    EXPECT_NEAR(first_moment(set), (0.25 + 0.75 * std::cos(tilt)) * (1.0 + std::cos(glm::radians(30.0))) / 2.0, 1e-6);
}

constexpr int kVoxels = 96;

// A black floor and a wide ceiling that sends 1 W/(sr m^2); a scrap far above moves the bounds off the ceiling.
class Ceiling {
public:
    Ceiling() : pipeline_(scene(), look_at_orthographic({0, 0.2f, 0}, {0, 0, 0}, 0.01f, 0.01f), {4, 4}, kVoxels) {}

    float gathered(const ConeParams& params) { return pipeline_.gathered(params).pixels[0].r; }

    // From where cones start to the middle of the ceiling's voxels.
    double height_in_voxels(const ConeParams& params) const
    {
        const glm::dvec4 origin(pipeline_.volumes().grid.data().origin);
        const auto middle = [&](double y) { return std::floor((y - origin.y) / origin.w + 0.01) + 0.5; };
        return middle(1.0) - middle(0.0) - double(params.start_offset);
    }

private:
    static Scene scene()
    {
        SceneBuilder b;
        const int black = b.material(lambert(0.0f));
        b.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, black);
        b.quad({-4, 1, -4}, {8, 0, 0}, {0, 0, 8}, b.material(emitter(1.0f)));
        b.quad({-4, 3, 4}, {0.1f, 0, 0}, {0, 0, -0.1f}, black);
        return b.build();
    }
    ConePipeline pipeline_;
};

ConeParams marching(int cones, float aperture_deg, float step)
{
    ConeParams params;
    params.cones = cones;
    params.cone_table = ConeTable::thesis;
    params.interleave = Interleave::off;
    params.aperture = aperture_deg;
    params.walk = ConeWalk::march;
    params.step = step;
    params.start_offset = 1.0f;
    return params;
}

// Section 3.6: c += (1 - a) a_i at t_1 = 1 voxel, t_{i+1} = t_i + 2 t_i tan(half) factor. The filter makes of the
// ceiling a tent one voxel wide to both sides, so what a thin upright cone sees of it is 1 - prod_i (1 - tent(t_i -
// height)).
TEST(PerSample, StopsOfAWallWhatItsSamplesFind)
{
    Ceiling ceiling;
    double most = 0.0, least = 1.0;
    for (const float step : {0.25f, 0.5f, 1.0f, 2.0f}) {
        ConeParams params = marching(1, 3.0f, step);  // thinner than a voxel at the ceiling
        params.transmittance = Transmittance::per_sample;
        const double height = ceiling.height_in_voxels(params), tan_half = std::tan(glm::radians(1.5));
        ASSERT_LT(2.0 * (height + 1.0) * tan_half, 1.0);
        double open = 1.0;
        for (double t = 1.0; t < height + 2.0; t += std::max(2.0 * t * tan_half * double(step), 0.0625))
            open *= 1.0 - std::max(0.0, 1.0 - std::abs(t - height));
        const double seen = double(ceiling.gathered(params));
        EXPECT_NEAR(seen, 1.0 - open, 0.01) << "step " << step;
        most = std::max(most, seen);
        least = std::min(least, seen);
        params.transmittance = Transmittance::linear;
        EXPECT_NEAR(ceiling.gathered(params), 1.0f, 0.02f) << "what the steps must not change; step " << step;
    }
    EXPECT_GT(most - least, 0.05) << "steps that do not matter test nothing";
}

// A cone with tilt a is in the tent for 1 / cos a. Times cos a, its projected area, the ceiling covers 1 from all
// sides; times cos^2 a it covers cos a: of the table's cones at 60 degrees one half.
TEST(SquaredWeights, LoseTheCosine)
{
    Ceiling ceiling;
    ConeParams params = marching(6, 2.0f, 0.1f);
    EXPECT_NEAR(ceiling.gathered(params), 1.0f, 0.02f);
    params.side_weights = SideWeights::squared;
    EXPECT_NEAR(ceiling.gathered(params), 0.25f + 0.75f * 0.5f, 0.02f);
}

TEST(OcclusionOfDirectLight, IsAFactorOnItAlone)
{
    const TemporaryFolder folder;
    const auto picture = [&](const std::string& arguments) {
        const ProgramRun run = run_program(
            "08_diffuse_cones", "--headless --size 64x64 --output '" + (folder / "x.exr").string() + "' " + arguments);
        if (run.code != 0) throw std::runtime_error(run.output);
        return read_exr(folder / "x.exr");
    };
    const ImageF direct = picture("--view direct --set voxels=32");
    const ImageF ambient = picture("--view ambient_occlusion --set voxels=32");
    const ImageF indirect = picture("--view indirect_diffuse --set voxels=32 ao_strength=0.5");
    const std::string on = " --set voxels=32 ao_strength=0.5 ao_on_direct=on";
    const ImageF occluded = picture("--view direct" + on), final = picture("--view final" + on),
                 emission = picture("--view emission --set voxels=32");
    double changed = 0.0;
    for (std::size_t i = 0; i < direct.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const float factor = 1.0f + 0.5f * (ambient.pixels[i][c] - 1.0f);
            EXPECT_NEAR(occluded.pixels[i][c], factor * direct.pixels[i][c], 1e-3f * (1.0f + direct.pixels[i][c]));
            EXPECT_NEAR(final.pixels[i][c], occluded.pixels[i][c] + indirect.pixels[i][c] + emission.pixels[i][c],
                        1e-3f * (1.0f + final.pixels[i][c]));
            changed = std::max(changed, double(direct.pixels[i][c] - occluded.pixels[i][c]));
        }
    EXPECT_GT(changed, 0.01);
}

}  // namespace
}  // namespace conebook
