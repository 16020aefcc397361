#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "20_form_factor_radiosity/form_factors.hpp"
#include "20_form_factor_radiosity/lamps.hpp"
#include "reference/random.hpp"

namespace conebook {
namespace {

constexpr int kRaysOfPoint = 16;  // from one point of a patch, stratified among themselves

std::uint32_t hash(std::uint64_t a, std::uint64_t b) { return std::uint32_t(mix_bits(mix_bits(a + 77) + b) >> 32); }

}  // namespace

void add_parameters(ParameterTable& table, FormFactorParams& params)
{
    table.add("form_factors", params.form_factors, {"hemicube", "embree", "hybrid"},
              "item buffers, rays, or buffers and rays from mirrors on");
    table.add("resolution", params.resolution, 8, 1024, "texels", "along a side of the hemicube's top");
    table.add("samples", params.samples, 1, kPatchPoints, "places", "of item buffers on a patch; 1: its middle");
    table.add("rays", params.rays, 16, 65536, "rays", "of a patch, with form_factors=embree");
    table.add("aim_at_lamps", params.aim_at_lamps, "form factors of few emitters are exact but for what hides them");
    table.add("reflections", params.reflections, 0, 64, "mirrors", "along a path, at most");
    table.add("texel_weights", params.texel_weights, {"exact", "density", "draft"},
              "of hemicubes; draft: exponent 1 as printed");
}

void RowBuilder::scale(std::size_t first_direct, float direct_scale)
{
    for (std::size_t i = first_direct; i < direct_.size(); ++i) direct_[i].share *= direct_scale;
}

void RowBuilder::append(const RowBuilder& other)
{
    direct_.insert(direct_.end(), other.direct_.begin(), other.direct_.end());
    mirrored_.insert(mirrored_.end(), other.mirrored_.begin(), other.mirrored_.end());
}

FormFactorRow RowBuilder::finish()
{
    FormFactorRow row;
    std::stable_sort(direct_.begin(), direct_.end(), [](const auto& a, const auto& b) { return a.patch < b.patch; });
    for (const FormFactorEntry& f : direct_) {
        if (!row.direct.empty() && row.direct.back().patch == f.patch)
            row.direct.back().share += f.share;
        else
            row.direct.push_back(f);
    }
    const auto key = [](const MirroredFormFactor& f) { return std::pair(f.patch, f.reflections); };
    std::stable_sort(mirrored_.begin(), mirrored_.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    for (const MirroredFormFactor& f : mirrored_) {
        if (!row.mirrored.empty() && key(row.mirrored.back()) == key(f))
            row.mirrored.back().share += f.share;
        else
            row.mirrored.push_back(f);
    }
    row.direct.shrink_to_fit();
    row.mirrored.shrink_to_fit();
    return row;
}

std::size_t FormFactors::entries() const
{
    std::size_t count = 0;
    for (const FormFactorRow& row : rows) count += row.direct.size() + row.mirrored.size();
    return count;
}

std::size_t FormFactors::bytes() const
{
    std::size_t sum = 0;
    for (const FormFactorRow& row : rows)
        sum += row.direct.size() * sizeof(FormFactorEntry) + row.mirrored.size() * sizeof(MirroredFormFactor);
    return sum;
}

// snippet: follow_mirrors
int follow_mirrors(const Patches& patches, SurfaceHit hit, glm::vec3 direction, glm::vec3 share, int reflections,
                   RowBuilder& row)
{
    int rays = 0;
    for (int r = 1; r <= reflections; ++r) {
        const Reflection next = patches.reflect(hit, direction);
        share *= next.weight;
        if (share == glm::vec3(0.0f)) break;
        const auto met = patches.tracer().intersect({next.origin, next.direction});
        ++rays;
        const std::uint32_t patch = met ? patches.at(*met) : kNoPatch;
        if (patch == kNoPatch) break;
        row.add(patch, std::uint32_t(r), share);
        hit = *met;
        direction = next.direction;
    }
    return rays;
}
// end snippet

FormFactors trace_form_factors(const Patches& patches, const FormFactorParams& params)
{
    FormFactors result;
    result.rows.resize(patches.size());
    const SceneTracer& tracer = patches.tracer();
    const Lamps lamps = params.aim_at_lamps ? Lamps(patches) : Lamps();
    std::atomic<std::uint64_t> traced{0};

    for_all(patches.size(), [&](std::size_t i) {
        const Patch& patch = patches[i];
        const int points = std::popcount(patch.exposed);
        if (points == 0) return;
        // A patch in the open takes a new point for every kRaysOfPoint rays.
        const bool is_open = patches.is_open(patch);
        const int places = is_open ? std::max(points, params.rays / kRaysOfPoint) : patches.points();
        const int used = is_open ? places : points;
        const auto per_point = std::uint32_t(std::max(1, params.rays / used));
        const float share = 1.0f / float(per_point * std::uint32_t(used));
        RowBuilder row;
        std::uint64_t rays = 0;

        // Lamps: what of the sky each would fill, times the share of rays that reach it.
        double to_lamps = 0.0;
        for (int k = 0; k < patches.points() && !lamps.empty(); ++k) {
            if ((patch.exposed >> k & 1) == 0) continue;
            const glm::vec3 x = patches.point(patch, k).position;
            rays += std::uint64_t(
                lamps.see(patches, x, patch.normal, std::uint32_t(k), i, 1, [&](std::uint32_t lamp, double factor) {
                    row.add(lamp, float(factor / points));
                    to_lamps += factor / points;
                }));
        }
        const std::size_t first_ray = row.direct_count();

        double met_lamps = 0.0;
        std::uint32_t sequence = 0;
        for (int k = 0; k < places; ++k) {
            if (!is_open && (patch.exposed >> k & 1) == 0) continue;
            const SurfaceHit x = patches.point(patch, k);
            const Frame frame(patch.normal);
            // snippet: cosine_rays
            for (std::uint32_t n = 0; n < per_point; ++n) {
                // Density cos / pi, so that each ray stands for the same share of the form factors.
                const glm::vec2 u = sequence_02(sequence++, hash(i, 2), hash(i, 3));
                const float r = std::sqrt(u.x), phi = 2.0f * kPi * u.y;
                const glm::vec3 direction =
                    frame.to_scene({r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - u.x)});
                const auto hit = tracer.intersect({tracer.leave(x), direction});
                const std::uint32_t seen = hit ? patches.at(*hit) : kNoPatch;
                if (seen == kNoPatch) continue;
                if (lamps.has(seen))
                    met_lamps += double(share);
                else
                    row.add(seen, share);
                rays +=
                    std::uint64_t(follow_mirrors(patches, *hit, direction, glm::vec3(share), params.reflections, row));
            }
            // end snippet
        }
        rays += sequence;
        // What is not lamp fills the rest: the row's sum has no noise in a closed scene.
        if (!lamps.empty() && met_lamps < 1.0)
            row.scale(first_ray, float(std::max(0.0, 1.0 - to_lamps) / (1.0 - met_lamps)));
        result.rows[i] = row.finish();
        traced += rays;
    });
    result.rays = double(traced);
    return result;
}

}  // namespace conebook
