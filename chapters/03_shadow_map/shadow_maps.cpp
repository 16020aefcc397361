#include "03_shadow_map/shadow_maps.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "03_shadow_map/shadowed_box.hpp"

namespace conebook {

namespace {

constexpr double kWidestSpot_rad = 1.31;  // 75 degrees half angle; wider spots have six maps as point lights
constexpr double kRoomTexels = 4.0;       // on each side of a map, for the filter at its edges

// Camera at `eye` that looks along `forward`. A light may be 1000 km away: double precision throughout.
glm::dmat4 view_matrix(glm::dvec3 eye, glm::dvec3 forward)
{
    const glm::dvec3 up = std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    return glm::lookAtRH(eye, eye + forward, up);
}

// Of the scene's box as a view sees it, before any projection; -z is ahead.
struct ViewBox {
    glm::dvec3 low{INFINITY}, high{-INFINITY};
    double tan_half = 0.0;  // of the smallest square pyramid round the view's axis that holds it; infinite if none does
};
ViewBox view_box(const glm::dmat4& view_from_scene, const Bounds& bounds)
{
    ViewBox box;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 p(view_from_scene * glm::dvec4(bounds.corner(i), 1.0));
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
        box.tan_half = std::max(box.tan_half, p.z < 0.0 ? std::max(std::abs(p.x), std::abs(p.y)) / -p.z : INFINITY);
    }
    const double room = 1e-4 * glm::distance(box.low, box.high) + 1e-6;
    box.low -= room;
    box.high += room;
    return box;
}

// Depth 1 near, 0 far: GLM's matrices with the two planes exchanged. Floats are fine near 0, where a perspective crowds
// all that is not near, so that its near plane may be very near.
glm::dmat4 perspective(double tan_half, double near, double far)
{
    return glm::perspectiveRH_ZO(2.0 * std::atan(tan_half), 1.0, far, near);
}
glm::dmat4 parallel(const ViewBox& box)
{
    return glm::orthoRH_ZO(box.low.x, box.high.x, box.low.y, box.high.y, -box.low.z, -box.high.z);
}

constexpr NdcBox kAllOfIt{{-1.0, -1.0, 0.0}, {1.0, 1.0, 1.0}};

glm::dvec3 transformed(const glm::dmat4& matrix, glm::dvec3 point)
{
    const glm::dvec4 p = matrix * glm::dvec4(point, 1.0);
    return glm::dvec3(p) / p.w;
}

// The map shows no more than the box of the light's shadows, and a little room for the filter. A texel of it must be
// wide enough for what the floats of positions leave open: a quarter of it, the bias, is then 8 of their steps.
glm::dmat4 fit(const glm::dmat4& clip_from_scene, const NdcBox& box, const Bounds& bounds, int map_size)
{
    const glm::dvec3 center = 0.5 * (box.low + box.high);
    glm::dvec3 half = 0.5 * (box.high - box.low) + glm::dvec3(0.0, 0.0, 1e-3 * (box.high.z - box.low.z) + 1e-12);
    const glm::dmat4 scene_from_clip = glm::inverse(clip_from_scene);
    const glm::vec3 largest = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
    const double coordinate_m = std::max({largest.x, largest.y, largest.z});
    for (int axis = 0; axis < 2; ++axis) {
        glm::dvec3 end = center;
        end[axis] += half[axis];
        const double texel_m =
            glm::distance(transformed(scene_from_clip, center), transformed(scene_from_clip, end)) * 2.0 / map_size;
        half[axis] *=
            std::max(1.0, std::exp2(-19.0) * coordinate_m / texel_m) * map_size / (map_size - 2.0 * kRoomTexels);
    }
    // To -1 .. 1 in x and y and 0 .. 1 in z.
    const glm::dmat4 from_box = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, 0.5)) *
                                glm::scale(glm::dmat4(1.0), glm::dvec3(1.0, 1.0, 0.5) / half) *
                                glm::translate(glm::dmat4(1.0), -center);
    return from_box * clip_from_scene;
}

// All maps together stay below this, however many lights the scene has: their sides are halved until they do.
constexpr std::size_t kLargestTotalBytes = std::size_t(1) << 30;
constexpr int kSmallestMap = 64;  // texels

