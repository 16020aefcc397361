// What the patches are made of, and how much light leaves them before any of it was reflected from patch to patch.
#pragma once

#include <cstdint>
#include <vector>

#include "20_form_factor_radiosity/patch_mesh.hpp"
#include "app/parameters.hpp"
#include "reference/scene_tracer.hpp"

namespace conebook {

struct PatchParams {
    // Triangles of the mesh, 1 .. 400000: a budget. A scene that has more keeps its own.
    int patches = 10000;
    // m, 0.001 .. 1000; 0: as long as the budget gives. No edge is longer, if the budget lasts.
    float max_edge = 0.0f;
    // Spend half of the budget where a first solution has its gradients.
    bool adaptive = true;
    // Reflection of at most this perceptual roughness is a mirror's; rougher lobes reflect as if they were diffuse.
    float mirror_roughness = 0.1f;
    // Mirrors reflect more at grazing angles (Schlick), as in the book's material. Off: F0 at every angle.
    bool fresnel = true;
    bool operator==(const PatchParams&) const = default;
};
void add_parameters(ParameterTable& table, PatchParams& params);

// Places on a patch, for its materials, direct light, rays; and those where patches are more than kManyPatches.
constexpr int kPatchPoints = 16, kFewPatchPoints = 4;
constexpr std::size_t kManyPatches = 100000;
constexpr std::uint32_t kNoPatch = 0xffffffffu;

// One side of a leaf of the mesh.
struct Patch {
    std::uint32_t node = 0;
    bool back = false;  // of a double-sided triangle
    bool mirror = false;
    std::uint16_t exposed = 0;  // bit k: point k is not inside something solid
    std::uint32_t draw = 0;
    float area = 0.0f;              // m^2, of what is exposed
    glm::vec3 normal{0.0f};         // unit, of the triangle, towards this side
    glm::vec3 center{0.0f};         // mean of the exposed points, m
    glm::vec3 rho{0.0f};            // diffuse reflectance, lobes too rough for a mirror included
    glm::vec3 f0{0.0f}, f90{0.0f};  // of the mirror; 0 where there is none
    glm::vec3 emitted{0.0f};        // radiant exitance, pi times emitted radiance, W/m^2
    glm::vec3 lit{0.0f};            // radiosity that punctual lights cause directly, W/m^2
};

// A ray that a mirror sends on. rgb of `weight`: what is left of it.
struct Reflection {
    glm::vec3 origin, direction, weight;
};

class Patches {
public:
    // The scene and the tracer must outlive this.
    Patches(const SceneTracer& tracer, const PatchParams& params, BisectedMesh mesh);

    // Sets Patch::lit from these lights.
    void light(const std::vector<Light>& lights);

    const BisectedMesh& mesh() const { return mesh_; }
    const SceneTracer& tracer() const { return *tracer_; }
    const std::vector<Patch>& all() const { return patches_; }
    std::size_t size() const { return patches_.size(); }
    const Patch& operator[](std::size_t i) const { return patches_[i]; }
    bool has_mirrors() const { return has_mirrors_; }
    int points() const { return size() > kManyPatches ? kFewPatchPoints : kPatchPoints; }      // of each patch
    bool is_open(const Patch& patch) const { return patch.exposed == (1u << points()) - 1u; }  // all of them exposed

    // The patch on a side of a leaf; kNoPatch for the back of a single-sided surface and for triangles without area.
    std::uint32_t on(std::uint32_t leaf, bool front) const { return (front ? front_ : back_)[leaf]; }
    // And at a point that a ray has met.
    std::uint32_t at(const SurfaceHit& hit) const;
    PatchPlace place(const SurfaceHit& hit) const;
    std::uint32_t triangle(const SurfaceHit& hit) const;

    // Point k = 0, 1, ... of a patch, all of them even over its area, its surface seen along the normal.
    SurfaceHit point(const Patch& patch, int k) const;
    SurfaceHit point(const Patch& patch, const glm::vec3& weights) const;

    // What a mirror at a point, met along `direction` (unit), sends on; weight 0 when there is no mirror.
    Reflection reflect(const SurfaceHit& hit, const glm::vec3& direction) const;
    // rho_s of a mirror at an angle: Schlick, or F0.
    glm::vec3 mirror_share(const glm::vec3& f0, const glm::vec3& f90, float cosine) const;
    bool is_mirror(const Brdf& brdf) const;

    // Of all patches: the largest rho + rho_s (mean over angles), and how many reach 1.
    struct Brightest {
        float reflectance = 0.0f;
        std::size_t without_loss = 0;
    };
    Brightest brightest() const;

private:
    void fill(std::uint32_t index);
    const SceneTracer* tracer_;
    PatchParams params_;
    BisectedMesh mesh_;
    std::vector<std::uint32_t> draw_of_;  // of each triangle
    std::vector<Patch> patches_;
    std::vector<std::uint32_t> front_, back_;
    bool has_mirrors_ = false;
};

// Mean over the cosine-weighted hemisphere of Schlick's F0 + (F90 - F0) (1 - cos)^5: F0 + (F90 - F0) / 21.
glm::vec3 mean_reflectance(const glm::vec3& f0, const glm::vec3& f90);

// Irradiance at a point from punctual lights that see it, times the brdf's diffuse part pi / 1: radiosity, W/m^2.
glm::vec3 directly_lit(const SceneTracer& tracer, const std::vector<Light>& lights, const SurfaceHit& hit,
                       const glm::vec3& rho);

// Whether a point of a surface lies inside something solid: of eight rays that leave it, more than half meet backs.
bool is_buried(const SceneTracer& tracer, const glm::vec3& point, const glm::vec3& normal, std::uint32_t seed);

// Runs work(i) for i in [0, count) on all cores, each i by one thread.
void for_all(std::size_t count, const std::function<void(std::size_t)>& work);

// Point i of a (0,2)-sequence, both digits scrambled (Kollig & Keller 2002, "Efficient multidimensional sampling",
// 3.1): any 2^k in a row have one in each of the 2^k equal boxes of every shape.
glm::vec2 sequence_02(std::uint32_t i, std::uint32_t scramble_x, std::uint32_t scramble_y);
// Weights of the corners of a triangle, uniform over its area for u uniform in [0, 1)^2.
glm::vec3 triangle_weights(glm::vec2 u);

}  // namespace conebook
