#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "20_form_factor_radiosity/hemicube.hpp"

namespace conebook {
namespace {

// A plane on which mirrors lie, its normal towards the side that reflects.
struct MirrorPlane {
    glm::vec3 normal;
    float distance;  // dot(normal, position) of its points
};

// The flat mirrors of a scene: which plane each side of a triangle lies on, if any.
struct FlatMirrors {
    std::vector<MirrorPlane> planes;
    std::vector<int> of_side;  // 2 * triangle + (0 front, 1 back); -1: no mirror
};

FlatMirrors flat_mirrors(const Patches& patches)
{
    FlatMirrors mirrors;
    mirrors.of_side.assign(2 * patches.tracer().scene().triangle_count(), -1);
    const float tolerance = 4.0f * patches.tracer().surface_offset();
    for (const Patch& patch : patches.all()) {
        if (!patch.mirror) continue;
        const PatchNode& node = patches.mesh().nodes()[patch.node];
        int& plane = mirrors.of_side[2 * std::size_t(node.triangle) + (patch.back ? 1 : 0)];
        if (plane >= 0) continue;
        const float distance = glm::dot(patch.normal, patches.mesh().points()[node.corners[0]]);
        for (std::size_t p = 0; p < mirrors.planes.size() && plane < 0; ++p)
            if (glm::dot(mirrors.planes[p].normal, patch.normal) > 1.0f - 1e-6f &&
                std::abs(mirrors.planes[p].distance - distance) <= tolerance)
                plane = int(p);
        if (plane >= 0) continue;
        plane = int(mirrors.planes.size());
        mirrors.planes.push_back({patch.normal, distance});
    }
    return mirrors;
}

// An item buffer that is still to be made: the same texels as the first one, but only those that a mirror sends
// there.
struct Job {
    std::uint32_t patch = 0;  // whose row it belongs to
    HemicubeView view;
    std::uint32_t reflections = 0;
    std::vector<std::pair<std::uint32_t, glm::vec3>>
        texels;  // and their share of the row; all of them in the first one
};

SurfaceHit surface_of(const Patches& patches, const Item& item, const glm::vec3& direction_hint)
{
    const Scene& scene = patches.tracer().scene();
    std::uint32_t draw = 0;
    while (item.triangle() >= (scene.draws[draw].first_index + scene.draws[draw].index_count) / 3) ++draw;
    return evaluate_surface(scene, draw, item.triangle() - scene.draws[draw].first_index / 3, item.uv().x, item.uv().y,
                            direction_hint);
}

bool is_hole(const Patches& patches, const SurfaceHit& hit, const Item& item)
{
    const Scene& scene = patches.tracer().scene();
    const Draw& draw = scene.draws[hit.draw];
    return !covers(scene, scene.materials[std::size_t(draw.material)],
                   triangle_point(scene, draw, hit.triangle, item.uv().x, item.uv().y));
}

bool is_masked(const Scene& scene)
{
    for (const Material& m : scene.materials)
        if (m.alpha_mode == AlphaMode::mask) return true;
    return false;
}

class Reader {
public:
    Reader(const Patches& patches, const FlatMirrors& mirrors, bool trace_mirrors, int reflections)
        : patches_(patches),
          mirrors_(mirrors),
          trace_mirrors_(trace_mirrors),
          reflections_(reflections),
          masked_(is_masked(patches.tracer().scene()))
    {
    }

    // One texel with its share. What a mirror sends on becomes part of a job in `next`, one for each mirror plane.
    void read(const Job& job, const Item& item, std::uint32_t texel, const glm::vec3& share, RowBuilder& row,
              std::map<int, Job>& next, int& rays) const
    {
        if (!item.seen()) return;
        const std::uint32_t leaf = patches_.mesh().find(item.triangle(), item.uv()).node;
        const std::uint32_t seen = patches_.on(leaf, item.front());
        if (masked_ && read_through_hole(job, item, share, row, rays)) return;
        if (seen == kNoPatch) return;
        enter(row, seen, job.reflections, share);
        if (!patches_[seen].mirror || int(job.reflections) >= reflections_) return;
        const int plane = mirrors_.of_side[2 * std::size_t(item.triangle()) + (item.front() ? 0 : 1)];
        if (plane < 0) return;
        const glm::vec3 towards = position_of(item) - job.view.eye;
        const glm::vec3 direction = glm::normalize(towards);
        if (trace_mirrors_ && job.reflections == 0) {
            rays +=
                follow_mirrors(patches_, surface_of(patches_, item, direction), direction, share, reflections_, row);
            return;
        }
        // snippet: mirrored_view
        // The eye and its axes reflected in the mirror's plane: there the same texel looks along the same ray,
        // reflected.
        const MirrorPlane& m = mirrors_.planes[std::size_t(plane)];
        Job& mirrored = next[plane];
        if (mirrored.texels.empty()) {
            mirrored.patch = job.patch;
            mirrored.reflections = job.reflections + 1;
            mirrored.view = job.view;
            mirrored.view.eye -= 2.0f * (glm::dot(m.normal, job.view.eye) - m.distance) * m.normal;
            for (int axis = 0; axis < 3; ++axis) mirrored.view.axes[axis] = glm::reflect(job.view.axes[axis], m.normal);
            mirrored.view.clip = glm::vec4(m.normal, -m.distance - patches_.tracer().surface_offset());
        }
        const Patch& mirror = patches_[seen];
        mirrored.texels.emplace_back(
            texel, share * patches_.mirror_share(mirror.f0, mirror.f90, std::abs(glm::dot(direction, m.normal))));
        // end snippet
    }

