// What a frame need not draw or look at: objects beside the picture, surfaces beyond a range.
#include <cmath>
#include <random>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "light_pipeline.hpp"
#include "program.hpp"

namespace conebook {
namespace {

class RandomViews {
public:
    float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
    glm::vec3 vector(float most) { return {uniform(-most, most), uniform(-most, most), uniform(-most, most)}; }
    // Of a camera or a light in or near a box of that half size: depth 1 near and 0 far, as all of the book's.
    glm::mat4 clip_from_scene(float half_size)
    {
        const glm::vec3 eye = vector(1.5f * half_size), target = vector(half_size);
        const glm::mat4 view = glm::lookAtRH(eye, target, glm::vec3(0.1f, 1.0f, 0.2f));
        const float far = uniform(0.2f, 4.0f) * half_size, side = uniform(0.1f, 1.0f) * half_size;
        return (uniform(0.0f, 1.0f) < 0.3f ? glm::orthoRH_ZO(-side, side, -side, side, far, 0.0f)
                                           : glm::perspectiveRH_ZO(uniform(0.2f, 2.0f), 1.0f, far, 0.01f * far)) *
               view;
    }

private:
    std::mt19937 random_{16};
};

TEST(Culling, NoPointOfABoxThatIsOutsideIsSeen)
{
    RandomViews views;
    int outside = 0, touching = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::mat4 clip_from_scene = views.clip_from_scene(1.0f);
        const glm::vec3 a = views.vector(1.5f), b = a + 0.5f * views.vector(1.0f);
        const Bounds box{glm::min(a, b), glm::max(a, b)};
        int seen = 0;
        for (int k = 0; k < 64; ++k) {
            const glm::vec3 t = 0.5f + 0.5f * views.vector(1.0f);
            const glm::vec4 p = clip_from_scene * glm::vec4(glm::mix(box.min, box.max, t), 1.0f);
            seen += int(std::abs(p.x) <= p.w && std::abs(p.y) <= p.w && p.z >= 0.0f && p.z <= p.w);
        }
        const bool is_out = is_outside(box, clip_from_scene);
        EXPECT_FALSE(is_out && seen > 0) << i;
        outside += int(is_out);
        touching += int(seen > 0);
    }
    EXPECT_GT(outside, 500);
    EXPECT_GT(touching, 500);
}

TEST(Culling, DrawsTheSameBits)
{
    gl::Shaders& shaders = test_gl().shaders;  // the context comes first
    const Scene source = load_scene(asset("colonnade"));
    const GpuScene scene(source);
    const gl::Program program = shaders.load({"03_shadow_map/shadow.vert", "03_shadow_map/shadow.frag"});
    const gl::Texture depth = gl::texture_2d("depth", GL_DEPTH_COMPONENT32F, {48, 48});
    const gl::Framebuffer framebuffer("depth", {}, &depth);
    const auto draw = [&](const glm::mat4& clip_from_scene, const glm::mat4* culled_by) {
        depth.clear();
        framebuffer.bind({48, 48});
        program.set("clip_from_scene", clip_from_scene);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_GREATER);
        const std::size_t drawn = scene.draw(program, Culling::none, culled_by);
        glDisable(GL_DEPTH_TEST);
        std::vector<float> pixels(48 * 48);
        glGetTextureImage(depth.id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, GLsizei(pixels.size() * sizeof(float)),
                          pixels.data());
        return std::pair(drawn, pixels);
    };
    RandomViews views;
    std::size_t drawn = 0, all = 0;
    int not_empty = 0;
    for (int i = 0; i < 200; ++i) {
        const glm::mat4 clip_from_scene = views.clip_from_scene(0.5f * source.bounds.longest_side());
        const auto [some, culled] = draw(clip_from_scene, &clip_from_scene);
        const auto [every, complete] = draw(clip_from_scene, nullptr);
        ASSERT_EQ(culled, complete) << i;
        not_empty += int(std::any_of(complete.begin(), complete.end(), [](float d) { return d > 0.0f; }));
        drawn += some;
        all += every;
    }
    EXPECT_GT(not_empty, 100);
    EXPECT_LT(drawn, all * 3 / 4);
}

