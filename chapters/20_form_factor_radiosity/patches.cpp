#include "20_form_factor_radiosity/patches.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "reference/path_tracer.hpp"
#include "reference/random.hpp"

namespace conebook {
namespace {

std::uint32_t hash(std::uint64_t a, std::uint64_t b) { return std::uint32_t(mix_bits(mix_bits(a + 1) + b) >> 32); }

// Bits of i in reverse: the radical inverse in base 2.
std::uint32_t reversed(std::uint32_t i)
{
    i = (i << 16) | (i >> 16);
    i = ((i & 0x00ff00ffu) << 8) | ((i & 0xff00ff00u) >> 8);
    i = ((i & 0x0f0f0f0fu) << 4) | ((i & 0xf0f0f0f0u) >> 4);
    i = ((i & 0x33333333u) << 2) | ((i & 0xccccccccu) >> 2);
    return ((i & 0x55555555u) << 1) | ((i & 0xaaaaaaaau) >> 1);
}

// Dimension 2 of Sobol's sequence (Kollig & Keller 2002, appendix).
std::uint32_t sobol_2(std::uint32_t i)
{
    std::uint32_t r = 0;
    for (std::uint32_t v = 1u << 31; i != 0; i >>= 1, v ^= v >> 1)
        if (i & 1u) r ^= v;
    return r;
}

}  // namespace

bool is_buried(const SceneTracer& tracer, const glm::vec3& point, const glm::vec3& normal, std::uint32_t seed)
{
    const Frame frame(normal);
    int backs = 0;
    for (int i = 0; i < 8; ++i) {
        const glm::vec2 u = sequence_02(std::uint32_t(i), seed, mix_bits(seed) & 0xffffffffu);
        const float r = std::sqrt(u.x), phi = 2.0f * kPi * u.y;
        const glm::vec3 d = frame.to_scene({r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - u.x)});
        const auto hit = tracer.intersect({point + tracer.surface_offset() * normal, d});
        backs += hit && hit->dark ? 1 : 0;
        if (backs == 0 && i == 1) return false;  // in the open, as nearly all are
    }
    return backs > 4;
}

void add_parameters(ParameterTable& table, PatchParams& params)
{
    table.add("patches", params.patches, 1, 400000, "patches",
              "budget of the mesh; a scene of more triangles keeps them");
    table.add("max_edge", params.max_edge, 0.0, 1000.0, "m", "longest edge of a patch; 0: what the budget gives");
    table.add("adaptive", params.adaptive, "spend half of the budget where a first solution has its gradients");
    table.add("mirror_roughness", params.mirror_roughness, 0.0, 1.0, "", "smoother lobes are mirrors, others diffuse");
    table.add("fresnel", params.fresnel, "mirrors reflect more at grazing angles (Schlick); off: F0 at every angle");
}

glm::vec2 sequence_02(std::uint32_t i, std::uint32_t scramble_x, std::uint32_t scramble_y)
{
    return {float((reversed(i) ^ scramble_x) >> 8) * 0x1p-24f, float((sobol_2(i) ^ scramble_y) >> 8) * 0x1p-24f};
}

glm::vec3 triangle_weights(glm::vec2 u)
{
    const float s = std::sqrt(u.x);
    return {1.0f - s, s * (1.0f - u.y), s * u.y};
}

glm::vec3 mean_reflectance(const glm::vec3& f0, const glm::vec3& f90) { return f0 + (f90 - f0) / 21.0f; }

void for_all(std::size_t count, const std::function<void(std::size_t)>& work)
{
    constexpr std::size_t kChunk = 16;
    std::atomic<std::size_t> next{0};
    std::exception_ptr fault;
    std::mutex fault_lock;
    const auto run = [&] {
        try {
            for (std::size_t begin; (begin = next.fetch_add(kChunk)) < count;)
                for (std::size_t i = begin; i < std::min(begin + kChunk, count); ++i) work(i);
        } catch (...) {
            const std::lock_guard lock(fault_lock);
            fault = std::current_exception();
            next = count;
        }
    };
    {
        std::vector<std::jthread> others;
        for (unsigned t = 1; t < std::max(1u, std::thread::hardware_concurrency()); ++t) others.emplace_back(run);
        run();
    }
    if (fault) std::rethrow_exception(fault);
}

