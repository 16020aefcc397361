// storage=dense|bricks: whether volumes hold every voxel, or what there is.
#pragma once

#include "12_second_bounce/scene_light.hpp"
#include "16_only_what_is_needed/brick_light.hpp"
#include "16_only_what_is_needed/brick_walk.hpp"

namespace conebook {

// Enters `storage`. It acts live.
void add_storage_parameter(ParameterTable& table, SceneLightParams& params);

// For SceneLight, which it must outlive:
//
//     BrickStorage bricks(app.shaders(), scene_params);
//     SceneLight scene_light(app.shaders(), app.scene(), scene, scene_params, bricks.storages());
//     ...
//     app.statistics().add_resources(bricks.resources());
class BrickStorage {
public:
    // `params` must outlive this.
    BrickStorage(gl::Shaders& shaders, const SceneLightParams& params)
        : params_(params), light_(shaders, params.voxels.pyramid), walk_(shaders)
    {
    }
    SceneStorages storages() { return {light_.storage(), walk_.storage()}; }
    // What the storages share; none where volumes are dense.
    std::vector<gl::Resource> resources() const;
    const BrickLight& light() const { return light_; }
    const BrickWalk& walk() const { return walk_; }

private:
    const SceneLightParams& params_;
    BrickLight light_;
    BrickWalk walk_;
};

}  // namespace conebook
