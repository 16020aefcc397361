#include "03_shadow_map/shadow_maps.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <glm/gtc/constants.hpp>

namespace conebook {

namespace {

constexpr float kWidestSpot_rad = 1.31f;  // 75 degrees half angle; wider spots have six maps as point lights

// Camera at `eye` that looks along `forward`: rows right, up, -forward.
glm::mat4 view_matrix(glm::vec3 eye, glm::vec3 forward)
{
    const glm::vec3 some_up = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 right = glm::normalize(glm::cross(forward, some_up)), up = glm::cross(right, forward);
    const glm::mat3 rotation = glm::transpose(glm::mat3(right, up, -forward));
    glm::mat4 view(rotation);
    view[3] = glm::vec4(-(rotation * eye), 1.0f);
    return view;
}

// Depth 1 at `near`, 0 at `far`: floats are fine near 0, where a perspective crowds all that is not near.
glm::mat4 perspective(float tan_half, float near, float far)
{
    glm::mat4 m(0.0f);
    m[0][0] = m[1][1] = 1.0f / tan_half;
    m[2][2] = near / (far - near);
    m[2][3] = -1.0f;
    m[3][2] = near * far / (far - near);
    return m;
}

glm::mat4 orthographic(glm::vec3 low, glm::vec3 high)
{
    glm::mat4 m(1.0f);
    for (int axis = 0; axis < 2; ++axis) {
        m[axis][axis] = 2.0f / (high[axis] - low[axis]);
        m[3][axis] = -(high[axis] + low[axis]) / (high[axis] - low[axis]);
    }
    m[2][2] = 1.0f / (high.z - low.z);  // view space looks along -z: high.z is near
    m[3][2] = -low.z / (high.z - low.z);
    return m;
}

// All maps together stay below this, however many lights the scene has: their sides are halved until they do.
constexpr std::size_t kLargestTotalBytes = std::size_t(1) << 30;
constexpr int kSmallestMap = 64;  // texels

int fitting_size(int wanted, std::size_t layers)
{
    GLint most_layers = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most_layers);
    if (layers > std::size_t(most_layers))
        throw std::runtime_error("the scene's lights need " + std::to_string(layers) + " shadow maps, the driver has " +
                                 std::to_string(most_layers));
    int size = wanted;
    while (size > kSmallestMap && layers * std::size_t(size) * std::size_t(size) * sizeof(float) > kLargestTotalBytes)
        size /= 2;
    return size;
}

}  // namespace

void add_parameters(ParameterTable& table, ShadowMapParams& params)
{
    table.add("shadow_map_size", params.shadow_map_size, 64, 8192, "texels", "along a side of every shadow map");
    table.add("shadow_bias", params.shadow_bias, 0.0, 10.0, "texels",
              "how far points move along their normal before the lookup");
    table.add("shadow_receiver_plane", params.shadow_receiver_plane, "compare texels with the receiver's plane");
}

std::vector<glm::mat4> shadow_matrices(const Light& light, const Bounds& bounds, int map_size)
{
    if (light.intensity == glm::vec3(0.0f)) return {};
    const float margin = 1.0f + 8.0f / float(map_size);  // room for the filter at the edges
    if (light.type == LightType::directional) {
        const glm::mat4 view = view_matrix(bounds.center(), light.direction);
        glm::vec3 low(1e30f), high(-1e30f);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                              corner & 4 ? bounds.max.z : bounds.min.z);
            const glm::vec3 v(view * glm::vec4(p, 1.0f));
            low = glm::min(low, v);
            high = glm::max(high, v);
        }
        const glm::vec3 grow = 0.5f * (margin - 1.0f) * (high - low) + 1e-4f * glm::length(high - low) + 1e-6f;
        return {orthographic(low - grow, high + grow) * view};
    }
    const glm::vec3 farthest = glm::max(glm::abs(bounds.min - light.position), glm::abs(bounds.max - light.position));
    const float far = 1.001f * glm::length(farthest) + 1e-5f, near = 2e-4f * far;
    if (light.type == LightType::spot && light.outer_cone_angle < kWidestSpot_rad)
        return {perspective(margin * std::tan(light.outer_cone_angle), near, far) *
                view_matrix(light.position, light.direction)};
    std::vector<glm::mat4> faces;
    for (int face = 0; face < 6; ++face) {
        glm::vec3 forward(0.0f);
        forward[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
        faces.push_back(perspective(margin, near, far) * view_matrix(light.position, forward));
    }
    return faces;
}

ShadowMaps::ShadowMaps(gl::Shaders& shaders, const GpuScene& scene, const ShadowMapParams& params)
    : params_(params), program_(shaders.load({"03_shadow_map/shadow.vert", "03_shadow_map/shadow.frag"}))
{
    std::size_t layer_count = 0;
    for (const Light& light : scene.lights())
        layer_count += shadow_matrices(light, scene.bounds(), params.shadow_map_size).size();
    const int size = layer_count > 0 ? fitting_size(params.shadow_map_size, layer_count) : 1;  // a texel to bind

    std::vector<shared::ShadowLight> lights;
    for (const Light& light : scene.lights()) {
        const std::vector<glm::mat4> matrices = shadow_matrices(light, scene.bounds(), size);
        lights.push_back({glm::ivec4(layers(), int(matrices.size()), 0, 0)});
        for (const glm::mat4& m : matrices) layers_.push_back({m});
    }
    layer_buffer_ = gl::Buffer("shadow layers", layers_);
    light_buffer_ = gl::Buffer("shadow lights", lights);
    depth_ = gl::Texture("shadow maps", GL_TEXTURE_2D_ARRAY, GL_DEPTH_COMPONENT32F,
                         {size, size, std::max(layers(), 1)});
    framebuffer_ = gl::Framebuffer("shadow maps", {}, &depth_);
}

bool ShadowMaps::draw(const GpuScene& scene)
{
    if (!made_from_.differs(scene.geometry_revision(), scene.lights_revision())) return false;
    ++revision_;
    // snippet: draw
    framebuffer_.bind(depth_.size_2d());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    for (int layer = 0; layer < layers(); ++layer) {
        framebuffer_.attach_depth_layer(depth_, layer);
        const float farthest = 0.0f;
        glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &farthest);
        program_.set("clip_from_scene", layers_[std::size_t(layer)].clip_from_scene);
        scene.draw(program_, Culling::none);  // both faces cast shadows
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
        const std::size_t maps = shadow_matrices(light, scene.bounds(), size()).size();
        const std::string of = " of light " + std::to_string(needs.size()), type = kTypes[int(light.type)];
        const std::string how_many = maps == 1 ? "one map" : std::to_string(maps) + " maps";
        const std::string why = maps == 0 ? " without intensity" : revision_ > 0 ? ": " + how_many : ": no pass asks its maps";
        needs.push_back({"shadow map" + of, revision_ > 0 && maps > 0, type + why});
    }
    return needs;
}

}  // namespace conebook
