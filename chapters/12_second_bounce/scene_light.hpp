// What does not depend on the camera, chapters 03 to 08, 11 and 12 in order: lights and triangles -> voxels -> all bounces of
// their light -> pyramids. Each pass runs when something that its result depends on has changed.
#pragma once

#include "12_second_bounce/light_plan.hpp"

namespace conebook {

struct SceneLightParams {
    LitVoxelParams voxels;
    ShadowMapParams shadow_maps;
    EmitterParams emitters;
    BounceParams bounces;
};
void add_parameters(ParameterTable& table, SceneLightParams& params);

// Where to keep what depends on the scene alone, instead of in volumes that hold every voxel.
struct SceneStorages {
    LightStorage light;
    WalkStorage walk;
};

class SceneLight {
public:
    // `shaders`, `source` and `params` must outlive this. `storages`: where params.voxels.pyramid.storage > 0.
    SceneLight(gl::Shaders& shaders, const Scene& source, const GpuScene& scene, const SceneLightParams& params,
               const SceneStorages& storages = {});

    void run(App& app, const GpuScene& scene, const ConeParams& cones, const LightPlan& plan)
    {
        run(app, scene, cones, plan, [&] {
            voxels_.voxelize(app, scene);
            return FaceChange{};
        });
    }
    // `voxelize`: does the same for voxels(), and says what has changed, if it knows.
    void run(App& app, const GpuScene& scene, const ConeParams& cones, const LightPlan& plan,
             const std::function<FaceChange()>& voxelize);

    LitVoxels& voxels() { return voxels_; }
    const LitVoxels& voxels() const { return voxels_; }
    const ShadowMaps& shadow_maps() const { return shadow_maps_; }
    const Emitters& emitters() const { return emitters_; }
    const Bounces& bounces() const { return bounces_; }
    ConeVolumes volumes() const { return {voxels_.grid(), voxels_.pyramid(), walk_volume_}; }
    // Changes whenever the light in the voxels does, or what it is made from.
    Revision revision() const { return voxels_.pyramid().revision() + scene_revision_; }

    std::vector<gl::Resource> resources() const;
    std::vector<Need> needs(const Scene& source, const GpuScene& scene) const;
    std::vector<Count> counts() const;

private:
    const SceneLightParams& params_;
    ShadowMaps shadow_maps_;
    LitVoxels voxels_;
    WalkVolume walk_volume_;
    Emitters emitters_;
    Bounces bounces_;
    Revision scene_revision_ = 0;  // of geometry and lights
};

}  // namespace conebook
