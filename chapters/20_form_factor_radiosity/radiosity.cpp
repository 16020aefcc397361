#include "20_form_factor_radiosity/radiosity.hpp"

#include <algorithm>
#include <cmath>

#include "app/needs.hpp"

namespace conebook {
namespace {

constexpr int kFirstRays = 128;      // of a patch, for the solution that says where to bisect
constexpr double kEmitterKey = 0.1;  // the own irradiance of a lamp hardly shows, so it gets fewer patches
constexpr double kMostRays = 8e6;    // of all patches where they are more than kManyPatches

float brightness(const glm::vec3& v) { return v.x + v.y + v.z; }

// How much light changes between a patch and its neighbours, as a share of itself: 0 .. 2.
std::vector<double> contrasts(const Patches& patches, const Irradiance& irradiance)
{
    const Surfaces surfaces(patches, {});
    double mean = 0.0, area = 0.0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        mean += double(patches[i].area) * double(brightness(irradiance[i]));
        area += double(patches[i].area);
    }
    mean = area > 0.0 ? mean / area : 0.0;
    constexpr double kNoise = 0.02;  // of the first solution
    std::vector<double> result(patches.size(), 0.0);
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const double own = double(brightness(irradiance[i]));
        for (const std::uint32_t n : surfaces.neighbours(std::uint32_t(i))) {
            const double other = double(brightness(irradiance[n])), sum = 0.5 * (own + other) + 0.01 * mean;
            if (sum > 0.0) result[i] = std::max(result[i], std::abs(own - other) / sum - kNoise);
        }
    }
    return result;
}

int rays_of_patch(const Patches& patches, int wanted)
{
    if (patches.size() <= kManyPatches) return wanted;
    return std::min(wanted, std::max(patches.points(), int(kMostRays / double(patches.size()))));
}

}  // namespace

void add_parameters(ParameterTable& table, RadiosityParams& params)
{
    add_parameters(table, params.patches);
    add_parameters(table, params.form_factors);
    add_parameters(table, params.solver);
    add_parameters(table, params.reconstruction);
}

Patches make_patches(const SceneTracer& tracer, const PatchParams& params, const std::vector<Light>& lights)
{
    BisectedMesh mesh(tracer.scene());
    std::vector<char> shines(mesh.nodes().size(), 0);
    for (const Draw& draw : tracer.scene().draws) {
        const Material& m = tracer.scene().materials[std::size_t(draw.material)];
        if (m.emission != glm::vec3(0.0f) || m.unlit)
            std::fill_n(shines.begin() + draw.first_index / 3, draw.index_count / 3, 1);
    }
    const auto budget = std::size_t(params.patches), even = params.adaptive ? (budget + 2) / 3 : budget;
    const double enough = double(params.max_edge) * double(params.max_edge);
    mesh.refine(even, enough, [&](std::uint32_t node) {
        const double edge = mesh.longest_edge(node);
        return edge * edge * (shines[mesh.nodes()[node].triangle] != 0 && enough == 0.0 ? kEmitterKey : 1.0);
    });
    if (!params.adaptive || mesh.leaf_count() >= budget) return Patches(tracer, params, std::move(mesh));

    // snippet: adapt
    // Twice: a solution, coarse and by few rays, and bisection where light changes. A change over a patch shrinks
    // with its width, and what it spoils with its area.
    for (const std::size_t leaves : {(2 * budget + 1) / 3, budget}) {
        Patches coarse(tracer, params, std::move(mesh));
        coarse.light(lights);
        const FormFactors factors = trace_form_factors(coarse, {.rays = kFirstRays});
        const std::vector<double> contrast =
            contrasts(coarse, solve_radiosity(coarse, factors, {.bounces = 3}).irradiance());
        mesh = coarse.mesh();
        const auto known = std::int64_t(mesh.nodes().size());
        std::vector<double> of_node(mesh.nodes().size(), 0.0);
        for (std::size_t i = 0; i < coarse.size(); ++i)
            of_node[coarse[i].node] = std::max(of_node[coarse[i].node], contrast[i]);
        mesh.refine(leaves, 0.0, [&](std::uint32_t node) {
            std::int64_t ancestor = node;
            while (ancestor >= known) ancestor = mesh.nodes()[std::size_t(ancestor)].parent;
            const double area = mesh.area(node), shrunk = area / std::max(mesh.area(std::uint32_t(ancestor)), 1e-300);
            return of_node[std::size_t(ancestor)] * std::sqrt(shrunk) * area;
        });
    }
    // end snippet
    return Patches(tracer, params, std::move(mesh));
}

Radiosity::Radiosity(gl::Shaders& shaders, const Scene& scene) : shaders_(&shaders), scene_(&scene), tracer_(scene) {}

bool Radiosity::make_patches(const RadiosityParams& params, const GpuScene& scene)
{
    // Even patches do not depend on the lights.
    const Revision lights = params.patches.adaptive ? scene.lights_revision() : 0;
    if (!patches_from_.differs(params.patches, lights)) return false;
    patches_ = std::make_unique<Patches>(conebook::make_patches(tracer_, params.patches, scene.lights()));
    ++patches_revision_;
    return true;
}

