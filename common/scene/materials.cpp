#include <algorithm>
#include <cmath>

#include "scene/parts.hpp"

namespace conebook::gltf {
namespace {

using tinygltf::Value;

// ---- values of an extension; types are already checked by check_gltf ----

const Value* find(const tinygltf::ExtensionMap& extensions, const char* name)
{
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double number(const Value& object, const char* key, double otherwise)
{
    return object.IsObject() && object.Has(key) ? object.Get(key).GetNumberAsDouble() : otherwise;
}

template <int N>
glm::vec<N, double> numbers(const Value& object, const char* key, glm::vec<N, double> otherwise)
{
    if (!object.IsObject() || !object.Has(key)) return otherwise;
    const Value& list = object.Get(key);
    for (int i = 0; i < N; ++i) otherwise[i] = list.Get(i).GetNumberAsDouble();
    return otherwise;
}

struct TextureInfo {
    int texture = -1;
    int uv_set = 0;
    glm::mat3 uv_transform{1.0f};
};

// KHR_texture_transform: uv' = T R S uv. "Rotate the UVs counter-clockwise", and v points down, so that
// (1, 0) turns towards (cos, -sin): the extension's own example (offset (0, 1), rotation pi/2, scale 1/2 uses the
// lower left quadrant) holds only so.
glm::mat3 uv_transform(const Value& extension)
{
    const glm::dvec2 offset = numbers<2>(extension, "offset", {0.0, 0.0});
    const glm::dvec2 scale = numbers<2>(extension, "scale", {1.0, 1.0});
    const double rotation = number(extension, "rotation", 0.0);
    const double c = std::cos(rotation), s = std::sin(rotation);
    const glm::dmat3 matrix(glm::dvec3(scale.x * c, -scale.x * s, 0.0), glm::dvec3(scale.y * s, scale.y * c, 0.0),
                            glm::dvec3(offset, 1.0));
    glm::mat3 result;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) result[i][j] = to_float(matrix[i][j], "KHR_texture_transform");
    }
    return result;
}

void apply_transform(TextureInfo& info, const Value* extension)
{
    if (!extension) return;
    info.uv_transform = uv_transform(*extension);
    info.uv_set = static_cast<int>(number(*extension, "texCoord", info.uv_set));
}

template <class Info>  // TextureInfo or NormalTextureInfo of tinygltf
TextureInfo texture_info(const Info& source)
{
    TextureInfo info{source.index, source.texCoord};
    apply_transform(info, find(source.extensions, "KHR_texture_transform"));
    return info;
}

TextureInfo texture_info(const Value& extension, const char* key)
{
    if (!extension.IsObject() || !extension.Has(key)) return {};
    const Value& source = extension.Get(key);
    TextureInfo info{static_cast<int>(number(source, "index", -1)), static_cast<int>(number(source, "texCoord", 0))};
    if (source.Has("extensions") && source.Get("extensions").Has("KHR_texture_transform")) {
        apply_transform(info, &source.Get("extensions").Get("KHR_texture_transform"));
    }
    return info;
}

// ---- one material ----

class MaterialReader {
public:
    MaterialReader(const Document& document, Materials& all, Warnings& warnings)
        : document_(document), all_(all), warnings_(warnings)
    {
    }

    void read(std::size_t index);

private:
    // A factor whose range glTF limits; outside it light would be made from nothing.
    float limited(double value, const char* what)
    {
        if (value < 0.0 || value > 1.0) warn(warnings_, where_ + ": " + what + " is outside 0..1 and is clamped");
        return static_cast<float>(std::clamp(value, 0.0, 1.0));
    }
    // `encoding` of what the material takes from the texture.
    TextureSlot slot(const TextureInfo& info, Encoding encoding);
    int image_index(int source, Encoding encoding);
    void assign_uv_sets(Material& material, MaterialReading& reading);

    const Document& document_;
    Materials& all_;
    Warnings& warnings_;
    std::string where_;
};

Wrap wrap_mode(int mode)
{
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp_to_edge;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirrored_repeat : Wrap::repeat;
}

int MaterialReader::image_index(int source, Encoding encoding)
{
    auto found = std::find_if(all_.images.begin(), all_.images.end(),
                              [&](const ImageSource& image) { return image.image == source; });
    if (found == all_.images.end()) found = all_.images.insert(found, {source, Encoding::linear});
    if (encoding == Encoding::srgb) found->encoding = Encoding::srgb;
    return static_cast<int>(found - all_.images.begin());
}

// uv_set of the result is still the file's; assign_uv_sets maps it to 0 or 1.
TextureSlot MaterialReader::slot(const TextureInfo& info, Encoding encoding)
{
    TextureSlot result;
    if (info.texture < 0) return result;
    const auto& texture = document_.model.textures.at(static_cast<std::size_t>(info.texture));
    if (texture.source < 0) {
        warn(warnings_, "textures[" + std::to_string(info.texture) + "] has no PNG or JPEG image and is ignored");
        return result;
    }
    result.image = image_index(texture.source, encoding);
    result.uv_set = info.uv_set;
    result.uv_transform = info.uv_transform;
    if (texture.sampler < 0) return result;
    const auto& sampler = document_.model.samplers.at(static_cast<std::size_t>(texture.sampler));
    result.wrap_s = wrap_mode(sampler.wrapS);
    result.wrap_t = wrap_mode(sampler.wrapT);
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) result.mag_filter = Filter::nearest;
    const int minify = sampler.minFilter;
    if (minify == TINYGLTF_TEXTURE_FILTER_NEAREST || minify == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
        minify == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR) {
        result.min_filter = Filter::nearest;
    }
    result.mipmapped = minify != TINYGLTF_TEXTURE_FILTER_NEAREST && minify != TINYGLTF_TEXTURE_FILTER_LINEAR;
    return result;
}