// Side of a map, texels.
int fitting_size(int wanted, std::size_t maps)
{
    int size = wanted;
    while (size > kSmallestMap && maps * std::size_t(size) * std::size_t(size) * sizeof(float) > kLargestTotalBytes)
        size /= 2;
    if (maps * std::size_t(size) * std::size_t(size) * sizeof(float) > kLargestTotalBytes)
        throw std::runtime_error("the scene's lights need " + std::to_string(maps) +
                                 " shadow maps, which take more than 1 GiB at " + std::to_string(size) + " x " +
                                 std::to_string(size) + " texels");
    return size;
}

// Maps stand side by side in a layer of the array where the driver has too few layers: how many along a side.
int maps_along_layer(std::size_t maps)
{
    GLint most_layers = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most_layers);  // 2048 at least (OpenGL 4.5, table 23.53)
    int along = 1;
    while (maps > std::size_t(along) * std::size_t(along) * std::size_t(most_layers)) ++along;
    return along;
}

}  // namespace

void add_parameters(ParameterTable& table, ShadowMapParams& params)
{
    table.add("shadow_map_size", params.shadow_map_size, 64, 8192, "texels", "along a side of every shadow map");
    table.add("shadow_bias", params.shadow_bias, 0.0, 10.0, "texels",
              "how far points move along their normal before the lookup");
    table.add("shadow_receiver_plane", params.shadow_receiver_plane, "compare texels with the receiver's plane");
}

