#include "16_only_what_is_needed/frame_plan.hpp"

#include <algorithm>

namespace conebook {

void add_parameters(ParameterTable& table, NeedParams& params)
{
    table.add("needs", params.needs, "off: make everything, whether the scene needs it or not");
}

namespace {

void leave_out(Need& need, bool keep, const std::string& reason)
{
    if (need.used && !keep) need = {need.name, false, reason};
}

bool is_surface_view(const std::string& view)
{
    const std::vector<View> views = surface_views();
    return std::any_of(views.begin(), views.end(), [&](const View& v) { return v.name == view; });
}

void use_everything(LightPlan& plan)
{
    for (Need* need : {&plan.shadow_maps, &plan.shadow_cones, &plan.visibility_volume, &plan.further_bounces,
                       &plan.diffuse_cones, &plan.specular_cones, &plan.voxels, &plan.pyramid, &plan.direct_light})
        *need = {need->name, true, need->used ? need->reason : "needs=off"};
    plan.makes_everything = true;
}

}  // namespace

LightPlan plan_frame(const SceneTraits& scene, const FrameSettings& settings, const NeedParams& params)
{
    const SoftShadowParams& shadows = settings.camera.shadows;
    LightPlan plan = plan_light(scene, settings.scene.voxels.shading, settings.scene.bounces, shadows);
    if (!params.needs) {
        // Which shadows pixels ask for is a choice of one: the others' cones would be no picture of their own.
        const Need shadow_cones = plan.shadow_cones;
        use_everything(plan);
        plan.shadow_cones = shadow_cones;
        return plan;
    }

    // What the view shows.
    const bool surface = is_surface_view(settings.view), voxels = settings.view == "voxels";
    const LightParts shown = surface || voxels ? LightParts{} : parts_of_view(settings.view);
    const std::string of_view = "view " + settings.view;
    leave_out(plan.direct_light, shown.direct > 0.0f, of_view);
    leave_out(plan.direct_light, scene.has_lights, "the scene has no lights but surfaces that shine");
    // Ambient occlusion is asked for by its view, and by what ao_strength darkens.
    const CompositeParams& sum = settings.camera.composite;
    const bool darkens = shown.specular > 0.0f || (sum.ao_on_direct && shown.direct > 0.0f);
    const bool asks_ambient = shown.ambient || (sum.ao_strength > 0.0f && darkens);
    leave_out(plan.diffuse_cones, shown.diffuse > 0.0f || asks_ambient, of_view);
    leave_out(plan.specular_cones, shown.specular > 0.0f, of_view);

    // Light that no surface reflects is not gathered.
    leave_out(plan.diffuse_cones, scene.has_diffuse || asks_ambient, "no material with a diffuse lobe");

    // snippet: plan
    // Who reads the volumes.
    const bool cones = plan.diffuse_cones.used || plan.specular_cones.used;
    for (Need* of_pixels : {&plan.shadow_cones, &plan.visibility_volume})
        leave_out(*of_pixels, plan.direct_light.used, of_view);
    const std::string nobody = "no cones, no view of voxels";
    leave_out(plan.further_bounces, cones || voxels, nobody);
    leave_out(plan.pyramid, cones || voxels || plan.shadow_cones.used, nobody);
    leave_out(plan.voxels, plan.pyramid.used || plan.visibility_volume.used, nobody);
    const bool voxels_ask = settings.scene.voxels.shading.voxel_shadows == VoxelShadows::map;
    leave_out(plan.shadow_maps,
              (plan.direct_light.used && asks_shadow_maps(shadows)) || (plan.voxels.used && voxels_ask),
              "neither pixels nor voxels ask");
    // end snippet
    return plan;
}

}  // namespace conebook
