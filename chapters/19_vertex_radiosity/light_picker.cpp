#include "19_vertex_radiosity/light_picker.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "gl/pixel_pass.hpp"

namespace conebook {
namespace {

constexpr float kWidestSpot = 1.309f;  // rad, 75 degrees: beyond, six maps of 90 degrees see sharper (chapter 03)

glm::mat4 looking(const glm::vec3& eye, const glm::vec3& forward)
{
    const glm::vec3 z = -glm::normalize(forward);
    const glm::vec3 up = std::abs(z.y) > 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
    const glm::vec3 x = glm::normalize(glm::cross(up, z));
    return {glm::vec4(x, 0.0f), glm::vec4(glm::cross(z, x), 0.0f), glm::vec4(z, 0.0f), glm::vec4(eye, 1.0f)};
}

LightView perspective(int light, const glm::vec3& eye, const glm::vec3& forward, float tangent, float size_m)
{
    LightView view;
    view.light = light;
    view.tangent = tangent;
    view.camera.world_from_camera = looking(eye, forward);
    view.camera.y_fov = 2.0f * std::atan(tangent);
    view.camera.z_near = 1e-6f * size_m;
    return view;
}

// Square, and as large as the scene is across.
LightView parallel(int light, const glm::vec3& direction, const Bounds& bounds)
{
    LightView view;
    view.light = light;
    view.camera.orthographic = true;
    view.camera.world_from_camera = looking(bounds.center() - glm::length(bounds.extent()) * direction, direction);
    const glm::mat3 axes(view.camera.world_from_camera);
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner = glm::transpose(axes) * (bounds.corner(i) - bounds.center());
        view.camera.y_mag = std::max({i == 0 ? 0.0f : view.camera.y_mag, std::abs(corner.x), std::abs(corner.y)});
    }
    view.camera.y_mag = view.camera.x_mag = 1.0001f * view.camera.y_mag;
    view.camera.z_near = 0.0f;
    return view;
}

}  // namespace

void add_parameters(ParameterTable& table, PickParams& params)
{
    table.add_values("m", params.m, {16, 32, 64, 128, 256, 512}, "texels along a side of what a light sees");
    table.add_values("cells", params.cells, {0, 1, 2, 4, 8, 16, 32, 64},
                     "cells along a side of it: a light each; 0: up to 32, by the number of views");
    table.add("pick", params.pick, {"maximum", "flux"}, "a cell's light: its brightest patch, or drawn by flux");
    table.add("borders", params.borders, {"keep", "drop"}, "cells on the border of the map");
}

void check(const PickParams& params)
{
    if (params.cells > params.m)
        throw std::runtime_error("cells=" + std::to_string(params.cells) +
                                 " are more than the texels, m=" + std::to_string(params.m));
}

std::size_t usual_lights(std::size_t patches)
{
    constexpr std::size_t kMostPairs = std::size_t(1) << 25;  // rays, of which a core traces a few million a second
    return std::clamp(kMostPairs / std::max<std::size_t>(patches, 1), std::size_t(64), std::size_t(2048));
}

int cells_of(const PickParams& params, std::size_t views, std::size_t patches)
{
    constexpr std::size_t kMost = 4096;
    const std::size_t most = params.cells > 0 ? kMost : usual_lights(patches);
    int cells = params.cells > 0 ? params.cells : std::min(32, params.m);
    while (cells > 1 && views * std::size_t(cells) * std::size_t(cells) > most) cells /= 2;
    return cells;
}