void MaterialReader::assign_uv_sets(Material& material, MaterialReading& reading)
{
    // In order of what is missed most: a third set is dropped with its texture.
    const std::array slots = {&material.base_color_texture,         &material.normal_texture,
                              &material.metallic_roughness_texture, &material.emission_texture,
                              &material.specular_texture,           &material.specular_color_texture};
    std::vector<int> sets;
    for (TextureSlot* slot : slots) {
        if (!slot->present() || std::find(sets.begin(), sets.end(), slot->uv_set) != sets.end()) continue;
        if (sets.size() < 2) {
            sets.push_back(slot->uv_set);
        } else {
            warn(warnings_, where_ + " uses more than two UV sets; the texture with TEXCOORD_" +
                                std::to_string(slot->uv_set) + " is ignored");
            *slot = TextureSlot();
        }
    }
    for (const int set : {0, 1}) {
        if (sets.size() < 2 && std::find(sets.begin(), sets.end(), set) == sets.end()) sets.push_back(set);
    }
    std::sort(sets.begin(), sets.end());
    reading.uv_sets = {sets[0], sets[1]};
    for (TextureSlot* slot : slots) {
        if (slot->present()) slot->uv_set = slot->uv_set == sets[0] ? 0 : 1;
    }
}

void MaterialReader::read(std::size_t index)
{
    const auto& source = document_.model.materials[index];
    const auto& pbr = source.pbrMetallicRoughness;
    where_ = "materials[" + std::to_string(index) + "]" + (source.name.empty() ? "" : " '" + source.name + "'");
    Material material;
    MaterialReading reading;
    material.name = source.name;
    material.extras = source.extras_json_string;
    for (int c = 0; c < 4; ++c) {
        material.base_color[c] = limited(pbr.baseColorFactor.at(static_cast<std::size_t>(c)), "baseColorFactor");
    }
    material.metallic = limited(pbr.metallicFactor, "metallicFactor");
    material.roughness = limited(pbr.roughnessFactor, "roughnessFactor");
    material.normal_scale = to_float(source.normalTexture.scale, where_ + ": normalTexture.scale");
    material.double_sided = source.doubleSided;
    material.base_color_texture = slot(texture_info(pbr.baseColorTexture), Encoding::srgb);
    material.metallic_roughness_texture = slot(texture_info(pbr.metallicRoughnessTexture), Encoding::linear);
    material.normal_texture = slot(texture_info(source.normalTexture), Encoding::linear);
    material.emission_texture = slot(texture_info(source.emissiveTexture), Encoding::srgb);

    double strength = 1.0;
    if (const Value* extension = find(source.extensions, "KHR_materials_emissive_strength")) {
        strength = number(*extension, "emissiveStrength", 1.0);
    }
    for (int c = 0; c < 3; ++c) {
        const double emission = source.emissiveFactor.at(static_cast<std::size_t>(c)) * strength;
        if (emission < 0.0) fail(where_ + " has a negative emission");
        material.emission[c] = to_float(emission, where_ + ": its emission");
    }
    if (const Value* extension = find(source.extensions, "KHR_materials_specular")) {
        material.specular = limited(number(*extension, "specularFactor", 1.0), "specularFactor");
        const glm::dvec3 color = numbers<3>(*extension, "specularColorFactor", glm::dvec3(1.0));
        for (int c = 0; c < 3; ++c) {
            if (color[c] < 0.0) fail(where_ + " has a negative specularColorFactor");
            material.specular_color[c] = to_float(color[c], where_ + ": specularColorFactor");
        }
        material.specular_texture = slot(texture_info(*extension, "specularTexture"), Encoding::linear);
        material.specular_color_texture = slot(texture_info(*extension, "specularColorTexture"), Encoding::srgb);
    }
    material.unlit = find(source.extensions, "KHR_materials_unlit") != nullptr;

    if (source.alphaMode == "MASK") {
        material.alpha_mode = AlphaMode::mask;
        material.alpha_cutoff = to_float(source.alphaCutoff, where_ + ": alphaCutoff");
    } else if (source.alphaMode == "BLEND") {
        reading.blend = true;
    } else if (source.alphaMode != "OPAQUE") {
        fail(where_ + " has the unknown alphaMode '" + source.alphaMode + "'");
    }
    assign_uv_sets(material, reading);
    all_.materials.push_back(std::move(material));
    all_.readings.push_back(reading);
}

}  // namespace

Materials read_materials(const Document& document, Warnings& warnings)
{
    Materials all;
    MaterialReader reader(document, all, warnings);
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) reader.read(i);
    // glTF 2.0, 3.7.2.1: a primitive without a material has the default one. It is the last.
    all.materials.emplace_back();
    all.materials.back().name = "default";
    all.readings.emplace_back();
    return all;
}

}  // namespace conebook::gltf
