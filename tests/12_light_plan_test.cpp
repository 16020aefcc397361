// The plan of a frame, made without OpenGL: every setting and trait of a scene that decides about a pass.
#include <gtest/gtest.h>

#include "12_second_bounce/light_plan.hpp"
#include "scene_builder.hpp"

namespace conebook {
namespace {

struct Settings {
    VoxelShadingParams voxels;
    BounceParams bounces;
    SoftShadowParams pixels;
};
LightPlan plan_of(const Scene& scene, const Settings& s)
{
    return plan_light(traits_of(scene), s.voxels, s.bounces, s.pixels);
}

Scene floor_of(const Material& material, bool lit)
{
    SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(material));
    if (lit) b.point_light({0, 1, 0}, glm::vec3(1.0f));
    return b.build();
}

TEST(LightPlan, BouncesDecideWhichLightIsGathered)
{
    const Scene scene = floor_of(lambert(0.5f), true);
    for (const auto& [bounces, cones, links] : {std::tuple(0, false, false), std::tuple(1, true, false),
                                                std::tuple(2, true, true), std::tuple(-1, true, true)}) {
        Settings s;
        s.bounces.bounces = bounces;
        const LightPlan plan = plan_of(scene, s);
        EXPECT_EQ(plan.diffuse_cones.used, cones) << bounces;
        EXPECT_EQ(plan.further_bounces.used, links) << bounces;
        EXPECT_EQ(plan.further_bounces.reason, "bounces=" + std::to_string(bounces));
    }
}

TEST(LightPlan, SpecularConesAreForSurfacesThatHaveALobe)
{
    Material metal = lambert(0.5f);
    metal.metallic = 1.0f;
    EXPECT_FALSE(plan_of(floor_of(lambert(0.5f), true), {}).specular_cones.used);
    EXPECT_EQ(plan_of(floor_of(lambert(0.5f), true), {}).specular_cones.reason, "no material with a specular lobe");
    EXPECT_TRUE(plan_of(floor_of(metal, true), {}).specular_cones.used);
    Settings direct;
    direct.bounces.bounces = 0;
    EXPECT_FALSE(plan_of(floor_of(metal, true), direct).specular_cones.used);
    EXPECT_EQ(plan_of(floor_of(metal, true), direct).specular_cones.reason, "bounces=0: direct light alone");
    // A material that nothing is drawn with does not count.
    Scene unused = floor_of(lambert(0.5f), true);
    unused.materials.push_back(metal);
    EXPECT_FALSE(plan_of(unused, {}).specular_cones.used);
}

TEST(LightPlan, ShadowMapsAreForThoseWhoAsk)
{
    for (const bool lit : {true, false})
        for (const ShadowMethod pixels : {ShadowMethod::map, ShadowMethod::cone, ShadowMethod::volume})
            for (const VoxelShadows voxels : {VoxelShadows::map, VoxelShadows::none}) {
                Settings s;
                s.pixels.shadows = pixels;
                s.voxels.voxel_shadows = voxels;
                const LightPlan plan = plan_of(floor_of(lambert(0.5f), lit), s);
                EXPECT_EQ(plan.shadow_maps.used, lit && (pixels == ShadowMethod::map || voxels == VoxelShadows::map));
                EXPECT_EQ(plan.shadow_cones.used, lit && pixels == ShadowMethod::cone);
                EXPECT_EQ(plan.visibility_volume.used, lit && pixels == ShadowMethod::volume);
                for (const Need& need : plan.decisions()) EXPECT_FALSE(need.reason.empty()) << need.name;
            }
}

}  // namespace
}  // namespace conebook
