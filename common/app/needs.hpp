// What a scene needs of its renderer and what it does not, in words, for the statistics.
#pragma once

#include <optional>
#include <vector>

#include "app/statistics.hpp"
#include "scene/scene.hpp"

namespace conebook {

// The camera that choose_camera(scene, index) places where the file has none.
Need camera_need(const Scene& scene, std::optional<int> index);

// The light that load_scene adds where nothing shines.
Need light_need(const Scene& scene);

// Of the surfaces that a camera sees: textures, alpha masks, normal maps, emission.
std::vector<Need> surface_needs(const Scene& scene);

// Whether some surface that is drawn has a specular lobe: metal, or a dielectric whose KHR_materials_specular factor is
// above 0. Where none has, specular cones bring nothing but zeros.
bool has_specular_surfaces(const Scene& scene);
// Whether some surface that is drawn has a diffuse lobe: none that is metal all over, unlit or black has. Where none has,
// diffuse cones bring nothing but zeros.
bool has_diffuse_surfaces(const Scene& scene);
bool has_emission(const Scene& scene);
Need specular_cone_need(const Scene& scene);

// `sky_radiance` in W/(sr m^2): what cones and the camera see that meet no surface.
Need sky_need(float sky_radiance);

}  // namespace conebook
