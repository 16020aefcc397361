#include "19_vertex_radiosity/vertex_radiosity.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace conebook {
namespace {

constexpr std::size_t kMostPicked = 4096;  // lights that all views together make

std::vector<shared::PatchLight> light_list(const std::vector<PickedLight>& picked, const glm::dvec3& factor)
{
    std::vector<shared::PatchLight> list;
    for (const PickedLight& p : picked) {
        list.push_back(p.light);
        list.back().flux = glm::vec4(glm::vec3(factor) * glm::vec3(p.light.flux), 0.0f);
    }
    return list;
}

std::string number_of(std::size_t count, const std::string& of) { return std::to_string(count) + " " + of; }

}  // namespace

void add_parameters(ParameterTable& table, VertexRadiosityParams& params)
{
    add_parameters(table, params.mesh);
    table.add("bounces", params.bounces, -1, 64, "", "indirect bounces; -1: all");
    table.add("steps", params.steps, 0, 3, "", "the document's steps: 1 direct, 2 and 3 a bounce more; 0: as bounces says");
    add_parameters(table, params.pick);
    add_parameters(table, params.further);
    table.add("form_factor", params.form_factor, {"exact", "published"}, "light from patch to patch");
    table.add("half_texel", params.half_texel, "draw patches at the middle of their texel in the map");
}

int asked_bounces(const VertexRadiosityParams& params) { return params.steps > 0 ? params.steps - 1 : params.bounces; }

double further_bounces_factor(double share, int bounces)
{
    constexpr int kMost = 64;
    const int terms = bounces < 0 || bounces > kMost ? kMost : bounces - 1;
    double sum = 0.0, term = 1.0;
    for (int i = 0; i < terms; ++i, term *= share) sum += term;
    // The rest of the series, where it has one.
    return bounces < 0 && share < 1.0 - 1.0 / kMost ? sum + term / (1.0 - share) : sum;
}

VertexRadiosity::VertexRadiosity(gl::Shaders& shaders, const Scene& source, const VertexRadiosityParams& params)
    : source_(source), params_(params), map_(shaders), picker_(shaders)
{
}

void VertexRadiosity::run(App& app, const GpuScene& scene)
{
    run([&](const char* name, Scope scope, const std::function<bool()>& work) { app.pass(name, scope, work); }, scene);
}

// snippet: steps
void VertexRadiosity::run(const RunPass& pass, const GpuScene& scene)
{
    check(params_.pick);
    // Patches.
    pass("subdivision", Scope::scene, [&] { return mesh_step(); });
    // Step 1: the lights light the patches.
    pass("direct light of patches", Scope::light, [&] { return direct_step(scene); });
    // Step 2: those that a light sees most of, and those that shine, become lights.
    pass("picked lights", Scope::light, [&] { return pick_step(scene); });
    // Step 3: what their rays meet does, too.
    pass("rays of lights", Scope::light, [&] { return ray_step(); });
    // All of these light the patches.
    pass("indirect light of patches", Scope::light, [&] { return indirect_step(); });
}
// end snippet

bool VertexRadiosity::mesh_step()
{
    if (!mesh_of_.differs(params_.mesh.max_edge)) return false;
    if (!tracer_) tracer_.emplace(source_);
    mesh_ = subdivide(source_, params_.mesh);
    buffers_.upload(mesh_);
    ++mesh_revision_;
    return true;
}

bool VertexRadiosity::direct_step(const GpuScene& scene)
{
    if (!direct_of_.differs(mesh_revision_, scene.lights_revision(), params_.half_texel)) return false;
    map_.clear(int(mesh_.patches.size()));
    map_.add_direct(buffers_, scene, sight_of(*tracer_, mesh_.patches, scene.lights()), params_.half_texel);
    ++direct_revision_;
    return true;
}

bool VertexRadiosity::pick_step(const GpuScene& scene)
{
    const bool used = asked_bounces(params_) != 0;
    if (!second_of_.differs(direct_revision_, params_.pick, params_.further.emitter_lights, used)) return false;
    second_.clear();
    views_.clear();
    reflected_ = glm::dvec3(0.0);
    if (used) {
        views_ = light_views(scene.lights(), scene.bounds());
        cells_ = params_.pick.cells;
        while (cells_ > 1 && views_.size() * std::size_t(cells_ * cells_) > kMostPicked) cells_ /= 2;
        for (std::size_t i = 0; i < views_.size(); ++i) {
            picker_.look(scene, views_[i], int(i), buffers_, map_, params_.pick, cells_);
            const std::vector<PickedLight> picked = picker_.lights(views_[i], scene, mesh_, params_.pick);
            second_.insert(second_.end(), picked.begin(), picked.end());
            reflected_ += picker_.reflected_flux();
        }
        const std::vector<PickedLight> shining = emitter_lights(mesh_, params_.further);
        second_.insert(second_.end(), shining.begin(), shining.end());
    }
    ++second_revision_;
    return used;
}

