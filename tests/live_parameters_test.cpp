// Every parameter acts in the next frame: what is drawn after a change is, bit for bit, what passes draw that were made
// after it.
#include <cmath>

#include "chapter_12_frames.hpp"

namespace conebook {
namespace {

// Another value that is allowed, and far from the one there is.
double other_value(const Parameter& p)
{
    const double now = p.value();
    if (p.name == "voxels") return 32.0;
    if (p.name == "shadow_map_size") return 128.0;
    if (!p.values.empty()) return double(p.values[p.values[0] == int(now) ? 1 : 0]);
    if (!p.choices.empty() || p.as_bool != nullptr) return now == 0.0 ? 1.0 : 0.0;
    const double between = now > 0.0 ? 0.5 * now : p.min > 0.0 ? std::sqrt(p.min * p.max) : std::min(3.0, p.max);
    return p.as_int != nullptr ? std::max(std::floor(between), p.min) : double(float(between));
}

class LiveParameters : public testing::TestWithParam<const char*> {};

TEST_P(LiveParameters, ActInTheNextFrame)
{
    FrameParams start = Frames::small();
    start.camera.accumulation.accumulate = false;
    start.camera.shadows.shadows = ShadowMethod::cone;  // most passes have to do
    Frames frames(asset(GetParam()), start);
    // The frame's picture is not tone mapped, so DisplayParams are not in it.
    const ParameterTable table = parameters_of(frames.params.scene, frames.params.camera);
    frames.draw();
    int with_effect = 0;
    for (const Parameter& p : table.all()) {
        if (p.name == "accumulate") continue;  // its pictures differ from frame to frame: 12_changes_test
        const std::vector<float> before = frames.pixels();
        const double now = p.value(), other = other_value(p);
        ASSERT_NE(now, other) << p.name;
        p.set(other);
        frames.draw();
        const std::vector<float> after = frames.pixels();
        with_effect += int(after != before);

        // The same with passes that have never seen anything else.
        frames.renew();
        frames.draw();
        EXPECT_EQ(after, frames.pixels()) << p.name << "=" << p.value_text(other);

        // And back again.
        p.set(now);
        frames.draw();
        EXPECT_EQ(frames.pixels(), before) << p.name << ", back at " << p.value_text(now);
    }
    EXPECT_GE(with_effect, 10) << "the picture shows next to nothing of the parameters";
}

// Emitters that are aimed at; glossy surfaces; a room that shines all over, whose emission is not kept apart.
INSTANTIATE_TEST_SUITE_P(Scenes, LiveParameters, testing::Values("cornell_area", "glossy_room", "white_furnace"));

}  // namespace
}  // namespace conebook
