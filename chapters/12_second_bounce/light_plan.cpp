#include "12_second_bounce/light_plan.hpp"

#include "app/needs.hpp"

namespace conebook {

SceneTraits traits_of(const Scene& scene)
{
    return {!scene.lights.empty(), specular_cone_need(scene), has_diffuse_surfaces(scene), has_emission(scene)};
}

LightPlan plan_light(const SceneTraits& scene, const VoxelShadingParams& voxels, const BounceParams& bounces,
                     const SoftShadowParams& pixels)
{
    // Shadows of what lights reach straight.
    const std::vector<Need> by_voxels = soft_shadow_needs(pixels, scene.has_lights);
    const bool pixels_ask = scene.has_lights && asks_shadow_maps(pixels);
    const bool voxels_ask = scene.has_lights && voxels.voxel_shadows == VoxelShadows::map;

    // Light by way of other surfaces.
    const std::string bounces_asked = "bounces=" + std::to_string(bounces.bounces);
    const bool indirect = bounces.bounces != 0;
    const std::string direct_alone = bounces_asked + ": direct light alone";

    LightPlan plan;
    plan.shadow_maps = {"shadow maps", pixels_ask || voxels_ask,
                        voxels_ask && !pixels_ask ? "voxel_shadows=map" : by_voxels[0].reason};
    plan.shadow_cones = by_voxels[0];
    plan.visibility_volume = by_voxels[1];
    plan.further_bounces = {"further bounces", goes_round(bounces), bounces_asked};
    plan.diffuse_cones = {"diffuse cones", indirect, indirect ? "for indirect light" : direct_alone};
    plan.specular_cones = indirect ? scene.specular_cones : Need{"specular cones", false, direct_alone};
    plan.shows_indirect = indirect;
    return plan;
}

std::vector<Need> LightPlan::decisions() const
{
    return {shadow_maps, shadow_cones, visibility_volume, further_bounces, diffuse_cones, specular_cones};
}

}  // namespace conebook
