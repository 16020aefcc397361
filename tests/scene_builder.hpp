// Scenes made in code, for tests: quads, boxes, discs, spheres, materials, lights. Header only.
//
//     SceneBuilder b;
//     const int grey = b.material(lambert(0.5f));
//     b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, grey);       // normal = cross(u, v) = +y
//     b.point_light({0, 2, 0}, {10, 10, 10});
//     const Scene scene = b.build();
//     const Camera camera = look_at({0, 1, 3}, {0, 0, 0}, 0.8f);
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "scene/scene.hpp"

namespace conebook {

// Pure Lambert: specular 0, metallic 0.
inline Material lambert(const glm::vec3& rho)
{
    Material m;
    m.base_color = glm::vec4(rho, 1.0f);
    m.metallic = 0.0f;
    m.specular = 0.0f;
    return m;
}
inline Material lambert(float rho) { return lambert(glm::vec3(rho)); }

// Lambert that shines with a radiance.
inline Material emitter(const glm::vec3& radiance, float rho = 0.0f)
{
    Material m = lambert(rho);
    m.emission = radiance;
    return m;
}
inline Material emitter(float radiance, float rho = 0.0f) { return emitter(glm::vec3(radiance), rho); }

inline Material metal(const glm::vec3& f0, float roughness)
{
    Material m;
    m.base_color = glm::vec4(f0, 1.0f);
    m.metallic = 1.0f;
    m.roughness = roughness;
    return m;
}

// Camera at `eye`, looking at `target`; y_fov in radians.
inline Camera look_at(const glm::vec3& eye, const glm::vec3& target, float y_fov)
{
    const glm::vec3 z = glm::normalize(eye - target);
    const glm::vec3 up = std::abs(z.y) > 0.99f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
    const glm::vec3 x = glm::normalize(glm::cross(up, z));
    Camera camera;
    camera.world_from_camera =
        glm::mat4(glm::vec4(x, 0), glm::vec4(glm::cross(z, x), 0), glm::vec4(z, 0), glm::vec4(eye, 1));
    camera.y_fov = y_fov;
    camera.z_near = 1e-3f;
    return camera;
}

// The same, orthographic, 2 * half_height high.
inline Camera look_at_orthographic(const glm::vec3& eye, const glm::vec3& target, float half_width, float half_height)
{
    Camera camera = look_at(eye, target, 0.8f);
    camera.orthographic = true;
    camera.x_mag = half_width;
    camera.y_mag = half_height;
    return camera;
}

class SceneBuilder {
public:
    int material(const Material& m)
    {
        scene_.materials.push_back(m);
        return int(scene_.materials.size()) - 1;
    }

    int image(int width, int height, std::vector<std::uint8_t> rgba)
    {
        scene_.images.push_back({"", width, height, std::move(rgba)});
        return int(scene_.images.size()) - 1;
    }

    // Each of these adds one draw. Front side: where the corners wind counter-clockwise.

    void triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, int material)
    {
        begin(material);
        const glm::vec3 n = flat_normal(a, b, c);
        add({vertex(a, n, {0, 0}), vertex(b, n, {1, 0}), vertex(c, n, {0, 1})}, {0, 1, 2});
        end();
    }

    // Parallelogram corner, corner + u, corner + u + v, corner + v; the normal is cross(u, v). `cells` x `cells`
    // squares, uv (0,0) at the corner, (1,0) at corner + u, (0,1) at corner + v.
    void quad(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, int material, int cells = 1)
    {
        begin(material);
        add_quad(corner, u, v, cells);
        end();
    }

    // Axis-aligned box; `inward` turns the normals into it (a room).
    void box(const glm::vec3& low, const glm::vec3& high, int material, bool inward = false)
    {
        begin(material);
        for (int face = 0; face < 6; ++face) add_box_face(low, high, face, inward);
        end();
    }

