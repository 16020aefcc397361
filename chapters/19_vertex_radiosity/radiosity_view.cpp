#include "19_vertex_radiosity/radiosity_view.hpp"

#include <algorithm>
#include <cmath>

#include "gl/pixel_pass.hpp"

namespace conebook {
namespace {

struct LinePoint {
    glm::vec4 position, color;
};

void add_arrow(std::vector<LinePoint>& lines, const glm::vec3& from, const glm::vec3& direction, float length,
               const glm::vec3& color)
{
    const Frame frame(direction);
    const glm::vec3 tip = from + length * direction;
    const auto line = [&](const glm::vec3& a, const glm::vec3& b) {
        lines.push_back({glm::vec4(a, 1.0f), glm::vec4(color, 1.0f)});
        lines.push_back({glm::vec4(b, 1.0f), glm::vec4(color, 1.0f)});
    };
    line(from, tip);
    for (const glm::vec3& side : {frame.t, -frame.t, frame.b, -frame.b})
        line(tip, tip - 0.25f * length * direction + 0.1f * length * side);
}

void add_arrows(std::vector<LinePoint>& lines, const std::vector<PickedLight>& lights, float longest,
                const glm::vec3& color)
{
    float most = 0.0f;
    const auto flux = [](const PickedLight& p) { return p.light.flux.r + p.light.flux.g + p.light.flux.b; };
    for (const PickedLight& p : lights) most = std::max(most, flux(p));
    for (const PickedLight& p : lights)
        add_arrow(lines, glm::vec3(p.light.position), glm::vec3(p.light.normal),
                  longest * (0.3f + 0.7f * std::sqrt(flux(p) / most)), color);
}

}  // namespace

void add_parameters(ParameterTable& table, RadiosityViewParams& params)
{
    table.add("layer", params.layer, 0, 65535, "", "the light's view that views ray_map and reduction show");
}

RadiosityView::RadiosityView(gl::Shaders& shaders)
    : scene_program_(shaders.load({"19_vertex_radiosity/radiosity.vert", "19_vertex_radiosity/radiosity.frag"})),
      arrow_program_(shaders.load({"19_vertex_radiosity/arrow.vert", "19_vertex_radiosity/arrow.frag"})),
      map_program_(shaders.load({"common/fullscreen.vert", "19_vertex_radiosity/map_view.frag"}, {{"SHOWN", "0"}})),
      level_program_(shaders.load({"common/fullscreen.vert", "19_vertex_radiosity/map_view.frag"}, {{"SHOWN", "1"}})),
      camera_buffer_("camera", sizeof(shared::CameraData))
{
}

void RadiosityView::begin(glm::ivec2 size)
{
    if (!depth_ || depth_.size_2d() != size) {
        color_ = gl::texture_2d("radiosity view", GL_RGBA32F, size);
        depth_ = gl::texture_2d("radiosity view depth", GL_DEPTH_COMPONENT32F, size);
        target_ = gl::Framebuffer("radiosity view", {&color_}, &depth_);
    }
    constexpr float kBlack[4] = {0.0f, 0.0f, 0.0f, 0.0f}, kFarthest = 0.0f;
    glClearNamedFramebufferfv(target_.id(), GL_COLOR, 0, kBlack);
    glClearNamedFramebufferfv(target_.id(), GL_DEPTH, 0, &kFarthest);
}

const gl::Texture& RadiosityView::draw(const VertexRadiosity& radiosity, const GpuScene& scene,
                                       const shared::CameraData& camera, glm::ivec2 size, const LightParts& parts)
{
    begin(size);
    camera_buffer_.write(0, sizeof camera, &camera);
    camera_buffer_.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    target_.bind(size);
    radiosity.map().bind(scene_program_);
    scene_program_.set("back_offset", radiosity.buffers().back_offset());
    scene_program_.set("parts", glm::vec2(parts.direct, parts.diffuse));
    scene_program_.set("emission_part", parts.emission);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    radiosity.buffers().draw(scene_program_, scene, GL_BACK);
    glDisable(GL_DEPTH_TEST);
    return color_;
}

const gl::Texture& RadiosityView::draw_lights(const VertexRadiosity& radiosity, const GpuScene& scene,
                                              const shared::CameraData& camera, glm::ivec2 size)
{
    constexpr float kDimmed = 0.25f;
    draw(radiosity, scene, camera, size, {kDimmed, kDimmed, 0.0f, kDimmed, false});
    std::vector<LinePoint> lines;
    const float longest = 0.06f * scene.bounds().longest_side();  // m
    const auto third = radiosity.third().begin();
    add_arrows(lines, {third, third + std::ptrdiff_t(radiosity.third_at_once())}, longest, {0.15f, 0.4f, 4.0f});
    add_arrows(lines, radiosity.second(), longest, {0.1f, 3.0f, 0.2f});
    const glm::vec3 red(4.0f, 0.1f, 0.1f);
    for (const Light& light : scene.lights()) {
        if (light.type == LightType::point) {
            for (int face = 0; face < 6; ++face) {
                glm::vec3 way(0.0f);
                way[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
                add_arrow(lines, light.position, way, longest, red);
            }
        } else {
            const glm::vec3 from = light.type == LightType::spot
                                       ? light.position
                                       : scene.bounds().center() - 6.0f * longest * light.direction;
            add_arrow(lines, from, light.direction, 3.0f * longest, red);
        }
    }
    if (lines.empty()) return color_;
    const gl::Buffer points("arrows", lines);
    glVertexArrayVertexBuffer(arrows_.id(), 0, points.id(), 0, sizeof(LinePoint));
    for (GLuint i = 0; i < 2; ++i) {
        glEnableVertexArrayAttrib(arrows_.id(), i);
        glVertexArrayAttribFormat(arrows_.id(), i, 4, GL_FLOAT, GL_FALSE, GLuint(i * sizeof(glm::vec4)));
        glVertexArrayAttribBinding(arrows_.id(), i, 0);
    }
    arrow_program_.use();
    glBindVertexArray(arrows_.id());
    glEnable(GL_DEPTH_TEST);
    glDrawArrays(GL_LINES, 0, GLsizei(lines.size()));
    glDisable(GL_DEPTH_TEST);
    return color_;
}

const gl::Texture& RadiosityView::draw_map(const VertexRadiosity& radiosity, glm::ivec2 size)
{
    begin(size);
    radiosity.map().bind(map_program_);
    const int side = std::min(size.x, size.y);
    map_program_.set("corner", glm::vec2((size - side) / 2));
    map_program_.set("extent", glm::vec2(float(side)));
    gl::draw_pixels(map_program_, target_, no_vertices_, size);
    return color_;
}

const gl::Texture& RadiosityView::draw_light_view(VertexRadiosity& radiosity, const GpuScene& scene,
                                                  const RadiosityViewParams& params, bool reduced, glm::ivec2 size)
{
    begin(size);
    const LightPicker* picker = radiosity.look(scene, params.layer);
    if (picker == nullptr) return color_;
    const std::vector<LightPicker::Level>& levels = picker->levels();
    float brightest = 1e-30f;
    const std::vector<float> values = gl::read_floats(levels.front().normal_energy, 0, 4);
    for (std::size_t i = 3; i < values.size(); i += 4) brightest = std::max(brightest, values[i]);
    level_program_.set("brightest", brightest);
    // The map in the left two thirds, its levels above each other on the right, each half as large.
    const float side = reduced ? std::min(float(size.x) / 1.5f, float(size.y)) : float(std::min(size.x, size.y));
    const float width = reduced ? 1.5f * side : side;
    glm::vec2 corner = 0.5f * (glm::vec2(size) - glm::vec2(width, side));
    float extent = side;
    for (std::size_t i = 0; i < (reduced ? levels.size() : 1); ++i) {
        levels[i].chosen.bind(GLuint(shared::kFirstFreeUnit));
        levels[i].normal_energy.bind(GLuint(shared::kFirstFreeUnit + 1));
        level_program_.set("corner", corner);
        level_program_.set("extent", glm::vec2(std::max(extent - 2.0f, 1.0f)));
        gl::draw_pixels(level_program_, target_, no_vertices_, size);
        corner = i == 0 ? corner + glm::vec2(side, 0.0f) : corner + glm::vec2(0.0f, extent);
        extent *= 0.5f;
    }
    return color_;
}

}  // namespace conebook