std::vector<LightView> light_views(const std::vector<Light>& lights, const Bounds& bounds)
{
    std::vector<LightView> views;
    const float radius = 0.5f * glm::length(bounds.extent());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        if (light.intensity == glm::vec3(0.0f) || radius <= 0.0f) continue;
        if (light.type == LightType::directional) {
            views.push_back(parallel(int(i), light.direction, bounds));
            continue;
        }
        const bool is_narrow = light.type == LightType::spot && light.outer_cone_angle < kWidestSpot;
        const float tangent = is_narrow ? std::tan(light.outer_cone_angle) : INFINITY;
        const glm::vec3 way = bounds.center() - light.position;
        const float distance = glm::length(way);
        const float of_scene = distance > radius ? radius / std::sqrt(distance * distance - radius * radius) : INFINITY;
        const float size_m = distance + radius;
        if (of_scene < std::min(1.0f, tangent))
            views.push_back(perspective(int(i), light.position, way, 1.001f * of_scene, size_m));
        else if (is_narrow)
            views.push_back(perspective(int(i), light.position, light.direction, tangent, size_m));
        else
            for (int face = 0; face < 6; ++face) {
                glm::vec3 forward(0.0f);
                forward[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
                views.push_back(perspective(int(i), light.position, forward, 1.0f, size_m));
            }
    }
    return views;
}

LightPicker::LightPicker(gl::Shaders& shaders)
    : look_(shaders.load({"01_first_light/scene.vert", "19_vertex_radiosity/light_view.frag"})),
      reduce_(shaders.load({"common/fullscreen.vert", "19_vertex_radiosity/reduce.frag"})),
      camera_buffer_("light's camera", sizeof(shared::CameraData))
{
}

void LightPicker::make_levels(int side, int cells)
{
    if (!levels_.empty() && levels_.front().chosen.size().x == side && levels_.back().chosen.size().x == cells) return;
    levels_.clear();
    depth_ = gl::texture_2d("light view depth", GL_DEPTH_COMPONENT32F, {side, side});
    for (int s = side; s >= cells; s /= 2) {
        Level& level = levels_.emplace_back();
        for (gl::Texture* texture : {&level.chosen, &level.normal_energy, &level.flux_area})
            *texture = gl::texture_2d("light view", GL_RGBA32F, {s, s});
        level.target = gl::Framebuffer("light view", {&level.chosen, &level.normal_energy, &level.flux_area},
                                       s == side ? &depth_ : nullptr);
    }
}

void LightPicker::look(const GpuScene& scene, const LightView& view, int number, const PatchBuffers& patches,
                       const RadiosityMap& map, const PickParams& params, int cells)
{
    make_levels(params.m, cells);
    const glm::ivec2 size(params.m);
    const shared::CameraData camera = camera_data(view.camera, size, scene.bounds());
    camera_buffer_.write(0, sizeof camera, &camera);
    camera_buffer_.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);

    // What it sees.
    const Level& seen = levels_.front();
    seen.target.bind(size);
    constexpr float kNone[4] = {0.0f, 0.0f, 0.0f, -1.0f}, kBlack[4] = {0.0f, 0.0f, 0.0f, 0.0f}, kFarthest = 0.0f;
    glClearNamedFramebufferfv(seen.target.id(), GL_COLOR, 0, kNone);
    glClearNamedFramebufferfv(seen.target.id(), GL_COLOR, 1, kNone);
    glClearNamedFramebufferfv(seen.target.id(), GL_COLOR, 2, kBlack);
    glClearNamedFramebufferfv(seen.target.id(), GL_DEPTH, 0, &kFarthest);
    map.direct().bind(GLuint(shared::kFirstFreeUnit));
    scene.bind_lights(look_);
    patches.bind();
    look_.set("light_index", view.light);
    look_.set("map_side", map.side());
    look_.set("back_offset", patches.back_offset());
    look_.set("view_side", float(params.m));
    look_.set("tangent", view.tangent);
    const float texel = 2.0f * view.camera.y_mag / float(params.m);
    look_.set("texel_area", texel * texel);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    patches.draw(look_, scene, GL_BACK);
    // Backs without a material, which only stop light; where one coincides with a front, the front is there already.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1.0f, -4.0f);
    patches.draw(look_, scene, GL_FRONT);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_DEPTH_TEST);

    // Halved, and halved again.
    for (std::size_t i = 1; i < levels_.size(); ++i) {
        const Level& before = levels_[i - 1];
        before.chosen.bind(GLuint(shared::kFirstFreeUnit));
        before.normal_energy.bind(GLuint(shared::kFirstFreeUnit + 1));
        before.flux_area.bind(GLuint(shared::kFirstFreeUnit + 2));
        reduce_.set("pick", int(params.pick));
        reduce_.set("seed", GLuint(number) * 0x632be5abu + GLuint(i) * 0x85157af5u);
        gl::draw_pixels(reduce_, levels_[i].target, no_vertices_, levels_[i].chosen.size_2d());
    }
}