glm::vec3 directly_lit(const SceneTracer& tracer, const std::vector<Light>& lights, const SurfaceHit& hit,
                       const glm::vec3& rho)
{
    glm::vec3 irradiance(0.0f);
    const float diameter = glm::length(tracer.scene().bounds.extent());
    for (const Light& light : lights) {
        glm::vec3 target;
        const glm::vec3 facing = unshadowed_irradiance(light, hit.position, diameter, &target);
        const glm::vec3 way = target - hit.position;
        const float distance = glm::length(way);
        if (facing == glm::vec3(0.0f) || !(distance > 0.0f)) continue;
        const float cosine = glm::dot(way, hit.shading_normal) / distance;
        if (cosine <= 0.0f || glm::dot(way, hit.geometric_normal) <= 0.0f) continue;
        if (!tracer.occluded(tracer.leave(hit), target)) irradiance += cosine * facing;
    }
    return rho * irradiance;
}

Patches::Patches(const SceneTracer& tracer, const PatchParams& params, BisectedMesh mesh)
    : tracer_(&tracer), params_(params), mesh_(std::move(mesh))
{
    const Scene& scene = tracer.scene();
    draw_of_.resize(scene.triangle_count());
    for (std::uint32_t d = 0; d < scene.draws.size(); ++d)
        std::fill_n(draw_of_.begin() + scene.draws[d].first_index / 3, scene.draws[d].index_count / 3, d);
    front_.assign(mesh_.nodes().size(), kNoPatch);
    back_ = front_;
    for (const std::uint32_t leaf : mesh_.leaves()) {
        const std::uint32_t draw = draw_of_[mesh_.nodes()[leaf].triangle];
        if (!(mesh_.area(leaf) > 0.0)) continue;
        front_[leaf] = std::uint32_t(patches_.size());
        patches_.push_back({.node = leaf, .back = false, .draw = draw});
        if (!scene.materials[std::size_t(scene.draws[draw].material)].double_sided) continue;
        back_[leaf] = std::uint32_t(patches_.size());
        patches_.push_back({.node = leaf, .back = true, .draw = draw});
    }
    for_all(patches_.size(), [&](std::size_t i) { fill(std::uint32_t(i)); });
    for (const Patch& patch : patches_) has_mirrors_ = has_mirrors_ || patch.mirror;
}

void Patches::fill(std::uint32_t index)
{
    Patch& patch = patches_[index];
    const SurfaceHit middle = point(patch, glm::vec3(1.0f / 3.0f));
    patch.normal = middle.geometric_normal;
    int exposed = 0, mirrors = 0;
    glm::vec3 all_centers(0.0f);
    for (int k = 0; k < points(); ++k) {
        const SurfaceHit p = point(patch, k);
        all_centers += p.position;
        if (is_buried(*tracer_, p.position, p.geometric_normal, hash(index, std::uint64_t(k)))) continue;
        patch.exposed = std::uint16_t(patch.exposed | 1u << k);
        ++exposed;
        patch.center += p.position;
        patch.rho += p.brdf.rho;
        patch.emitted += kPi * p.emission;
        if (is_mirror(p.brdf)) {
            ++mirrors;
            patch.f0 += p.brdf.f0;
            patch.f90 += p.brdf.f90;
        } else if (p.brdf.has_specular()) {
            patch.rho += mean_reflectance(p.brdf.f0, p.brdf.f90);
        }
    }
    if (exposed == 0) {
        patch.center = all_centers / float(points());
        return;
    }
    const float scale = 1.0f / float(exposed);
    for (glm::vec3* mean : {&patch.center, &patch.rho, &patch.emitted, &patch.f0, &patch.f90}) *mean *= scale;
    if (is_open(patch)) patch.center = middle.position;
    patch.mirror = mirrors > 0;
    patch.area = float(mesh_.area(patch.node)) * float(exposed) / float(points());
}

void Patches::light(const std::vector<Light>& lights)
{
    for_all(patches_.size(), [&](std::size_t i) {
        Patch& patch = patches_[i];
        patch.lit = glm::vec3(0.0f);
        int exposed = 0;
        for (int k = 0; k < points(); ++k) {
            if ((patch.exposed >> k & 1) == 0) continue;
            ++exposed;
            const SurfaceHit p = point(patch, k);
            glm::vec3 rho = p.brdf.rho;
            if (!is_mirror(p.brdf) && p.brdf.has_specular()) rho += mean_reflectance(p.brdf.f0, p.brdf.f90);
            patch.lit += directly_lit(*tracer_, lights, p, rho);
        }
        if (exposed > 0) patch.lit /= float(exposed);
    });
}

std::uint32_t Patches::triangle(const SurfaceHit& hit) const
{
    return tracer_->scene().draws[hit.draw].first_index / 3 + hit.triangle;
}

