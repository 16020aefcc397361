#include "19_vertex_radiosity/further_lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace conebook {
namespace {

// 10 bits of x with two zeros between each (Morton 1966).
std::uint32_t spread(std::uint32_t x)
{
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

// Patches that face the same way stand together, and among them neighbours.
std::uint64_t place_in_order(const shared::Patch& patch, const Bounds& box)
{
    const glm::vec3 a = glm::abs(glm::vec3(patch.normal));
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const auto face = std::uint64_t(2 * axis + (patch.normal[axis] > 0.0f ? 1 : 0));
    const glm::vec3 t = (glm::vec3(patch.position) - box.min) / std::max(box.longest_side(), 1e-30f);
    const glm::uvec3 cell = glm::uvec3(glm::clamp(t, 0.0f, 1.0f) * 1023.0f);
    return face << 32 | spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2;
}

double sum_of(const glm::vec3& flux) { return double(flux.x) + double(flux.y) + double(flux.z); }

// Points that fill a square evenly however many there are (Roberts 2018, the R2 sequence).
glm::dvec2 even_point(std::size_t i)
{
    constexpr double kPlastic = 1.32471795724474602596;
    double whole = 0.0;
    return {std::modf(0.5 + double(i) / kPlastic, &whole), std::modf(0.5 + double(i) / (kPlastic * kPlastic), &whole)};
}

}  // namespace

void add_parameters(ParameterTable& table, FurtherLightParams& params)
{
    table.add("emitter_lights", params.emitter_lights, 1, 4096, "", "most lights that emissive surfaces become");
    table.add("ray", params.ray, {"cosine", "mirror"}, "which way a light sends the rays of the next bounce");
    table.add("rays", params.rays, 0, 64, "", "rays of each light of step 2; 0: by the number of lights");
}

int rays_of(const FurtherLightParams& params, std::size_t lights, std::size_t patches)
{
    constexpr std::size_t kMost = 16;
    if (params.rays > 0) return params.rays;
    return int(std::clamp(usual_lights(patches) / std::max<std::size_t>(lights, 1), std::size_t(1), kMost));
}

glm::dvec3 total_flux(const std::vector<PickedLight>& lights)
{
    glm::dvec3 sum(0.0);
    for (const PickedLight& picked : lights) sum += glm::dvec3(picked.light.flux);
    return sum;
}

std::vector<PickedLight> emitter_lights(const PatchMesh& mesh, const FurtherLightParams& params)
{
    std::vector<std::size_t> emitters;
    double total = 0.0;
    Bounds box{glm::vec3(INFINITY), glm::vec3(-INFINITY)};
    for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
        if (mesh.emitted[i] == glm::vec3(0.0f)) continue;
        emitters.push_back(i);
        total += sum_of(mesh.emitted[i]);
        box.min = glm::min(box.min, glm::vec3(mesh.patches[i].position));
        box.max = glm::max(box.max, glm::vec3(mesh.patches[i].position));
    }
    const bool each = emitters.size() <= std::size_t(params.emitter_lights);
    if (!each)
        std::stable_sort(emitters.begin(), emitters.end(), [&](std::size_t a, std::size_t b) {
            return place_in_order(mesh.patches[a], box) < place_in_order(mesh.patches[b], box);
        });
    std::vector<PickedLight> lights;
    const double run = total / params.emitter_lights;
    double before = 0.0;  // flux of the patches before this one
    constexpr std::size_t kNone = ~std::size_t(0);
    std::size_t middle = kNone;  // of the run
    glm::vec3 flux(0.0f);
    float area = 0.0f;
    std::vector<PickedLight> parts;
    const auto light_at = [&](std::size_t id, const glm::vec3& of, float size) {
        PickedLight picked;
        picked.light = {glm::vec4(glm::vec3(mesh.patches[id].position), size), mesh.patches[id].normal,
                        glm::vec4(of, 0.0f)};
        return picked;
    };
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const std::size_t id = emitters[i];
        flux += mesh.emitted[id];
        area += mesh.patches[id].position.w;
        const double after = before + sum_of(mesh.emitted[id]);
        if (middle == kNone && std::floor(after / run + 0.5) > std::floor(before / run + 0.5)) middle = id;
        const bool is_end = std::floor(after / run) > std::floor(before / run) || i + 1 == emitters.size();
        before = after;
        if (!each) parts.push_back(light_at(id, mesh.emitted[id], mesh.patches[id].position.w));
        if (!each && !is_end) continue;
        // The patch in the middle of a run stands for it.
        lights.push_back(light_at(each || middle == kNone ? id : middle, flux, area));
        if (parts.size() > 1) lights.back().parts = parts;
        parts.clear();
        flux = glm::vec3(0.0f);
        area = 0.0f;
        middle = kNone;
    }
    return lights;
}

std::vector<PickedLight> next_bounce(const SceneTracer& tracer, const std::vector<PickedLight>& lights,
                                     const FurtherLightParams& params, const PatchMesh& mesh, NextBounce bounce)
{
    std::vector<PickedLight> met;
    const std::size_t rays = bounce.number == 2 ? std::size_t(rays_of(params, lights.size(), mesh.patches.size())) : 1;
    double kept = 0.5;
    for (std::size_t i = 0; i < lights.size() * rays; ++i) {
        const PickedLight& from = lights[i / rays];
        const glm::vec3 normal(from.light.normal);
        // snippet: ray
        // A diffuse light sends its flux by the cosine of the angle to its normal; so are the rays distributed, and
        // each carries the same share.
        const glm::dvec2 u = even_point(bounce.first_ray + i);
        const double r = std::sqrt(u.x), turn = 2.0 * std::numbers::pi * u.y;
        glm::vec3 direction = Frame(normal).to_scene({r * std::cos(turn), r * std::sin(turn), std::sqrt(1.0 - u.x)});
        if (params.ray == RayDirection::mirror)
            direction = from.incoming == glm::vec3(0.0f) ? normal : glm::reflect(from.incoming, normal);
        const auto hit =
            tracer.intersect({glm::vec3(from.light.position) + tracer.surface_offset() * normal, direction});
        if (!hit || hit->dark) continue;
        const glm::vec3 arriving = glm::vec3(from.light.flux) / float(rays);
        glm::vec3 flux = hit->brdf.rho * arriving;
        // end snippet
        if (flux == glm::vec3(0.0f)) continue;
        if (bounce.number > 2) {
            const double share = sum_of(flux) / sum_of(arriving), before = kept;
            kept += share;
            if (std::floor(kept) == std::floor(before)) continue;
            flux /= float(share);
        }
        PickedLight picked;
        const double reach = std::numbers::pi * double(hit->distance) * double(hit->distance);
        picked.light = {glm::vec4(hit->position, float(reach)), glm::vec4(hit->shading_normal, 0.0f),
                        glm::vec4(flux, 0.0f)};
        picked.incoming = direction;
        // A disc no smaller than the one where the ray began, whose every point it might have come from.
        picked.light.position.w = std::max(picked.light.position.w, from.light.position.w);
        met.push_back(picked);
    }
    // Each stands for its share of all surfaces, but for no more than its own ray can have reached.
    const float share = float(mesh.area() / std::max(double(met.size()), 1.0));
    for (PickedLight& picked : met) picked.light.position.w = std::min(picked.light.position.w, share);
    return met;
}

}  // namespace conebook
