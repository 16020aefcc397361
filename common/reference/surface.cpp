#include "reference/surface.hpp"

#include <array>
#include <cmath>

#include "image/resample.hpp"

namespace conebook {
namespace {

// sRGB to linear, for the 256 stored values.
const std::array<float, 256>& srgb_to_linear()
{
    static const std::array<float, 256> table = [] {
        std::array<float, 256> t{};
        for (int i = 0; i < 256; ++i) t[i] = float(linear_from_srgb(i / 255.0));
        return t;
    }();
    return table;
}

int wrap_texel(int i, int size, Wrap wrap)
{
    switch (wrap) {
        case Wrap::clamp_to_edge:
            return i < 0 ? 0 : (i >= size ? size - 1 : i);
        case Wrap::mirrored_repeat: {
            const int period = 2 * size;
            const int m = ((i % period) + period) % period;
            return m < size ? m : period - 1 - m;
        }
        case Wrap::repeat:
            break;
    }
    return ((i % size) + size) % size;
}

// Texture coordinates of any size, brought near 0 with the texture's period kept (2 for mirrored) so that the
// conversion to int cannot overflow.
float bounded(float x, Wrap wrap)
{
    if (!std::isfinite(x)) return 0.0f;
    return wrap == Wrap::clamp_to_edge ? glm::clamp(x, -1.0f, 2.0f) : x - 2.0f * std::floor(x * 0.5f);
}

glm::vec4 texel(const Image& image, const TextureSlot& slot, int x, int y, bool srgb)
{
    const int wx = wrap_texel(x, image.width, slot.wrap_s), wy = wrap_texel(y, image.height, slot.wrap_t);
    const std::uint8_t* p = &image.rgba[(std::size_t(wy) * image.width + wx) * 4];
    if (!srgb) return glm::vec4(p[0], p[1], p[2], p[3]) / 255.0f;
    const auto& linear = srgb_to_linear();
    return {linear[p[0]], linear[p[1]], linear[p[2]], p[3] / 255.0f};
}

glm::vec4 sample_slot(const Scene& scene, const TextureSlot& slot, const TrianglePoint& point, bool srgb)
{
    if (!slot.present()) return glm::vec4(1.0f);
    const glm::vec2 uv = point.mix(slot.uv_set == 1 ? &Vertex::uv1 : &Vertex::uv0);
    return sample_texture(scene.images[slot.image], slot, uv, srgb);
}

glm::vec4 base_color_at(const Scene& scene, const Material& material, const TrianglePoint& point)
{
    return material.base_color * point.mix(&Vertex::color) *
           sample_slot(scene, material.base_color_texture, point, true);
}

glm::vec3 shading_normal_at(const Scene& scene, const Material& material, const TrianglePoint& point,
                            const glm::vec3& geometric_normal)
{
    glm::vec3 n = point.mix(&Vertex::normal);
    const float length = glm::length(n);
    n = length > 1e-12f ? n / length : geometric_normal;
    if (material.normal_texture.present()) {
        // glTF 2.0, 3.9.3: scaled = normalize((sampled * 2 - 1) * (scale, scale, 1)), in the frame (t, b, n).
        const glm::vec4 tangent = point.mix(&Vertex::tangent);
        const glm::vec3 t(tangent);
        const glm::vec3 b = glm::cross(n, t) * (tangent.w < 0.0f ? -1.0f : 1.0f);
        glm::vec3 m = glm::vec3(sample_slot(scene, material.normal_texture, point, false)) * 2.0f - 1.0f;
        m *= glm::vec3(material.normal_scale, material.normal_scale, 1.0f);
        const glm::vec3 mapped = m.x * t + m.y * b + m.z * n;
        const float mapped_length = glm::length(mapped);
        if (mapped_length > 1e-6f) n = mapped / mapped_length;
    }
    return n;
}

}  // namespace

glm::vec4 sample_texture(const Image& image, const TextureSlot& slot, glm::vec2 uv, bool srgb)
{
    if (image.width <= 0 || image.height <= 0) return glm::vec4(1.0f);
    uv = glm::vec2(slot.uv_transform * glm::vec3(uv, 1.0f));
    const float x = bounded(uv.x, slot.wrap_s) * float(image.width);
    const float y = bounded(uv.y, slot.wrap_t) * float(image.height);
    if (slot.mag_filter == Filter::nearest) return texel(image, slot, int(std::floor(x)), int(std::floor(y)), srgb);
    const float fx = std::floor(x - 0.5f), fy = std::floor(y - 0.5f);
    const float a = x - 0.5f - fx, b = y - 0.5f - fy;
    const int ix = int(fx), iy = int(fy);
    return (1 - b) * ((1 - a) * texel(image, slot, ix, iy, srgb) + a * texel(image, slot, ix + 1, iy, srgb)) +
           b * ((1 - a) * texel(image, slot, ix, iy + 1, srgb) + a * texel(image, slot, ix + 1, iy + 1, srgb));
}

TrianglePoint triangle_point(const Scene& scene, const Draw& draw, std::uint32_t triangle, float u, float v)
{
    const std::uint32_t* index = &scene.indices[draw.first_index + 3 * std::size_t(triangle)];
    return {&scene.vertices[index[0]], &scene.vertices[index[1]], &scene.vertices[index[2]], u, v};
}

bool covers(const Scene& scene, const Material& material, const TrianglePoint& point)
{
    if (material.alpha_mode != AlphaMode::mask) return true;
    return base_color_at(scene, material, point).a >= material.alpha_cutoff;
}

glm::vec3 emitted_radiance(const Scene& scene, const Material& material, const TrianglePoint& point)
{
    if (material.unlit) return glm::clamp(glm::vec3(base_color_at(scene, material, point)), 0.0f, 1.0f);
    if (material.emission == glm::vec3(0.0f)) return glm::vec3(0.0f);
    return material.emission * glm::vec3(sample_slot(scene, material.emission_texture, point, true));
}

SurfaceHit evaluate_surface(const Scene& scene, std::uint32_t draw, std::uint32_t triangle, float u, float v,
                            const glm::vec3& direction)
{
    const Draw& d = scene.draws[draw];
    const Material& material = scene.materials[d.material];
    const TrianglePoint point = triangle_point(scene, d, triangle, u, v);
    SurfaceHit hit;
    hit.draw = draw;
    hit.triangle = triangle;
    // Interpolated from the vertices, not origin + t * direction: its error does not grow with the ray's length.
    hit.position = point.mix(&Vertex::position);
    const glm::vec3 n = glm::cross(point.v1->position - point.v0->position, point.v2->position - point.v0->position);
    const float length = glm::length(n);
    hit.geometric_normal = length > 0.0f ? n / length : -glm::normalize(direction);
    hit.front = glm::dot(hit.geometric_normal, direction) < 0.0f;
    hit.dark = !hit.front && !material.double_sided;
    hit.shading_normal = shading_normal_at(scene, material, point, hit.geometric_normal);
    if (!hit.front) {
        hit.geometric_normal = -hit.geometric_normal;
        hit.shading_normal = -hit.shading_normal;
    }
    if (hit.dark) return hit;

    const glm::vec4 base = base_color_at(scene, material, point);
    hit.base_color = glm::clamp(glm::vec3(base), 0.0f, 1.0f);
    hit.emission = emitted_radiance(scene, material, point);
    if (material.unlit) return hit;  // its radiance is the base colour; it reflects nothing
    const glm::vec4 mr = sample_slot(scene, material.metallic_roughness_texture, point, false);
    const float specular = material.specular * sample_slot(scene, material.specular_texture, point, false).a;
    const glm::vec3 specular_color =
        material.specular_color * glm::vec3(sample_slot(scene, material.specular_color_texture, point, true));
    hit.brdf = Brdf::from_metallic_roughness(hit.base_color, material.metallic * mr.b, material.roughness * mr.g,
                                             specular, specular_color);
    return hit;
}

}  // namespace conebook
