#include "19_vertex_radiosity/vertex_radiosity.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace conebook {
namespace {

constexpr std::size_t kMostNodes = 32768;  // with their parts, as long as there are parts
constexpr std::size_t kMostThird = 8192;   // lights of all bounces from the second on
constexpr int kMostBounces = 64;
constexpr std::size_t kSightBytes = std::size_t(64) << 20;  // that the sights of some lights take at once

// Of levels below the cells whose picks all lights together may keep.
int depth_of_parts(std::size_t roots)
{
    int depth = 0;
    for (std::size_t nodes = roots, level = roots; depth < 3 && (nodes += level *= 4) <= kMostNodes;) ++depth;
    return depth;
}

// A light with its parts behind it, and theirs behind those.
void add_nodes(std::vector<LightNode>& nodes, const PickedLight& root)
{
    std::vector<const PickedLight*> lights{&root};
    const std::size_t first = nodes.size();
    nodes.push_back({root.light, 0, 0, true});
    for (std::size_t i = 0; i < lights.size(); ++i) {
        nodes[first + i].first_part = std::uint32_t(nodes.size());
        nodes[first + i].part_count = std::uint32_t(lights[i]->parts.size());
        for (const PickedLight& part : lights[i]->parts) {
            lights.push_back(&part);
            nodes.push_back({part.light, 0, 0, false});
        }
    }
}

double mean_flux(const std::vector<PickedLight>& lights)
{
    const glm::dvec3 sum = total_flux(lights);
    return (sum.x + sum.y + sum.z) / 3.0;
}

std::string number_of(std::size_t count, const std::string& of) { return std::to_string(count) + " " + of; }

}  // namespace

void add_parameters(ParameterTable& table, VertexRadiosityParams& params)
{
    add_parameters(table, params.mesh);
    table.add("bounces", params.bounces, -1, 64, "", "indirect bounces; -1: all");
    table.add("steps", params.steps, 0, 3, "",
              "the document's steps: 1 direct, 2 and 3 a bounce more; 0: as bounces says");
    add_parameters(table, params.pick);
    add_parameters(table, params.further);
    table.add("near", params.near, 0.0, 100.0, "roots of the area",
              "within which of a light its parts light a patch; 0: never");
    table.add("form_factor", params.form_factor, {"exact", "published"}, "light from patch to patch");
    table.add("half_texel", params.half_texel, "draw patches at the middle of their texel in the map");
}

int asked_bounces(const VertexRadiosityParams& params) { return params.steps > 0 ? params.steps - 1 : params.bounces; }

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
    const bool used = asked_bounces(params_) != 0, in_parts = params_.near > 0.0f;
    if (!second_of_.differs(direct_revision_, params_.pick, params_.further.emitter_lights, used, in_parts))
        return false;
    second_.clear();
    views_.clear();
    reflected_ = glm::dvec3(0.0);
    if (used) {
        views_ = light_views(scene.lights(), scene.bounds());
        cells_ = cells_of(params_.pick, views_.size(), mesh_.patches.size());
        const int depth = in_parts ? depth_of_parts(views_.size() * std::size_t(cells_ * cells_)) : 0;
        for (std::size_t i = 0; i < views_.size(); ++i) {
            picker_.look(scene, views_[i], int(i), buffers_, map_, params_.pick, cells_);
            const std::vector<PickedLight> picked = picker_.lights(views_[i], scene, mesh_, params_.pick, depth);
            second_.insert(second_.end(), picked.begin(), picked.end());
            reflected_ += picker_.reflected_flux();
        }
        const std::vector<PickedLight> shining = emitter_lights(mesh_, params_.further);
        second_.insert(second_.end(), shining.begin(), shining.end());
    }
    ++second_revision_;
    return used;
}

int VertexRadiosity::rays() const { return rays_of(params_.further, second_.size(), mesh_.patches.size()); }

bool VertexRadiosity::ray_step()
{
    const int bounces = asked_bounces(params_) < 0 ? kMostBounces : asked_bounces(params_);
    if (!third_of_.differs(second_revision_, params_.further, bounces)) return false;
    ++third_revision_;
    third_.clear();
    std::vector<PickedLight> last = second_;
    NextBounce next;
    for (; next.number <= bounces && !last.empty() && third_.size() < kMostThird; ++next.number) {
        const std::size_t sent = last.size() * std::size_t(next.number == 2 ? rays() : 1);
        last = next_bounce(*tracer_, last, params_.further, mesh_, next);
        next.first_ray += sent;
        third_.insert(third_.end(), last.begin(), last.end());
        if (next.number == 2) third_at_once_ = third_.size();
    }
    return next.number > 2;
}

bool VertexRadiosity::indirect_step()
{
    if (!indirect_of_.differs(second_revision_, third_revision_, params_.near, params_.form_factor, params_.half_texel))
        return false;
    ++indirect_revision_;
    map_.clear_indirect();
    const std::size_t most =
        std::max<std::size_t>(kSightBytes / sizeof(GLuint) * 32 / std::max<std::size_t>(mesh_.patches.size(), 1), 1);
    std::vector<LightNode> nodes;
    const auto light_patches = [&] {
        map_.add_indirect(buffers_, nodes, sight_of(*tracer_, mesh_.patches, nodes, params_.near), params_.form_factor,
                          params_.half_texel);
        nodes.clear();
    };
    for (const std::vector<PickedLight>* lights : {&second_, &third_})
        for (const PickedLight& light : *lights) {
            add_nodes(nodes, light);
            if (nodes.size() >= most) light_patches();
        }
    if (!nodes.empty()) light_patches();
    return !second_.empty();
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
            {"lights of step 3", double(third_at_once_), ""},
            {"lights of later bounces", double(third_.size() - third_at_once_), ""},
            {"reflected flux seen by lights", (reflected_.x + reflected_.y + reflected_.z) / 3.0, "W"},
            {"flux of step 2", mean_flux(second_), "W"},
            {"flux of step 3", mean_flux({third_.begin(), third_.begin() + std::ptrdiff_t(third_at_once_)}), "W"}};
}

std::vector<Need> VertexRadiosity::needs() const
{
    const int bounces = asked_bounces(params_);
    const std::string none = "bounces=" + std::to_string(bounces) + ": direct light only";
    const std::size_t emitting = std::size_t(std::count_if(mesh_.emitted.begin(), mesh_.emitted.end(),
                                                           [](const glm::vec3& e) { return e != glm::vec3(0.0f); }));
    const std::string views =
        number_of(views_.size(), "views of ") + std::to_string(cells_) + " x " + std::to_string(cells_) + " cells";
    const bool second = bounces != 0, third = bounces < 0 || bounces > 1;
    return {{"light views", !views_.empty(),
             !second          ? none
             : views_.empty() ? "no punctual light"
                              : views},
            {"emitter lights", second && emitting > 0,
             !second         ? none
             : emitting == 0 ? "nothing shines"
                             : number_of(emitting, "patches shine")},
            {"rays of lights", third && !second_.empty(),
             third ? number_of(second_.size(), "lights send ") + std::to_string(rays()) + " each"
                   : "bounces=" + std::to_string(bounces) + ": at most one is asked for"},
            {"two sides of patches", mesh_.has_two_sides,
             mesh_.has_two_sides ? "some material is double-sided" : "no material is double-sided"}};
}

}  // namespace conebook
