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
    int ray = int(RayDirection::cosine);
    // Rays of a light, 1 .. 64, each of which makes a light of the next bounce.
    int rays = 1;
    bool operator==(const FurtherLightParams&) const = default;
};
void add_parameters(ParameterTable& table, FurtherLightParams& params);

// Emissive patches, one light each, or runs of neighbours of equal flux. Their sum is what the mesh emits.
std::vector<PickedLight> emitter_lights(const PatchMesh& mesh, const FurtherLightParams& params);

// What the rays of `lights` meet reflects its share of their flux.
std::vector<PickedLight> next_bounce(const SceneTracer& tracer, const std::vector<PickedLight>& lights,
                                     const FurtherLightParams& params, double mesh_area);

// W.
glm::dvec3 total_flux(const std::vector<PickedLight>& lights);

}  // namespace conebook