bool VertexRadiosity::ray_step()
{
    const int bounces = asked_bounces(params_);
    const bool used = bounces < 0 || bounces > 1;
    if (!third_of_.differs(second_revision_, params_.further, used)) return false;
    third_.clear();
    if (used) {
        third_ = next_bounce(*tracer_, second_, params_.further, mesh_.area());
        share_ = total_flux(third_) / glm::max(total_flux(second_), glm::dvec3(1e-300));
    }
    ++third_revision_;
    return used;
}

bool VertexRadiosity::indirect_step()
{
    const int bounces = asked_bounces(params_);
    if (!indirect_of_.differs(second_revision_, third_revision_, bounces, params_.form_factor, params_.half_texel))
        return false;
    ++indirect_revision_;
    map_.clear_indirect();
    std::vector<shared::PatchLight> lights = light_list(second_, glm::dvec3(1.0));
    glm::dvec3 factor(1.0);
    for (int c = 0; c < 3; ++c) factor[c] = further_bounces_factor(share_[c], bounces);
    const std::vector<shared::PatchLight> third = light_list(third_, factor);
    lights.insert(lights.end(), third.begin(), third.end());
    if (lights.empty()) return false;
    map_.add_indirect(buffers_, lights, sight_of(*tracer_, mesh_.patches, lights), FormFactor(params_.form_factor),
                      params_.half_texel);
    return true;
}

const LightPicker* VertexRadiosity::look(const GpuScene& scene, int view)
{
    if (views_.empty()) return nullptr;
    const int shown = std::min(view, int(views_.size()) - 1);
    picker_.look(scene, views_[std::size_t(shown)], shown, buffers_, map_, params_.pick, cells_);
    return &picker_;
}

std::vector<gl::Resource> VertexRadiosity::resources() const
{
    std::vector<gl::Resource> all = buffers_.resources();
    for (const auto& part : {map_.resources(), picker_.resources()}) all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<Count> VertexRadiosity::counts() const
{
    return {{"patches", double(mesh_.patches.size()), ""},
            {"triangles after subdivision", double(mesh_.indices.size() / 3), ""},
            {"longest edge", double(mesh_.max_edge), "m"},
            {"radiosity map side", double(map_.side()), "texels"},
            {"light views", double(views_.size()), ""},
            {"lights of step 2", double(second_.size()), ""},
            {"lights of step 3", double(third_.size()), ""},
            {"reflected flux seen by lights", (reflected_.x + reflected_.y + reflected_.z) / 3.0, "W"},
            {"flux of step 2", (total_flux(second_).x + total_flux(second_).y + total_flux(second_).z) / 3.0, "W"},
            {"flux of step 3", (total_flux(third_).x + total_flux(third_).y + total_flux(third_).z) / 3.0, "W"}};
}

std::vector<Need> VertexRadiosity::needs() const
{
    const int bounces = asked_bounces(params_);
    const std::string none = "bounces=" + std::to_string(bounces) + ": direct light only";
    const std::size_t emitting = std::size_t(
        std::count_if(mesh_.emitted.begin(), mesh_.emitted.end(), [](const glm::vec3& e) { return e != glm::vec3(0.0f); }));
    const std::string views = number_of(views_.size(), "views of ") + std::to_string(cells_) + " x " +
                              std::to_string(cells_) + " cells";
    const bool second = bounces != 0, third = bounces < 0 || bounces > 1;
    return {{"light views", !views_.empty(), !second ? none : views_.empty() ? "no punctual light" : views},
            {"emitter lights", second && emitting > 0,
             !second ? none : emitting == 0 ? "nothing shines" : number_of(emitting, "patches shine")},
            {"rays of lights", third && !second_.empty(),
             third ? number_of(second_.size(), "lights send ") + std::to_string(params_.further.rays) + " each"
                   : "bounces=" + std::to_string(bounces) + ": at most one is asked for"},
            {"two sides of patches", mesh_.has_two_sides,
             mesh_.has_two_sides ? "some material is double-sided" : "no material is double-sided"}};
}

}  // namespace conebook
