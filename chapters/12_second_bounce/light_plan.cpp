#include "12_second_bounce/light_plan.hpp"

#include "app/needs.hpp"

namespace conebook {

SceneTraits traits_of(const Scene& scene) { return {!scene.lights.empty(), specular_cone_need(scene)}; }

LightPlan plan_light(const SceneTraits& scene, const VoxelShadingParams& voxels, const BounceParams& bounces,
                     const SoftShadowParams& pixels)
{
    // Shadows of what lights reach straight.
    constexpr const char* kPixelShadows[] = {"shadows=map", "shadows=cone", "shadows=volume"};
    const std::string asked =
        scene.has_lights ? kPixelShadows[pixels.shadows] : "the scene has no lights but surfaces that shine";
    const auto pixels_ask = [&](ShadowMethod method) { return scene.has_lights && pixels.shadows == int(method); };
    const bool voxels_ask = scene.has_lights && voxels.voxel_shadows == int(VoxelShadows::map);

    // Light by way of other surfaces.
    const std::string bounces_asked = "bounces=" + std::to_string(bounces.bounces);
    const bool indirect = bounces.bounces != 0;
    const std::string direct_alone = bounces_asked + ": direct light alone";

    LightPlan plan;
    plan.shadow_maps = {"shadow maps", pixels_ask(ShadowMethod::map) || voxels_ask,
                        voxels_ask && !pixels_ask(ShadowMethod::map) ? "voxel_shadows=map" : asked};
    plan.shadow_cones = {"shadow cones", pixels_ask(ShadowMethod::cone), asked};
    plan.visibility_volume = {"visibility volume", pixels_ask(ShadowMethod::volume), asked};
    plan.further_bounces = {"further bounces", bounces.bounces < 0 || bounces.bounces > 1, bounces_asked};
    plan.diffuse_cones = {"diffuse cones", indirect, indirect ? "for indirect light" : direct_alone};
    plan.specular_cones = indirect ? scene.specular_cones : Need{"specular cones", false, direct_alone};
    return plan;
}

std::vector<Need> LightPlan::decisions() const
{
    return {shadow_maps, shadow_cones, visibility_volume, further_bounces, diffuse_cones, specular_cones};
}

}  // namespace conebook