    // One face of such a box: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z.
    void box_face(const glm::vec3& low, const glm::vec3& high, int face, int material, bool inward = false)
    {
        begin(material);
        add_box_face(low, high, face, inward);
        end();
    }

    // Regular polygon with the area of the disc of that radius, facing `normal`.
    void disc(const glm::vec3& center, const glm::vec3& normal, float radius, int material, int segments = 256)
    {
        begin(material);
        const glm::vec3 n = glm::normalize(normal);
        const glm::vec3 t = glm::normalize(std::abs(n.y) > 0.9f ? glm::cross(n, glm::vec3(1, 0, 0))
                                                                : glm::cross(n, glm::vec3(0, 1, 0)));
        const glm::vec3 b = glm::cross(n, t);
        const double step = 2.0 * glm::pi<double>() / segments;
        const float r = radius * float(std::sqrt(step / std::sin(step)));
        std::vector<Vertex> vertices{vertex(center, n, {0.5f, 0.5f})};
        std::vector<std::uint32_t> indices;
        for (int i = 0; i < segments; ++i) {
            const float c = float(std::cos(i * step)), s = float(std::sin(i * step));
            vertices.push_back(vertex(center + r * (c * t + s * b), n, 0.5f + 0.5f * glm::vec2(c, s)));
            indices.insert(indices.end(), {0u, std::uint32_t(i + 1), std::uint32_t((i + 1) % segments + 1)});
        }
        add(vertices, indices);
        end();
    }

    // Sphere of `rings` equal steps of latitude and twice as many of longitude round z; smooth normals unless `flat`.
    // `inward` turns the front inside. Only rings whose middle has z between z_low and z_high (-1..1 of the radius).
    void sphere(const glm::vec3& center, float radius, int material, int rings = 32, bool inward = false,
                bool flat = false, float z_low = -1.0f, float z_high = 1.0f)
    {
        begin(material);
        const int segments = 2 * rings;
        const auto point = [&](int ring, int segment) {
            if (ring == 0 || ring == rings) return glm::vec3(0.0f, 0.0f, ring == 0 ? -1.0f : 1.0f);
            const double theta = glm::pi<double>() * ring / rings;
            const double phi = 2.0 * glm::pi<double>() * (segment % segments) / segments;
            return glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), -std::cos(theta));
        };
        for (int i = 0; i < rings; ++i) {
            const float middle = -std::cos(glm::pi<float>() * (float(i) + 0.5f) / float(rings));
            if (middle < z_low || middle > z_high) continue;
            for (int j = 0; j < segments; ++j) {
                const glm::vec3 corners[4] = {point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)};
                for (int half = 0; half < 2; ++half) {
                    glm::vec3 a = corners[0], b = corners[half ? 2 : 1], c = corners[half ? 3 : 2];
                    if (a == b || b == c || a == c) continue;
                    if (inward) std::swap(b, c);
                    const glm::vec3 n = flat_normal(a, b, c);
                    const float side = inward ? -1.0f : 1.0f;
                    add({vertex(center + radius * a, flat ? n : side * a, {}),
                         vertex(center + radius * b, flat ? n : side * b, {}),
                         vertex(center + radius * c, flat ? n : side * c, {})},
                        {0, 1, 2});
                }
            }
        }
        end();
    }

    void point_light(const glm::vec3& position, const glm::vec3& intensity, float range = 0.0f)
    {
        Light light;
        light.position = position;
        light.intensity = intensity;
        light.range = range;
        scene_.lights.push_back(light);
    }
    void directional_light(const glm::vec3& direction, const glm::vec3& irradiance)
    {
        Light light;
        light.type = LightType::directional;
        light.direction = glm::normalize(direction);
        light.intensity = irradiance;
        scene_.lights.push_back(light);
    }
    void spot_light(const glm::vec3& position, const glm::vec3& direction, const glm::vec3& intensity, float inner,
                    float outer)
    {
        Light light;
        light.type = LightType::spot;
        light.position = position;
        light.direction = glm::normalize(direction);
        light.intensity = intensity;
        light.inner_cone_angle = inner;
        light.outer_cone_angle = outer;
        scene_.lights.push_back(light);
    }

    // Rotates all geometry and lights added so far round the origin.
    void transform(const glm::mat3& rotation)
    {
        for (Vertex& v : scene_.vertices) {
            v.position = rotation * v.position;
            v.normal = rotation * v.normal;
            v.tangent = glm::vec4(rotation * glm::vec3(v.tangent), v.tangent.w);
        }
        for (Light& light : scene_.lights) {
            light.position = rotation * light.position;
            light.direction = rotation * light.direction;
        }
    }

    // The scene with its bounds. Positions stay as they were given (origin_ws is 0).
    Scene build() const
    {
        Scene scene = scene_;
        if (scene.materials.empty()) scene.materials.push_back(lambert(0.5f));
        if (!scene.vertices.empty()) scene.bounds = {scene.vertices[0].position, scene.vertices[0].position};
        for (const Vertex& v : scene.vertices) {
            scene.bounds.min = glm::min(scene.bounds.min, v.position);
            scene.bounds.max = glm::max(scene.bounds.max, v.position);
        }
        scene.name = "scene made in code";
        return scene;
    }

