#include "19_vertex_radiosity/further_lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

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
    table.add("rays", params.rays, 1, 64, "", "rays of each light");
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
    std::optional<std::size_t> middle;
    glm::vec3 flux(0.0f);
    float area = 0.0f;
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const std::size_t id = emitters[i];
        flux += mesh.emitted[id];
        area += mesh.patches[id].position.w;
        const double after = before + sum_of(mesh.emitted[id]);
        if (!middle && std::floor(after / run + 0.5) > std::floor(before / run + 0.5)) middle = id;
        const bool is_end = std::floor(after / run) > std::floor(before / run) || i + 1 == emitters.size();
        before = after;
        if (!each && !is_end) continue;
        // The patch in the middle of a run stands for it.
        const shared::Patch& patch = mesh.patches[each ? id : middle.value_or(id)];
        PickedLight picked;
        picked.light = {glm::vec4(glm::vec3(patch.position), area), patch.normal, glm::vec4(flux, 0.0f)};
        lights.push_back(picked);
        flux = glm::vec3(0.0f);
        area = 0.0f;
        middle.reset();
    }
    return lights;
}

std::vector<PickedLight> next_bounce(const SceneTracer& tracer, const std::vector<PickedLight>& lights,
                                     const FurtherLightParams& params, double mesh_area)
{
    std::vector<PickedLight> met;
    const std::size_t count = lights.size() * std::size_t(params.rays);
    for (std::size_t i = 0; i < count; ++i) {
        const PickedLight& from = lights[i / std::size_t(params.rays)];
        const glm::vec3 normal(from.light.normal);
        // snippet: ray
        // A diffuse light sends its flux by the cosine of the angle to its normal; so are the rays distributed, and each
        // carries the same share.
        const glm::dvec2 u = even_point(i);
        const double r = std::sqrt(u.x), turn = 2.0 * std::numbers::pi * u.y;
        glm::vec3 direction = Frame(normal).to_scene({r * std::cos(turn), r * std::sin(turn), std::sqrt(1.0 - u.x)});
        if (params.ray == int(RayDirection::mirror))
            direction = from.incoming == glm::vec3(0.0f) ? normal : glm::reflect(from.incoming, normal);
        const auto hit = tracer.intersect({glm::vec3(from.light.position) + tracer.surface_offset() * normal, direction});
        if (!hit || hit->dark) continue;
        const glm::vec3 flux = hit->brdf.rho * glm::vec3(from.light.flux) / float(params.rays);
        // end snippet
        if (flux == glm::vec3(0.0f)) continue;
        // Each stands for its share of all surfaces, but for no more than its own ray can have reached.
        const double reach = std::numbers::pi * hit->distance * hit->distance;
        PickedLight picked;
        picked.light = {glm::vec4(hit->position, std::min(mesh_area / double(count), reach)),
                        glm::vec4(hit->shading_normal, 0.0f), glm::vec4(flux, 0.0f)};
        picked.incoming = direction;
        met.push_back(picked);
    }
    return met;
}

}  // namespace conebook
