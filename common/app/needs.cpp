#include "app/needs.hpp"

#include <algorithm>
#include <functional>
#include <set>

namespace conebook {

namespace {

std::vector<Material> drawn_materials(const Scene& scene)
{
    std::set<int> drawn;
    for (const Draw& draw : scene.draws) drawn.insert(draw.material);
    std::vector<Material> materials;
    for (const int index : drawn) materials.push_back(scene.materials[std::size_t(index)]);
    return materials;
}

bool has_specular_lobe(const Material& m) { return !m.unlit && (m.metallic > 0.0f || m.specular > 0.0f); }
bool has_diffuse_lobe(const Material& m)
{
    const bool metal = m.metallic >= 1.0f && !m.metallic_roughness_texture.present();
    return !m.unlit && !metal && glm::vec3(m.base_color) != glm::vec3(0.0f);
}

// "3 of 8 materials ...", or "no material ...".
template <typename Has>
Need material_need(const std::string& name, const std::vector<Material>& materials, Has has, const std::string& verb)
{
    const auto count = std::count_if(materials.begin(), materials.end(), has);
    return {name, count > 0,
            (count > 0 ? std::to_string(count) + " of " + std::to_string(materials.size()) + " materials "
                       : "no material ") +
                verb};
}

}  // namespace

Need camera_need(const Scene& scene, std::optional<int> index)
{
    if (scene.cameras.empty()) return {"framing camera", true, "the file has no camera: one that sees all of it"};
    return {"framing camera", false, "the picture is seen by the file's camera " + std::to_string(index.value_or(0))};
}

Need light_need(const Scene& scene)
{
    if (scene.has_default_light) return {"default light", true, "nothing in the file shines: a directional light"};
    if (scene.lights.empty()) return {"default light", false, "the file has surfaces that shine"};
    return {"default light", false, "lights in the file: " + std::to_string(scene.lights.size())};
}

std::vector<Need> surface_needs(const Scene& scene)
{
    const std::vector<Material> materials = drawn_materials(scene);
    const auto textured = [](const Material& m) {
        return m.base_color_texture.present() || m.metallic_roughness_texture.present() ||
               m.normal_texture.present() || m.emission_texture.present() || m.specular_texture.present() ||
               m.specular_color_texture.present();
    };
    const auto masked = [](const Material& m) { return m.alpha_mode == AlphaMode::mask; };
    const auto mapped = [](const Material& m) { return m.normal_texture.present(); };
    return {material_need("textures", materials, textured, "with textures"),
            material_need("alpha mask", materials, masked, "with a mask"),
            material_need("normal maps", materials, mapped, "with a normal map"),
            material_need("emission", materials, std::mem_fn(&Material::shines), "with emission")};
}

bool has_specular_surfaces(const Scene& scene)
{
    const std::vector<Material> materials = drawn_materials(scene);
    return std::any_of(materials.begin(), materials.end(), has_specular_lobe);
}

bool has_diffuse_surfaces(const Scene& scene)
{
    const std::vector<Material> materials = drawn_materials(scene);
    return std::any_of(materials.begin(), materials.end(), has_diffuse_lobe);
}

bool has_emission(const Scene& scene)
{
    const std::vector<Material> materials = drawn_materials(scene);
    return std::any_of(materials.begin(), materials.end(), std::mem_fn(&Material::shines));
}

Need specular_cone_need(const Scene& scene)
{
    return material_need("specular cones", drawn_materials(scene), has_specular_lobe, "with a specular lobe");
}

Need sky_need(float sky_radiance)
{
    const bool shines = sky_radiance > 0.0f;
    return {"sky", shines, shines ? "light of what leaves the scene" : "sky=0: what leaves the scene sees nothing"};
}

}  // namespace conebook
