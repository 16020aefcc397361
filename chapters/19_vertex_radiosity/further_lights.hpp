// The other ways to become a light: by emitting, and by being met by a ray of one.
#pragma once

#include "19_vertex_radiosity/light_picker.hpp"
#include "reference/scene_tracer.hpp"

namespace conebook {

enum class RayDirection : int { cosine, mirror };

struct FurtherLightParams {
    // Most lights that emissive surfaces become, 1 .. 4096; where they have more patches, neighbours share one.
    int emitter_lights = 256;
    // Which way a light sends its rays: about its normal, as a diffuse patch does, or mirrored, as in the document.
    RayDirection ray = RayDirection::cosine;
    // Rays of a light of step 2, each of which makes a light of the next bounce, 1 .. 64 (the document has 1). 0: up to
    // 16, as long as there are no more than usual_lights().
    int rays = 0;
    bool operator==(const FurtherLightParams&) const = default;
};
void add_parameters(ParameterTable& table, FurtherLightParams& params);
// Rays of each of so many lights of step 2.
int rays_of(const FurtherLightParams& params, std::size_t lights, std::size_t patches);

// Emissive patches, one light each, or runs of neighbours of equal flux whose parts they are. Their sum is what the
// mesh emits.
std::vector<PickedLight> emitter_lights(const PatchMesh& mesh, const FurtherLightParams& params);

// What the rays of `lights` meet reflects its share of their flux: bounce 2 and those after it. From the third on a
// light goes on with a probability, the share that it would have kept, and keeps all its flux (Keller 1997): as the
// light fades the lights become fewer, not weaker. `first_ray` numbers the rays of all bounces through.
struct NextBounce {
    int number = 2;
    std::size_t first_ray = 0;
};
std::vector<PickedLight> next_bounce(const SceneTracer& tracer, const std::vector<PickedLight>& lights,
                                     const FurtherLightParams& params, const PatchMesh& mesh, NextBounce bounce);

// W.
glm::dvec3 total_flux(const std::vector<PickedLight>& lights);

}  // namespace conebook