    glm::vec3 position_of(const Item& item) const
    {
        const auto& c = patches_.mesh().nodes()[item.triangle()].corners;
        const auto& points = patches_.mesh().points();
        const glm::vec2 uv = item.uv();
        return (1.0f - uv.x - uv.y) * points[c[0]] + uv.x * points[c[1]] + uv.y * points[c[2]];
    }

private:
    static void enter(RowBuilder& row, std::uint32_t patch, std::uint32_t reflections, const glm::vec3& share)
    {
        if (reflections == 0)
            row.add(patch, share.x);
        else
            row.add(patch, reflections, share);
    }

    // The hole of an alpha mask: a ray goes on from there, since only one surface a texel was kept.
    bool read_through_hole(const Job& job, const Item& item, const glm::vec3& share, RowBuilder& row, int& rays) const
    {
        const glm::vec3 direction = glm::normalize(position_of(item) - job.view.eye);
        const SurfaceHit hit = surface_of(patches_, item, direction);
        if (!is_hole(patches_, hit, item)) return false;
        const auto behind = patches_.tracer().intersect({hit.position, direction, patches_.tracer().surface_offset()});
        ++rays;
        const std::uint32_t seen = behind ? patches_.at(*behind) : kNoPatch;
        if (seen != kNoPatch) enter(row, seen, job.reflections, share);
        return true;
    }

    const Patches& patches_;
    const FlatMirrors& mirrors_;
    bool trace_mirrors_;
    int reflections_;
    bool masked_;
};

}  // namespace

std::size_t mirror_planes(const Patches& patches) { return flat_mirrors(patches).planes.size(); }

FormFactorRow hemicube_row(Hemicubes& hemicubes, const Patches& patches, const HemicubeView& view, int resolution,
                           TexelWeights weights)
{
    const std::vector<float> texel_weights = hemicube_weights(resolution, weights);
    const std::vector<Item> items = hemicubes.render({view}, resolution);
    const FlatMirrors mirrors = flat_mirrors(patches);
    const Reader reader(patches, mirrors, false, 0);
    RowBuilder row;
    std::map<int, Job> none;
    int rays = 0;
    Job job;
    job.view = view;
    for (std::uint32_t t = 0; t < items.size(); ++t)
        reader.read(job, items[t], t, glm::vec3(texel_weights[t]), row, none, rays);
    return row.finish();
}

FormFactors render_form_factors(Hemicubes& hemicubes, const Patches& patches, const FormFactorParams& params)
{
    FormFactors result;
    result.rows.resize(patches.size());
    const int resolution = params.resolution / 2 * 2;
    const std::vector<float> weights = hemicube_weights(resolution, TexelWeights(params.texel_weights));
    const FlatMirrors mirrors = flat_mirrors(patches);
    const bool trace =
        params.form_factors == int(FormFactorMethod::hybrid) || mirrors.planes.size() > kMostMirrorPlanes;
    const Reader reader(patches, mirrors, trace, params.reflections);
    std::vector<RowBuilder> rows(patches.size());
    std::atomic<std::uint64_t> rays{0};

    // First the views of all patches, then what mirrors show in them, then mirrors in mirrors.
    std::vector<Job> jobs;
    std::vector<float> scale(patches.size(), 0.0f);
    const auto job_of = [&](std::uint32_t patch, const SurfaceHit& point) {
        Job job;
        job.patch = patch;
        job.view = hemicube_view(patches, patch, point);
        return job;
    };
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        const Patch& patch = patches[i];
        int places = 0;
        if (params.samples == 1 && patches.is_open(patch)) {
            jobs.push_back(job_of(i, patches.point(patch, glm::vec3(1.0f / 3.0f))));
            places = 1;
        } else {
            for (int k = 0; k < patches.points() && places < params.samples; ++k) {
                if ((patch.exposed >> k & 1) == 0) continue;
                jobs.push_back(job_of(i, patches.point(patch, k)));
                ++places;
            }
        }
        scale[i] = places > 0 ? 1.0f / float(places) : 0.0f;
    }
    const std::size_t batch = Hemicubes::batch(resolution);
    while (!jobs.empty()) {
        std::vector<Job> next;
        for (std::size_t first = 0; first < jobs.size(); first += batch) {
            const std::size_t count = std::min(batch, jobs.size() - first);
            std::vector<HemicubeView> views;
            for (std::size_t i = 0; i < count; ++i) views.push_back(jobs[first + i].view);
            const std::vector<Item> items = hemicubes.render(views, resolution);
            result.item_buffers += double(count);
            std::vector<std::map<int, Job>> made(count);
            std::vector<RowBuilder> parts(count);
            for_all(count, [&](std::size_t i) {
                const Job& job = jobs[first + i];
                const Item* const own = &items[i * weights.size()];
                int traced = 0;
                if (job.reflections == 0)
                    for (std::uint32_t t = 0; t < weights.size(); ++t)
                        reader.read(job, own[t], t, glm::vec3(weights[t] * scale[job.patch]), parts[i], made[i],
                                    traced);
                for (const auto& [texel, share] : job.texels)
                    reader.read(job, own[texel], texel, share, parts[i], made[i], traced);
                rays += std::uint64_t(traced);
            });
            for (std::size_t i = 0; i < count; ++i) {
                rows[jobs[first + i].patch].append(parts[i]);
                for (auto& [plane, job] : made[i]) next.push_back(std::move(job));
            }
        }
        jobs = std::move(next);
    }
    for_all(patches.size(), [&](std::size_t i) { result.rows[i] = rows[i].finish(); });
    result.rays = double(rays);
    return result;
}

}  // namespace conebook