namespace {

// A level, on the CPU.
struct ReadLevel {
    explicit ReadLevel(const LightPicker::Level& level)
        : cells(level.chosen.size().x),
          chosen(gl::read_floats(level.chosen, 0, 4)),
          normal_energy(gl::read_floats(level.normal_energy, 0, 4)),
          flux_area(gl::read_floats(level.flux_area, 0, 4))
    {
    }
    static glm::vec4 at(const std::vector<float>& values, int cell)
    {
        const float* v = &values[std::size_t(4 * cell)];
        return {v[0], v[1], v[2], v[3]};
    }
    int cells;
    std::vector<float> chosen, normal_energy, flux_area;
};

// The light of a cell and, from the levels before it, its parts. Nothing where no flux is.
void add_light(std::vector<PickedLight>& lights, const std::vector<ReadLevel>& levels, std::size_t level, int x, int y,
               const PatchMesh& mesh, Pick pick, const Light& source)
{
    const ReadLevel& l = levels[level];
    const int cell = y * l.cells + x;
    const glm::vec4 chosen = ReadLevel::at(l.chosen, cell), normal = ReadLevel::at(l.normal_energy, cell),
                    flux = ReadLevel::at(l.flux_area, cell);
    if (chosen.w < 0.0f || glm::vec3(flux) == glm::vec3(0.0f)) return;
    PickedLight picked;
    picked.light = {glm::vec4(glm::vec3(chosen), flux.w), glm::vec4(glm::vec3(normal), 0.0f),
                    glm::vec4(glm::vec3(flux), 0.0f)};
    if (pick == Pick::maximum) {
        const shared::Patch& patch = mesh.patches[std::size_t(chosen.w)];
        picked.light.position = glm::vec4(glm::vec3(patch.position), flux.w);
        picked.light.normal = patch.normal;
    }
    picked.incoming = source.type == LightType::directional
                          ? source.direction
                          : glm::normalize(glm::vec3(picked.light.position) - source.position);
    if (level > 0)
        for (int k = 0; k < 4; ++k)
            add_light(picked.parts, levels, level - 1, 2 * x + (k & 1), 2 * y + (k >> 1), mesh, pick, source);
    lights.push_back(std::move(picked));
}

}  // namespace

std::vector<PickedLight> LightPicker::lights(const LightView& view, const GpuScene& scene, const PatchMesh& mesh,
                                             const PickParams& params, int depth) const
{
    std::vector<ReadLevel> levels;
    const std::size_t first = levels_.size() - 1 - std::min(std::size_t(depth), levels_.size() - 1);
    for (std::size_t i = first; i < levels_.size(); ++i) levels.emplace_back(levels_[i]);
    const int cells = levels.back().cells;
    std::vector<PickedLight> lights;
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const bool on_border = x == 0 || y == 0 || x == cells - 1 || y == cells - 1;
            if (params.borders == Borders::drop && on_border) continue;
            add_light(lights, levels, levels.size() - 1, x, y, mesh, params.pick,
                      scene.lights()[std::size_t(view.light)]);
        }
    return lights;
}

glm::dvec3 LightPicker::reflected_flux() const
{
    const auto fluxes = gl::read_floats(levels_.back().flux_area, 0, 4);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < fluxes.size(); i += 4) sum += glm::dvec3(fluxes[i], fluxes[i + 1], fluxes[i + 2]);
    return sum;
}

std::vector<gl::Resource> LightPicker::resources() const
{
    std::size_t bytes = depth_.bytes();
    for (const Level& level : levels_)
        bytes += level.chosen.bytes() + level.normal_energy.bytes() + level.flux_area.bytes();
    return {{"light view and its levels", bytes}};
}

}  // namespace conebook
