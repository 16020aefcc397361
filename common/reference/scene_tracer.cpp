#include "reference/scene_tracer.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <embree3/rtcore.h>

namespace conebook {
namespace {

struct DrawData {
    const Scene* scene = nullptr;
    std::uint32_t draw = 0;
};

// Embree calls this for each candidate hit on an alpha-masked draw, one ray at a time.
void reject_holes(const RTCFilterFunctionNArguments* args)
{
    if (args->valid[0] != -1) return;
    const auto& data = *static_cast<const DrawData*>(args->geometryUserPtr);
    const Draw& draw = data.scene->draws[data.draw];
    const TrianglePoint point = triangle_point(*data.scene, draw, RTCHitN_primID(args->hit, args->N, 0),
                                               RTCHitN_u(args->hit, args->N, 0), RTCHitN_v(args->hit, args->N, 0));
    if (!covers(*data.scene, data.scene->materials[draw.material], point)) args->valid[0] = 0;
}

void cull_backs(const RTCFilterFunctionNArguments* args)
{
    if (args->valid[0] != -1) return;
    const auto& data = *static_cast<const DrawData*>(args->geometryUserPtr);
    const Scene& scene = *data.scene;
    if (scene.materials[scene.draws[data.draw].material].double_sided) return;
    const TrianglePoint p =
        triangle_point(scene, scene.draws[data.draw], RTCHitN_primID(args->hit, args->N, 0), 0.0f, 0.0f);
    const glm::vec3 n = glm::cross(p.v1->position - p.v0->position, p.v2->position - p.v0->position);
    const glm::vec3 d(RTCRayN_dir_x(args->ray, args->N, 0), RTCRayN_dir_y(args->ray, args->N, 0),
                      RTCRayN_dir_z(args->ray, args->N, 0));
    if (glm::dot(n, d) >= 0.0f) args->valid[0] = 0;
}

RTCRayHit ray_hit(const Ray& ray)
{
    RTCRayHit rh{};
    rh.ray.org_x = ray.origin.x, rh.ray.org_y = ray.origin.y, rh.ray.org_z = ray.origin.z;
    rh.ray.dir_x = ray.direction.x, rh.ray.dir_y = ray.direction.y, rh.ray.dir_z = ray.direction.z;
    rh.ray.tnear = ray.t_min;
    rh.ray.tfar = ray.t_max;
    rh.ray.mask = ~0u;
    rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rh.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return rh;
}

}  // namespace

struct SceneTracer::Embree {
    const Scene* scene = nullptr;
    RTCDevice device = nullptr;
    RTCScene rtc = nullptr;
    std::vector<DrawData> draw_data;  // one per draw; its address is the geometry's user pointer
    float offset = 0.0f;

    Embree() = default;
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree()
    {
        if (rtc) rtcReleaseScene(rtc);
        if (device) rtcReleaseDevice(device);
    }

