// Which of the passes of chapters 03 and 08 to 12 a frame needs: decided from scene and settings on the CPU, before any of
// them runs, and each decision with its reason.
#pragma once

#include "10_soft_shadows/soft_shadows.hpp"
#include "12_second_bounce/bounces.hpp"

namespace conebook {

// What a plan has to know of a scene; stays while its materials do.
struct SceneTraits {
    bool has_lights = false;                           // punctual ones
    Need specular_cones{"specular cones", false, ""};  // whether some surface has a lobe for them, and how many do
    bool has_diffuse = true;                           // some surface reflects diffusely
    bool shines = false;
};
SceneTraits traits_of(const Scene& scene);

struct LightPlan {
    Need shadow_maps;        // pixels or voxels look into them
    Need shadow_cones;       // pixels follow cones to the lights
    Need visibility_volume;  // pixels ask what the voxels found visible
    Need further_bounces;    // links between faces, light along them
    Need diffuse_cones;      // anything but direct light is to be seen
    Need specular_cones;
    // Every chapter before this one takes these always.
    Need voxels{"light in voxels", true, "for all cones"};  // chapters 04 to 06
    Need pyramid{"light pyramid", true, "for all cones"};   // of it, chapter 07, and what rays walk through, chapter 08
    Need direct_light{"direct light", true, "of the lights"};
    // Of what is gathered nothing is left out of the sum.
    bool shows_indirect = true;
    // Also what nobody asks for is made: volumes of nothing.
    bool makes_everything = false;
    std::vector<Need> decisions() const;  // those that depend on the scene, in the order of the frame
};
LightPlan plan_light(const SceneTraits& scene, const VoxelShadingParams& voxels, const BounceParams& bounces,
                     const SoftShadowParams& pixels);

}  // namespace conebook