std::vector<glm::mat4> shadow_matrices(const Light& light, const Bounds& bounds, const std::vector<Triangle>* triangles,
                                       int map_size)
{
    if (light.intensity == glm::vec3(0.0f)) return {};
    const glm::dvec3 position(light.position), direction(light.direction), center(bounds.center());
    glm::dmat4 clip_from_scene;
    if (light.type == LightType::directional) {
        const glm::dmat4 view = view_matrix(center, direction);
        clip_from_scene = parallel(view_box(view, bounds)) * view;
    } else {
        const glm::dvec3 reach =
            glm::max(glm::abs(glm::dvec3(bounds.min) - position), glm::abs(glm::dvec3(bounds.max) - position));
        const double far = 1.001 * glm::length(reach) + 1e-5, near = 1e-6 * far;
        const double tan_cone = light.type == LightType::spot && light.outer_cone_angle < kWidestSpot_rad
                                    ? std::tan(double(light.outer_cone_angle))
                                    : INFINITY;
        // From outside, the scene may fit into one map that is no coarser than a face of a cube, or than the spot's.
        const glm::dmat4 towards_scene =
            position == center ? glm::dmat4(1.0) : view_matrix(position, glm::normalize(center - position));
        const ViewBox box = view_box(towards_scene, bounds);
        if (box.tan_half < std::min(1.0, tan_cone)) {
            clip_from_scene =
                perspective(1.001 * box.tan_half + 1e-9, std::max(near, -box.high.z), -box.low.z) * towards_scene;
        } else if (tan_cone < INFINITY) {
            clip_from_scene = perspective(tan_cone, near, far) * view_matrix(position, direction);
        } else {
            std::vector<glm::mat4> faces;
            const double room = 1.0 / (1.0 - 2.0 * kRoomTexels / map_size);
            for (int face = 0; face < 6; ++face) {
                glm::dvec3 forward(0.0);
                forward[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
                faces.emplace_back(perspective(room, near, far) * view_matrix(position, forward));
            }
            return faces;
        }
    }
    if (triangles == nullptr) return {glm::mat4(fit(clip_from_scene, kAllOfIt, bounds, map_size))};
    const std::optional<NdcBox> box = shadowed_box(clip_from_scene, *triangles, glm::length(bounds.extent()));
    if (!box) return {};
    return {glm::mat4(fit(clip_from_scene, *box, bounds, map_size))};
}

ShadowMaps::ShadowMaps(gl::Shaders& shaders)
    : program_(shaders.load({"03_shadow_map/shadow.vert", "03_shadow_map/shadow.frag"}))
{
    // Until they are drawn, there is something to bind.
    depth_ = gl::Texture("shadow maps", GL_TEXTURE_2D_ARRAY, GL_DEPTH_COMPONENT32F, glm::ivec3(1));
    layer_buffer_ = gl::Buffer("shadow layers", layers_);
    light_buffer_ = gl::Buffer("shadow lights", lights_);
}

void ShadowMaps::aim(const GpuScene& scene)
{
    // What moves may throw its shadow anywhere, and a map that follows it would flicker.
    const bool fits = !scene.may_move() && !scene.lights().empty();
    if (fits && triangles_of_.differs(scene.geometry_revision())) triangles_ = scene.triangles();
    const auto make_layers = [&](int map_size) {
        layers_.clear();
        lights_.clear();
        for (const Light& light : scene.lights()) {
            const std::vector<glm::mat4> matrices =
                shadow_matrices(light, scene.bounds(), fits ? &triangles_ : nullptr, map_size);
            lights_.push_back({glm::ivec4(layers(), int(matrices.size()), 0, 0)});
            for (const glm::mat4& m : matrices) layers_.push_back({m, glm::ivec4(0)});
        }
    };
    make_layers(params_.shadow_map_size);
    size_ = layers() > 0 ? fitting_size(params_.shadow_map_size, layers_.size()) : 1;  // a texel to bind
    if (layers() > 0 && size_ < params_.shadow_map_size) make_layers(size_);
    const int along = maps_along_layer(layers_.size());
    for (int i = 0; i < layers(); ++i)
        layers_[std::size_t(i)].place = {i % along * size_, i / along % along * size_, i / (along * along), size_};
    layer_buffer_ = gl::Buffer("shadow layers", layers_);
    light_buffer_ = gl::Buffer("shadow lights", lights_);
    const glm::ivec3 size(along * size_, along * size_, std::max(1, (layers() + along * along - 1) / (along * along)));
    if (depth_ && depth_.size() == size) return;
    depth_ = gl::Texture("shadow maps", GL_TEXTURE_2D_ARRAY, GL_DEPTH_COMPONENT32F, size);
    framebuffer_ = gl::Framebuffer("shadow maps", {}, &depth_);
}

bool ShadowMaps::draw(const GpuScene& scene, const ShadowMapParams& params)
{
    // How the maps are looked into changes what is lit, but not the maps.
    if (looked_into_.differs(params.shadow_bias, params.shadow_receiver_plane)) ++revision_;
    params_ = params;
    if (!made_from_.differs(scene.geometry_revision(), scene.lights_revision(), params.shadow_map_size)) return false;
    ++revision_;
    drawn_ = true;
    draws_ = 0;
    aim(scene);
    // snippet: draw
    depth_.clear();  // 0: farthest
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    for (const shared::ShadowLayer& layer : layers_) {
        framebuffer_.attach_depth_layer(depth_, layer.place.z);
        framebuffer_.bind(glm::ivec2(layer.place), glm::ivec2(layer.place.w));
        program_.set("clip_from_scene", layer.clip_from_scene);
        // Both faces cast shadows; objects beside the map cast none on it.
        draws_ += scene.draw(program_, Culling::none, &layer.clip_from_scene);
    }
    glDisable(GL_DEPTH_TEST);
    // end snippet
    return true;
}

void ShadowMaps::bind(const gl::Program& program) const
{
    layer_buffer_.bind(GL_SHADER_STORAGE_BUFFER, shared::kShadowLayerBinding);
    light_buffer_.bind(GL_SHADER_STORAGE_BUFFER, shared::kShadowLightBinding);
    depth_.bind(GLuint(shared::kShadowMapUnit));
    program.set("shadow_bias_texels", params_.shadow_bias);
    program.set("shadow_receiver_plane", params_.shadow_receiver_plane ? 1 : 0);
}

std::vector<Need> ShadowMaps::needs(const GpuScene& scene) const
{
    if (scene.lights().empty()) return {{"shadow maps", false, "the scene has no lights but surfaces that shine"}};
    constexpr const char* kTypes[] = {"directional light", "point light", "spot light"};
    std::vector<Need> needs;
    for (const Light& light : scene.lights()) {
        const int maps = drawn_ ? lights_[needs.size()].layers.y : 0;
        const std::string of = " of light " + std::to_string(needs.size()), type = kTypes[int(light.type)];
        const std::string how_many = maps == 1 ? "one map" : std::to_string(maps) + " maps";
        const std::string why = light.intensity == glm::vec3(0.0f) ? " without intensity"
                                : !drawn_                          ? ": no pass asks its maps"
                                : maps == 0                        ? ": nothing that it lights is behind anything"
                                                                   : ": " + how_many;
        needs.push_back({"shadow map" + of, drawn_ && maps > 0, type + why});
    }
    return needs;
}

}  // namespace conebook