    std::optional<SurfaceHit> trace(const Ray& ray, RTCFilterFunctionN filter) const
    {
        RTCRayHit rh = ray_hit(ray);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.filter = filter;
        rtcIntersect1(rtc, &context, &rh);
        if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
        SurfaceHit hit = evaluate_surface(*scene, rh.hit.geomID, rh.hit.primID, rh.hit.u, rh.hit.v, ray.direction);
        hit.distance = rh.ray.tfar;
        return hit;
    }
};

SceneTracer::SceneTracer(const Scene& scene, int threads) : embree_(std::make_unique<Embree>())
{
    Embree& e = *embree_;
    e.scene = &scene;
    if (threads <= 0) threads = int(std::max(1u, std::thread::hardware_concurrency()));
    e.device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    if (!e.device) throw std::runtime_error(scene.name + ": Embree cannot start on this machine");
    e.rtc = rtcNewScene(e.device);
    rtcSetSceneFlags(e.rtc, RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    e.draw_data.resize(scene.draws.size());
    for (std::uint32_t i = 0; i < scene.draws.size(); ++i) {
        const Draw& draw = scene.draws[i];
        if (draw.index_count < 3) continue;
        e.draw_data[i] = {&scene, i};
        RTCGeometry geometry = rtcNewGeometry(e.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Vertices are shared, not copied. Embree reads 16 bytes per position, so it may look past it, but not past
        // the vertex (72 bytes).
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, scene.vertices.data(),
                                   offsetof(Vertex, position), sizeof(Vertex), scene.vertices.size());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, scene.indices.data(),
                                   std::size_t(draw.first_index) * sizeof(std::uint32_t), 3 * sizeof(std::uint32_t),
                                   draw.index_count / 3);
        rtcSetGeometryUserData(geometry, &e.draw_data[i]);
        if (scene.materials[draw.material].alpha_mode == AlphaMode::mask) {
            rtcSetGeometryIntersectFilterFunction(geometry, reject_holes);
            rtcSetGeometryOccludedFilterFunction(geometry, reject_holes);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(e.rtc, geometry, i);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(e.rtc);
    const RTCError error = rtcGetDeviceError(e.device);
    if (error != RTC_ERROR_NONE)
        throw std::runtime_error(scene.name + ": Embree cannot build the scene (error " + std::to_string(error) + ")");
    const glm::vec3 extreme = glm::max(glm::abs(scene.bounds.min), glm::abs(scene.bounds.max));
    e.offset = 0x1p-18f * std::max(extreme.x, std::max(extreme.y, extreme.z));
}

SceneTracer::~SceneTracer() = default;
SceneTracer::SceneTracer(SceneTracer&&) noexcept = default;
SceneTracer& SceneTracer::operator=(SceneTracer&&) noexcept = default;

const Scene& SceneTracer::scene() const { return *embree_->scene; }
float SceneTracer::surface_offset() const { return embree_->offset; }

std::optional<SurfaceHit> SceneTracer::intersect(const Ray& ray) const
{
    auto hit = embree_->trace(ray, nullptr);
    if (!hit || !hit->dark) return hit;
    // A back: look for a front at the same place, which the traversal may have met second.
    const float slack = embree_->offset / glm::length(ray.direction) + hit->distance * 4e-7f;
    Ray again = ray;
    again.t_min = std::max(ray.t_min, hit->distance - slack);
    again.t_max = std::min(ray.t_max, hit->distance + slack);
    const auto front = embree_->trace(again, cull_backs);
    return front ? front : hit;
}

std::optional<SurfaceHit> SceneTracer::intersect_camera(const Ray& ray) const
{
    return embree_->trace(ray, cull_backs);
}

bool SceneTracer::occluded(const glm::vec3& from, const glm::vec3& to) const
{
    Ray segment{from, to - from, 0.0f, 1.0f};
    RTCRayHit rh = ray_hit(segment);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(embree_->rtc, &context, &rh.ray);
    return rh.ray.tfar < 0.0f;  // Embree sets -infinity
}

Ray camera_ray(const Camera& camera, const DepthRange& depths, float x, float y, int width, int height)
{
    const double ndc_x = 2.0 * double(x) / width - 1.0, ndc_y = 1.0 - 2.0 * double(y) / height;
    glm::dvec3 origin(0.0), direction(0.0, 0.0, -1.0);  // camera space; direction.z = -1, so t is depth
    if (camera.orthographic) {
        origin = {ndc_x * camera.x_mag, ndc_y * camera.y_mag, 0.0};
    } else {
        const double half = std::tan(0.5 * camera.y_fov);
        direction = {ndc_x * half * width / height, ndc_y * half, -1.0};
    }
    // Floats only from the scene on: a direction rounded 100 km away would miss by centimetres.
    const glm::dmat4 scene_from_camera(camera.world_from_camera);
    Ray ray;
    ray.origin = glm::vec3(scene_from_camera * glm::dvec4(origin + depths.near * direction, 1.0));
    ray.direction = glm::vec3(glm::dmat3(scene_from_camera) * direction);
    ray.t_max = float(depths.far - depths.near);
    return ray;
}

}  // namespace conebook