bool Radiosity::find_form_factors(const RadiosityParams& params)
{
    if (!factors_from_.differs(params.form_factors, patches_revision_)) return false;
    FormFactorParams wanted = params.form_factors;
    wanted.rays = rays_of_patch(*patches_, wanted.rays);
    if (wanted.form_factors == int(FormFactorMethod::embree)) {
        form_factors_ = trace_form_factors(*patches_, wanted);
    } else {
        form_factors_ = render_form_factors(hemicubes(), *patches_, wanted);
    }
    ++factors_revision_;
    return true;
}

bool Radiosity::light_patches(const GpuScene& scene)
{
    if (!lit_from_.differs(patches_revision_, scene.lights_revision())) return false;
    patches_->light(scene.lights());
    ++lit_revision_;
    return true;
}

bool Radiosity::solve(const RadiosityParams& params)
{
    if (!solution_from_.differs(params.solver, factors_revision_, lit_revision_)) return false;
    solution_ = solve_radiosity(*patches_, form_factors_, params.solver);
    ++solution_revision_;
    return true;
}

Irradiance Radiosity::light_of(const Lamps& lamps) const
{
    Irradiance sum(patches_->size(), glm::vec3(0.0f));
    for (std::size_t i = 0; i < sum.size(); ++i)
        for (const FormFactorEntry& f : form_factors_.rows[i].direct)
            if (lamps.has(f.patch)) sum[i] += f.share * (*patches_)[f.patch].emitted;
    return sum;
}

bool Radiosity::fit_corners(const RadiosityParams& params)
{
    if (!corners_from_.differs(params.reconstruction, solution_revision_)) return false;
    surfaces_ = std::make_unique<Surfaces>(*patches_, params.reconstruction);
    corners_.clear();
    // Specular surfaces show what others had some bounces earlier.
    const std::size_t first = has_specular_surfaces(*scene_) ? 0 : solution_.after.size() - 1;
    const Lamps lamps(*patches_);
    const Irradiance none(patches_->size(), glm::vec3(0.0f)), from_lamps = light_of(lamps);
    for (std::size_t i = first; i < solution_.after.size(); ++i) {
        const bool is_dark = i == 0 && solution_.after.size() > 1;  // no bounce yet
        corners_.push_back(is_dark || params.solver.bounces == 0
                               ? surfaces_->corners(none, none, Lamps())
                               : surfaces_->corners(solution_.after[i], from_lamps, lamps));
    }
    ++corners_revision_;
    return true;
}

Hemicubes& Radiosity::hemicubes()
{
    if (!hemicubes_) hemicubes_ = std::make_unique<Hemicubes>(*shaders_, *scene_);
    return *hemicubes_;
}

const CornerValues* Radiosity::corners_before(int mirrors) const
{
    const Irradiance* const before = solution_.before(mirrors);
    return before == nullptr ? nullptr : &corners_[std::size_t(before - solution_.after.data())];
}

std::vector<Count> Radiosity::counts() const
{
    const double patches = double(patches_->size());
    return {{"patches", patches, ""},
            {"form factors", double(form_factors_.entries()), ""},
            {"rays", form_factors_.rays, ""},
            {"item buffers", form_factors_.item_buffers, ""},
            {"sweeps", double(solution_.sweeps), ""},
            {"residual", solution_.residual, "W/m^2"},
            {"error bound", solution_.error_bound, "W/m^2"},
            {"norm q", solution_.norm, ""}};
}

std::vector<gl::Resource> Radiosity::resources() const
{
    std::vector<gl::Resource> list{
        {"patches", patches_->size() * sizeof(Patch) + patches_->mesh().nodes().size() * sizeof(PatchNode)},
        {"form factors", form_factors_.bytes()}};
    if (hemicubes_)
        for (const gl::Resource& r : hemicubes_->resources()) list.push_back(r);
    return list;
}

std::vector<Need> Radiosity::needs(const RadiosityParams& params) const
{
    const std::size_t planes = mirror_planes(*patches_);
    const int method = params.form_factors.form_factors;
    constexpr const char* kNames[] = {"form_factors=hemicube", "form_factors=embree", "form_factors=hybrid"};
    std::string mirrors = "no surface is smoother than mirror_roughness";
    if (planes > 0) mirrors = std::to_string(planes) + " mirror planes";
    const bool cameras = method == int(FormFactorMethod::hemicube) && planes > 0 && planes <= kMostMirrorPlanes;
    const int rays = rays_of_patch(*patches_, params.form_factors.rays);
    const bool fewer = method == int(FormFactorMethod::embree) && rays < params.form_factors.rays;
    return {{"item buffers", method != int(FormFactorMethod::embree), kNames[method]},
            {"mirrored item buffers", cameras, mirrors + (planes > kMostMirrorPlanes ? ": too many, traced" : "")},
            {"mirror paths", planes > 0, mirrors},
            {"fewer rays than asked for", fewer,
             fewer ? std::to_string(rays) + " of a patch, since there are many" : "few enough patches"},
            {"reflectance lowered", solution_.dimmed > 0,
             std::to_string(solution_.dimmed) + " patches reflect all light, and all bounces are wanted"}};
}

}  // namespace conebook
