// What the scene's materials and textures are at a point of a triangle.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "reference/brdf.hpp"
#include "scene/scene.hpp"

namespace conebook {

// A point on a surface, seen from one side. Normals face that side.
struct SurfaceHit {
    float distance = 0.0f;                 // in lengths of the ray's direction
    glm::vec3 position{0.0f};              // scene space, m
    glm::vec3 geometric_normal{0.0f};      // unit, towards the side that was hit
    glm::vec3 shading_normal{0.0f};        // unit, interpolated and normal-mapped
    std::uint32_t draw = 0, triangle = 0;  // index into Scene::draws, and within it
    bool front = true;                     // hit from the side from which the triangle winds counter-clockwise
    bool dark = false;           // the back of a single-sided surface: blocks light, reflects and emits nothing
    glm::vec3 base_color{0.0f};  // linear
    glm::vec3 emission{0.0f};    // radiance towards the side that was hit
    Brdf brdf;
};

// Bilinear (or nearest, as the slot says) at level 0; sRGB texels are decoded before they are mixed. Alpha is linear.
glm::vec4 sample_texture(const Image& image, const TextureSlot& slot, glm::vec2 uv, bool srgb);

// The vertex attributes of a triangle at barycentrics (u, v): (1 - u - v) v0 + u v1 + v v2.
struct TrianglePoint {
    const Vertex *v0, *v1, *v2;
    float u, v;
    template <typename T>
    T mix(T Vertex::*member) const
    {
        return (1.0f - u - v) * (v0->*member) + u * (v1->*member) + v * (v2->*member);
    }
};
TrianglePoint triangle_point(const Scene& scene, const Draw& draw, std::uint32_t triangle, float u, float v);

// False where an alpha-masked material has a hole.
bool covers(const Scene& scene, const Material& material, const TrianglePoint& point);

// Emitted radiance, W/(sr m^2): factor times texture; the base colour for unlit materials, which are shown as they are.
glm::vec3 emitted_radiance(const Scene& scene, const Material& material, const TrianglePoint& point);

// All of the surface at the point, seen along direction (pointing towards the surface).
SurfaceHit evaluate_surface(const Scene& scene, std::uint32_t draw, std::uint32_t triangle, float u, float v,
                            const glm::vec3& direction);

}  // namespace conebook
