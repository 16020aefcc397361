// Rays through a scene (Embree 3), exact to float precision and watertight (RTC_SCENE_FLAG_ROBUST).
//
// Rules, the same as the rasterizer's:
// - Alpha-masked texels are holes for every ray.
// - The back of a single-sided surface blocks light but reflects and emits nothing (SurfaceHit::dark). Camera rays
//   pass through it, as back-face culling does. Where a back and a front coincide (a wall of zero thickness made of
//   two single-sided quads) the front is what is seen.
#pragma once

#include <memory>
#include <optional>

#include "reference/surface.hpp"
#include "scene/scene.hpp"

namespace conebook {

struct Ray {
    glm::vec3 origin{0.0f};     // scene space
    glm::vec3 direction{0.0f};  // need not be unit
    float t_min = 0.0f;         // in lengths of direction
    float t_max = 1e30f;
};

class SceneTracer {
public:
    // Builds the acceleration structure with that many threads (0: all cores). The scene must outlive the tracer.
    // Throws std::runtime_error when Embree fails.
    explicit SceneTracer(const Scene& scene, int threads = 0);
    ~SceneTracer();
    SceneTracer(SceneTracer&&) noexcept;
    SceneTracer& operator=(SceneTracer&&) noexcept;

    const Scene& scene() const;

    // The nearest surface along a ray that carries light.
    std::optional<SurfaceHit> intersect(const Ray& ray) const;

    // The nearest surface that the camera sees: back faces of single-sided surfaces are culled.
    std::optional<SurfaceHit> intersect_camera(const Ray& ray) const;

    // True when something lies on the open segment between two points, which are moved off their surfaces already.
    bool occluded(const glm::vec3& from, const glm::vec3& to) const;

    // m. Rays leave a surface this far along its geometric normal, 2^-18 of the largest coordinate: about 30 times
    // the rounding error of a position, 1/4000 of a voxel at 128^3.
    float surface_offset() const;
    glm::vec3 leave(const SurfaceHit& hit) const { return hit.position + surface_offset() * hit.geometric_normal; }

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

// The ray through a point of the picture: x in [0, width), y in [0, height), y = 0 on top. It starts and ends at the
// `depths` (see visible_depths), as clipping does.
Ray camera_ray(const Camera& camera, const DepthRange& depths, float x, float y, int width, int height);

}  // namespace conebook