private:
    static glm::vec3 flat_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
    {
        const glm::vec3 n = glm::cross(b - a, c - a);
        const float length = glm::length(n);
        return length > 0.0f ? n / length : glm::vec3(0, 1, 0);
    }
    static Vertex vertex(const glm::vec3& p, const glm::vec3& n, const glm::vec2& uv)
    {
        const glm::vec3 t =
            glm::normalize(std::abs(n.x) < 0.9f ? glm::vec3(1, 0, 0) - n.x * n : glm::vec3(0, 1, 0) - n.y * n);
        return {p, n, glm::vec4(t, 1.0f), uv, uv, glm::vec4(1.0f)};
    }
    void add_quad(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, int cells)
    {
        const glm::vec3 n = glm::normalize(glm::cross(u, v));
        std::vector<Vertex> vertices;
        std::vector<std::uint32_t> indices;
        for (int j = 0; j <= cells; ++j)
            for (int i = 0; i <= cells; ++i) {
                const glm::vec2 uv = glm::vec2(i, j) / float(cells);
                vertices.push_back(vertex(corner + uv.x * u + uv.y * v, n, uv));
                vertices.back().tangent = glm::vec4(glm::normalize(u), 1.0f);
            }
        const auto at = [&](int i, int j) { return std::uint32_t(j * (cells + 1) + i); };
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i)
                indices.insert(indices.end(),
                               {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        add(vertices, indices);
    }
    void add_box_face(const glm::vec3& low, const glm::vec3& high, int face, bool inward)
    {
        const int a = face / 2, b = (a + 1) % 3, c = (a + 2) % 3;
        const bool upper = face % 2 == 1;
        glm::vec3 corner = low, u(0.0f), v(0.0f);
        corner[a] = upper ? high[a] : low[a];
        u[b] = high[b] - low[b];
        v[c] = high[c] - low[c];  // cross(u, v) points along +a
        if (upper == inward) std::swap(u, v);
        add_quad(corner, u, v, 1);
    }
    void begin(int material) { scene_.draws.push_back({std::uint32_t(scene_.indices.size()), 0, material, ""}); }
    void add(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices)
    {
        const auto base = std::uint32_t(scene_.vertices.size());
        scene_.vertices.insert(scene_.vertices.end(), vertices.begin(), vertices.end());
        for (const std::uint32_t i : indices) scene_.indices.push_back(base + i);
    }
    void end()
    {
        scene_.draws.back().index_count = std::uint32_t(scene_.indices.size()) - scene_.draws.back().first_index;
    }

    Scene scene_;
};

}  // namespace conebook
