#include "20_form_factor_radiosity/hemicube.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/random.hpp"

namespace conebook {
namespace {

struct ItemVertex {
    glm::vec3 position, normal;
};

// snippet: texel_integrals
// Integral of 1 / (pi (x^2 + y^2 + 1)^2) over [0, x] x [0, y] of the top, at height 1.
double top_integral(double x, double y)
{
    const double a = std::sqrt(1.0 + x * x), b = std::sqrt(1.0 + y * y);
    return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2.0 * double(kPi));
}

// Integral of z / (pi (y^2 + z^2 + 1)^2) over [0, y] x [0, z] of a side, at distance 1.
double side_integral(double y, double z)
{
    const double c = std::sqrt(1.0 + z * z);
    return (std::atan(y) - std::atan(y / c) / c) / (2.0 * double(kPi));
}
// end snippet

double over(double (*integral)(double, double), glm::dvec2 low, glm::dvec2 high)
{
    return integral(high.x, high.y) - integral(low.x, high.y) - integral(high.x, low.y) + integral(low.x, low.y);
}

}  // namespace

glm::ivec2 HemicubeLayout::corner(int face) const
{
    if (face == 0) return {0, 0};
    return {resolution * (1 + (face - 1) % 2), resolution / 2 * ((face - 1) / 2)};
}

glm::vec2 Item::uv() const { return glm::vec2(barycentrics & 0xffffu, barycentrics >> 16) / 65535.0f; }

std::vector<float> hemicube_weights(int resolution, TexelWeights weights)
{
    const HemicubeLayout layout{resolution};
    std::vector<float> result(std::size_t(layout.texels()));
    const double step = 2.0 / resolution;
    for (int face = 0; face < 5; ++face)
        for (int j = 0; j < layout.face_size(face).y; ++j)
            for (int i = 0; i < resolution; ++i) {
                const glm::dvec2 low(-1.0 + i * step, face == 0 ? -1.0 + j * step : j * step),
                    high = low + step, middle = 0.5 * (low + high);
                const double r2 = glm::dot(middle, middle) + 1.0, height = face == 0 ? 1.0 : middle.y;
                double weight = 0.0;
                if (weights == TexelWeights::exact) weight = over(face == 0 ? top_integral : side_integral, low, high);
                if (weights == TexelWeights::density) weight = height / (double(kPi) * r2 * r2) * step * step;
                if (weights == TexelWeights::draft) weight = height / (double(kPi) * r2) * step * step;
                const glm::ivec2 texel = layout.corner(face) + glm::ivec2(i, j);
                result[std::size_t(texel.y * layout.size().x + texel.x)] = float(weight);
            }
    return result;
}

HemicubeView hemicube_view(const Patches& patches, std::uint32_t patch, const SurfaceHit& point)
{
    const Frame frame(patches[patch].normal);
    const float turn = 2.0f * kPi * float(mix_bits(patch + 1u) >> 40) * 0x1p-24f;
    HemicubeView view;
    view.eye = patches.tracer().leave(point);
    view.axes = {std::cos(turn) * frame.t + std::sin(turn) * frame.b,
                 std::cos(turn) * frame.b - std::sin(turn) * frame.t, frame.n};
    view.near = 0.25f * patches.tracer().surface_offset();
    return view;
}

Hemicubes::Hemicubes(gl::Shaders& shaders, const Scene& scene)
    : program_(shaders.load({"20_form_factor_radiosity/item.vert", "20_form_factor_radiosity/item.frag"}))
{
    std::vector<ItemVertex> vertices;
    for (std::size_t i = 0; i < scene.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) { return scene.vertices[scene.indices[i + k]].position; };
        const glm::vec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
        for (std::size_t k = 0; k < 3; ++k) vertices.push_back({at(k), normal});
    }
    vertex_count_ = vertices.size();
    vertices_ = gl::Buffer("triangles of item buffers", vertices);
    const GLuint vao = vertex_array_.id();
    glVertexArrayVertexBuffer(vao, 0, vertices_.id(), 0, sizeof(ItemVertex));
    for (GLuint i = 0; i < 2; ++i) {
        glEnableVertexArrayAttrib(vao, i);
        glVertexArrayAttribFormat(vao, i, 3, GL_FLOAT, GL_FALSE, i * GLuint(sizeof(glm::vec3)));
        glVertexArrayAttribBinding(vao, i, 0);
    }
}

std::vector<Item> Hemicubes::render(const std::vector<HemicubeView>& views, int resolution)
{
    const HemicubeLayout layout{resolution};
    const glm::ivec2 size(layout.size().x, layout.size().y * int(std::max<std::size_t>(views.size(), 1)));
    if (!items_ || items_.size_2d().x != size.x || items_.size_2d().y < size.y) {
        items_ = gl::texture_2d("item buffers", GL_RG32UI, size);
        depth_ = gl::texture_2d("depth of item buffers", GL_DEPTH_COMPONENT32F, size);
        framebuffer_ = gl::Framebuffer("item buffers", {&items_}, &depth_);
    }
    framebuffer_.bind(size);
    constexpr GLuint kNothing[4] = {0, 0, 0, 0};
    constexpr float kFarthest = 0.0f;
    glClearNamedFramebufferuiv(framebuffer_.id(), GL_COLOR, 0, kNothing);
    glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &kFarthest);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glEnable(GL_CLIP_DISTANCE0);
    program_.use();
    glBindVertexArray(vertex_array_.id());
    for (std::size_t v = 0; v < views.size(); ++v) {
        const HemicubeView& view = views[v];
        program_.set("eye", view.eye);
        program_.set("clip_plane", view.clip);
        for (int face = 0; face < 5; ++face) {
            // snippet: face_matrix
            // The top looks along n. A side looks along its axis and keeps the half above the horizon: 0 <= y / w
            // <= 1.
            const glm::vec3 t = view.axes[0], b = view.axes[1], n = view.axes[2];
            const glm::vec3 sides[4] = {t, b, -t, -b}, rights[4] = {b, -t, -b, t};
            const glm::vec3 forward = face == 0 ? n : sides[face - 1], right = face == 0 ? t : rights[face - 1];
            const glm::vec3 up = face == 0 ? b : 2.0f * n - forward;
            const glm::mat4 rows(glm::vec4(right, -glm::dot(right, view.eye)), glm::vec4(up, -glm::dot(up, view.eye)),
                                 glm::vec4(0.0f, 0.0f, 0.0f, view.near),
                                 glm::vec4(forward, -glm::dot(forward, view.eye)));
            program_.set("clip_from_scene", glm::transpose(rows));  // depth near / w, reversed
            // end snippet
            const glm::ivec2 corner = layout.corner(face) + glm::ivec2(0, int(v) * resolution);
            glViewport(corner.x, corner.y, layout.face_size(face).x, layout.face_size(face).y);
            glDrawArrays(GL_TRIANGLES, 0, GLsizei(vertex_count_));
        }
    }
    glDisable(GL_CLIP_DISTANCE0);
    glDisable(GL_DEPTH_TEST);
    std::vector<Item> items(std::size_t(layout.texels()) * views.size());
    if (!items.empty())
        glGetTextureSubImage(items_.id(), 0, 0, 0, 0, size.x, size.y, 1, GL_RG_INTEGER, GL_UNSIGNED_INT,
                             GLsizei(items.size() * sizeof(Item)), items.data());
    return items;
}

}  // namespace conebook