PatchPlace Patches::place(const SurfaceHit& hit) const
{
    // Barycentrics of the position, which the hit was made from.
    const std::uint32_t t = triangle(hit);
    const auto& c = mesh_.nodes()[t].corners;
    const glm::dvec3 a(mesh_.points()[c[0]]), e1 = glm::dvec3(mesh_.points()[c[1]]) - a,
                                              e2 = glm::dvec3(mesh_.points()[c[2]]) - a,
                                              p = glm::dvec3(hit.position) - a;
    const double d11 = glm::dot(e1, e1), d12 = glm::dot(e1, e2), d22 = glm::dot(e2, e2), p1 = glm::dot(p, e1),
                 p2 = glm::dot(p, e2), determinant = d11 * d22 - d12 * d12;
    if (!(determinant > 0.0)) return {t, glm::vec3(1.0f / 3.0f)};
    const double u = std::clamp((d22 * p1 - d12 * p2) / determinant, 0.0, 1.0);
    const double v = std::clamp((d11 * p2 - d12 * p1) / determinant, 0.0, 1.0 - u);
    return mesh_.find(t, {float(u), float(v)});
}

std::uint32_t Patches::at(const SurfaceHit& hit) const { return hit.dark ? kNoPatch : on(place(hit).node, hit.front); }

SurfaceHit Patches::point(const Patch& patch, int k) const
{
    // Steps of 1 / g and 1 / g^2 with g^3 = g + 1, which no power of 2 repeats (Roberts 2018, "The unreasonable
    // effectiveness of quasirandom sequences", R2): rays are of a sequence in base 2, and places of the same base
    // would move in step with their directions.
    constexpr glm::dvec2 kStep(0.7548776662466927, 0.5698402909980532);
    const std::uint64_t bits = mix_bits(2 * std::uint64_t(patch.node) + (patch.back ? 1 : 0) + 1);
    const glm::dvec2 begin(double(bits >> 32) * 0x1p-32, double(bits & 0xffffffffu) * 0x1p-32);
    return point(patch, triangle_weights(glm::vec2(glm::fract(begin + double(k) * kStep))));
}

SurfaceHit Patches::point(const Patch& patch, const glm::vec3& weights) const
{
    const Scene& scene = tracer_->scene();
    const PatchNode& node = mesh_.nodes()[patch.node];
    const glm::vec2 uv = weights.x * node.uv[0] + weights.y * node.uv[1] + weights.z * node.uv[2];
    const auto& root = mesh_.nodes()[node.triangle].corners;
    const glm::vec3 a = mesh_.points()[root[0]], b = mesh_.points()[root[1]], c = mesh_.points()[root[2]];
    const glm::vec3 front = glm::cross(b - a, c - a);
    return evaluate_surface(scene, patch.draw, node.triangle - scene.draws[patch.draw].first_index / 3, uv.x, uv.y,
                            patch.back ? front : -front);
}

bool Patches::is_mirror(const Brdf& brdf) const
{
    const float roughness = std::max(params_.mirror_roughness, kMinRoughness);
    return brdf.has_specular() && brdf.alpha <= roughness * roughness * 1.00001f;
}

glm::vec3 Patches::mirror_share(const glm::vec3& f0, const glm::vec3& f90, float cosine) const
{
    if (!params_.fresnel) return f0;
    const float m = std::clamp(1.0f - cosine, 0.0f, 1.0f);
    return f0 + (f90 - f0) * (m * m * m * m * m);
}

Reflection Patches::reflect(const SurfaceHit& hit, const glm::vec3& direction) const
{
    Reflection next{tracer_->leave(hit), direction, glm::vec3(0.0f)};
    if (!is_mirror(hit.brdf)) return next;
    // Smooth curved mirrors reflect about the interpolated normal, unless that leads into the surface.
    glm::vec3 n = hit.shading_normal;
    if (glm::dot(glm::reflect(direction, n), hit.geometric_normal) <= 0.0f) n = hit.geometric_normal;
    next.direction = glm::normalize(glm::reflect(direction, n));
    next.weight = mirror_share(hit.brdf.f0, hit.brdf.f90, std::abs(glm::dot(direction, n)));
    return next;
}

Patches::Brightest Patches::brightest() const
{
    Brightest result;
    for (const Patch& patch : patches_) {
        const glm::vec3 sum = patch.rho + (params_.fresnel ? mean_reflectance(patch.f0, patch.f90) : patch.f0);
        const float largest = std::max(sum.x, std::max(sum.y, sum.z));
        result.reflectance = std::max(result.reflectance, largest);
        result.without_loss += largest >= 1.0f ? 1 : 0;
    }
    return result;
}

}  // namespace conebook
