// How much memory a frame will take, before anything of it is made.
#pragma once

#include "16_only_what_is_needed/frame_plan.hpp"

namespace conebook {

// What of a scene decides about memory.
struct SceneSize {
    Bounds bounds;
    std::size_t triangles = 0, bytes = 0;           // bytes: of triangles, textures, materials
    double box_sides_m = 0.0, seen_areas_m2 = 0.0;  // sums over triangles, see MaterialUse
    std::size_t shadow_maps = 0;
    bool emitters_apart = false;  // rays are aimed at them
};
SceneSize size_of(const GpuScene& scene, const SceneTraits& traits);

// Faces that occupied voxels of `voxel_size_m` will have, about.
double expected_faces(const SceneSize& scene, double voxel_size_m);

// Bytes of all that the plan makes for a picture of `size` pixels, and of the scene: volumes exactly, lists of faces by
// expected_faces(). With dense storage.
double expected_bytes(const SceneSize& scene, const FrameSettings& settings, const LightPlan& plan, glm::ivec2 size);

}  // namespace conebook