// --- How far cones see ---

// A floor 1 m below a ceiling of radiance 1 that is much wider: within the range r are directions with cos >= 1 / r.
Scene floor_and_ceiling(const Material& of_floor)
{
    SceneBuilder b;
    b.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, b.material(of_floor));
    b.quad({-4, 1, -4}, {8, 0, 0}, {0, 0, 8}, b.material(emitter(1.0f)));
    return b.build();
}
Camera onto_the_floor() { return look_at_orthographic({0, 0.5f, 0}, {0, 0, 0}, 0.3f, 0.3f); }

TEST(Ranges, DiffuseConesAndAmbientOcclusionEndThere)
{
    ConePipeline pipeline(floor_and_ceiling(lambert(0.5f)), onto_the_floor(), {32, 32}, 128);
    // Cones begin and end within 1.25 voxels of the two surfaces; the rest is the quadrature of 16 x 16 cones.
    const double off = 1.25 * pipeline.voxel_size_m();
    for (const float range : {1.25f, 2.0f}) {
        ConeParams cones;
        cones.ao_falloff = 0.0f;
        const double r = double(range), seen = 1.0 - 1.0 / (r * r), tolerance = 2.0 * off / (r * r) + 0.02;
        cones.range_diffuse = range;  // and no range of ambient occlusion
        EXPECT_NEAR(spread_of(pipeline.gathered(cones)).mean, seen, tolerance) << range;
        EXPECT_LT(spread_of(pipeline.gathered(cones), 3).mean, 0.1) << range;
        cones.range_diffuse = 0.0f;
        cones.range_ao = range;
        EXPECT_NEAR(spread_of(pipeline.gathered(cones), 3).mean, 1.0 - seen, tolerance) << range;
        EXPECT_GT(spread_of(pipeline.gathered(cones)).mean, 0.9) << range;
        cones.sky = 1.0f;  // what is beyond the range is sky
        cones.range_diffuse = range;
        EXPECT_NEAR(spread_of(pipeline.gathered(cones)).mean, 1.0, 0.02) << range;
    }
}

TEST(Ranges, SpecularConesEndThere)
{
    ConePipeline pipeline(floor_and_ceiling(metal(glm::vec3(1.0f), 0.05f)), onto_the_floor(), {32, 32}, 128);
    SpecularConeParams near, far;
    near.range_specular = 0.7f;
    far.range_specular = 1.2f;
    EXPECT_EQ(spread_of(pipeline.reflected({}, near)).high, 0.0);
    EXPECT_GT(spread_of(pipeline.reflected({}, far)).low, 0.9);
    EXPECT_EQ(spread_of(pipeline.reflected({}, far)).mean, spread_of(pipeline.reflected({}, {})).mean);
}

TEST(Ranges, ShadowsBeyondThemAreLeftOut)
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, grey);
    b.box({-0.6f, 0.5f, -0.6f}, {0.6f, 0.6f, 0.6f}, grey);
    b.directional_light({0, -1, 0}, glm::vec3(1.0f));
    LightPipeline pipeline(b.build(), look_at_orthographic({0, 0.4f, 0}, {0, 0, 0}, 0.2f, 0.2f), {32, 32}, 64);
    SoftShadowParams params;
    params.range_shadow = 0.35f;
    EXPECT_EQ(spread_of(pipeline.visibility(ShadowMethod::cone, params)).low, 1.0);
    params.range_shadow = 0.8f;
    EXPECT_EQ(spread_of(pipeline.visibility(ShadowMethod::cone, params)).high, 0.0);
}

}  // namespace
}  // namespace conebook
