// Types, ranges and references of a glTF file, before anything relies on them. glTF 2.0, chapter 5.
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "scene/document.hpp"

namespace conebook::gltf {
namespace {

using nlohmann::json;

constexpr std::int64_t max_int = std::numeric_limits<int>::max();

// One JSON object with the path by which errors name it.
struct Object {
    json& value;
    std::string path;
    const json& root;

    bool has(const char* key) const { return value.contains(key); }
    std::string name(const char* key) const { return path.empty() ? key : path + "." + key; }

    void require(const char* key) const
    {
        if (!has(key)) fail(name(key) + " is missing");
    }
    void integer(const char* key, std::int64_t lowest, std::int64_t highest) const
    {
        if (has(key)) check_integer(value[key], name(key), lowest, highest);
    }
    // An index into the top level array `array`.
    void reference(const char* key, const char* array) const
    {
        if (has(key)) check_reference(value[key], name(key), array);
    }
    void references(const char* key, const char* array) const
    {
        if (!has(key)) return;
        if (!value[key].is_array()) fail(name(key) + " is not an array");
        for (json& element : value[key]) check_reference(element, name(key), array);
    }
    void number(const char* key) const
    {
        if (has(key) && !value[key].is_number()) fail(name(key) + " is not a number");
    }
    void numbers(const char* key, std::size_t count) const
    {
        if (!has(key)) return;
        const json& list = value[key];
        bool good = list.is_array() && list.size() == count;
        for (std::size_t i = 0; good && i < count; ++i) good = list[i].is_number();
        if (!good) fail(name(key) + " is not an array of " + std::to_string(count) + " numbers");
    }
    void text(const char* key) const
    {
        if (has(key) && !value[key].is_string()) fail(name(key) + " is not a string");
    }
    void texts(const char* key) const
    {
        if (!has(key)) return;
        bool good = value[key].is_array();
        for (const json& element : value[key]) good = good && element.is_string();
        if (!good) fail(name(key) + " is not an array of strings");
    }
    void flag(const char* key) const
    {
        if (has(key) && !value[key].is_boolean()) fail(name(key) + " is neither true nor false");
    }
    // Call `check` with the object `key`, if there is one.
    template <class Check>
    void object(const char* key, Check check) const
    {
        if (!has(key)) return;
        if (!value[key].is_object()) fail(name(key) + " is not an object");
        check(Object{value[key], name(key), root});
    }
    template <class Check>
    void objects(const char* key, Check check) const
    {
        if (!has(key)) return;
        if (!value[key].is_array()) fail(name(key) + " is not an array");
        for (std::size_t i = 0; i < value[key].size(); ++i) {
            const std::string element = name(key) + "[" + std::to_string(i) + "]";
            if (!value[key][i].is_object()) fail(element + " is not an object");
            check(Object{value[key][i], element, root});
        }
    }
    template <class Check>
    void extension(const char* key, Check check) const
    {
        object("extensions", [&](const Object& all) { all.object(key, check); });
    }

    void check_reference(json& element, const std::string& what, const char* array) const
    {
        const auto found = root.find(array);
        const std::int64_t count = found == root.end() ? 0 : static_cast<std::int64_t>(found->size());
        check_integer(element, what, 0, max_int);
        const auto index = element.get<std::int64_t>();
        if (index >= count) {
            fail(what + " is " + std::to_string(index) + ", but the file has " + std::to_string(count) + " " + array);
        }
    }
    // JSON does not tell 3 from 3.0; tinygltf does, so the latter is rewritten.
    static void check_integer(json& element, const std::string& what, std::int64_t lowest, std::int64_t highest)
    {
        if (!element.is_number()) fail(what + " is not a number");
        if (element.is_number_float()) {
            const double real = element.get<double>();
            if (real != std::floor(real) || std::abs(real) > 9e15) fail(what + " is not an integer in range");
            const auto whole = static_cast<std::int64_t>(real);
            if (whole >= 0)
                element = static_cast<std::uint64_t>(whole);
            else
                element = whole;
        }
        const bool too_large =
            element.is_number_unsigned() && element.get<std::uint64_t>() > static_cast<std::uint64_t>(highest);
        if (too_large || (!element.is_number_unsigned() && element.get<std::int64_t>() < lowest)) {
            fail(what + " is " + element.dump() + ", outside " + std::to_string(lowest) + " to " +
                 std::to_string(highest));
        }
        if (element.is_number_unsigned() && element.get<std::uint64_t>() < static_cast<std::uint64_t>(lowest) &&
            lowest > 0) {
            fail(what + " is " + element.dump() + ", below " + std::to_string(lowest));
        }
    }
};

void check_texture(const Object& info)
{
    info.require("index");
    info.reference("index", "textures");
    info.integer("texCoord", 0, 63);
    info.extension("KHR_texture_transform", [](const Object& transform) {
        transform.numbers("offset", 2);
        transform.number("rotation");
        transform.numbers("scale", 2);
        transform.integer("texCoord", 0, 63);
    });
}

void check_material(const Object& material)
{
    material.text("name");
    material.text("alphaMode");
    material.number("alphaCutoff");
    material.flag("doubleSided");
    material.numbers("emissiveFactor", 3);
    material.object("emissiveTexture", check_texture);
    material.object("occlusionTexture", check_texture);
    material.object("normalTexture", [](const Object& texture) {
        check_texture(texture);
        texture.number("scale");
    });
    material.object("pbrMetallicRoughness", [](const Object& pbr) {
        pbr.numbers("baseColorFactor", 4);
        pbr.number("metallicFactor");
        pbr.number("roughnessFactor");
        pbr.object("baseColorTexture", check_texture);
        pbr.object("metallicRoughnessTexture", check_texture);
    });
    material.extension("KHR_materials_unlit", [](const Object&) {});
    material.extension("KHR_materials_emissive_strength",
                       [](const Object& emission) { emission.number("emissiveStrength"); });
    material.extension("KHR_materials_specular", [](const Object& specular) {
        specular.number("specularFactor");
        specular.numbers("specularColorFactor", 3);
        specular.object("specularTexture", check_texture);
        specular.object("specularColorTexture", check_texture);
    });
}

void check_buffer_view(const Object& view)
{
    view.require("buffer");
    view.require("byteLength");
    view.reference("buffer", "buffers");
    view.integer("byteOffset", 0, max_int);
    view.integer("byteLength", 0, max_int);
    view.integer("byteStride", 4, 252);
    view.integer("target", 0, max_int);
    const std::uint64_t size = view.root.at("buffers").at(view.value["buffer"].get<std::size_t>()).at("byteLength");
    const auto end = view.value.value("byteOffset", std::uint64_t{0}) + view.value["byteLength"].get<std::uint64_t>();
    if (end > size) {
        fail(view.path + " ends at byte " + std::to_string(end) + " of a buffer of " + std::to_string(size) + " bytes");
    }
}

void check_accessor(const Object& accessor)
{
    accessor.require("componentType");
    accessor.require("count");
    accessor.require("type");
    accessor.text("type");
    accessor.integer("componentType", 5120, 5126);
    accessor.integer("count", 0, max_int);
    accessor.reference("bufferView", "bufferViews");
    accessor.integer("byteOffset", 0, max_int);
    accessor.flag("normalized");
    accessor.object("sparse", [](const Object& sparse) {
        sparse.require("count");
        sparse.integer("count", 0, max_int);
        sparse.require("indices");
        sparse.require("values");
        sparse.object("indices", [](const Object& indices) {
            indices.require("bufferView");
            indices.require("componentType");
            indices.reference("bufferView", "bufferViews");
            indices.integer("byteOffset", 0, max_int);
            indices.integer("componentType", 5121, 5125);
        });
        sparse.object("values", [](const Object& values) {
            values.require("bufferView");
            values.reference("bufferView", "bufferViews");
            values.integer("byteOffset", 0, max_int);
        });
    });
}

void check_mesh(const Object& mesh)
{
    mesh.text("name");
    mesh.require("primitives");
    mesh.objects("primitives", [](const Object& primitive) {
        primitive.integer("mode", 0, 6);
        primitive.reference("indices", "accessors");
        primitive.reference("material", "materials");
        primitive.require("attributes");
        primitive.object("attributes", [](const Object& attributes) {
            for (auto& [name, accessor] : attributes.value.items()) {
                attributes.check_reference(accessor, attributes.path + "." + name, "accessors");
            }
        });
        primitive.object("extensions", [](const Object&) {});
        primitive.objects("targets", [](const Object& target) {
            for (auto& [name, accessor] : target.value.items()) {
                target.check_reference(accessor, target.path + "." + name, "accessors");
            }
        });
    });
}

void check_node(const Object& node)
{
    node.text("name");
    node.reference("mesh", "meshes");
    node.reference("camera", "cameras");
    node.reference("skin", "skins");
    node.references("children", "nodes");
    node.numbers("matrix", 16);
    node.numbers("translation", 3);
    node.numbers("rotation", 4);
    node.numbers("scale", 3);
    node.extension("KHR_lights_punctual", [](const Object& light) {
        light.require("light");
        light.integer("light", 0, max_int);
        const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
        const std::size_t count = light.root.contains(lights) ? light.root.at(lights).size() : 0;
        if (light.value["light"].get<std::size_t>() >= count) {
            fail(light.name("light") + " is " + light.value["light"].dump() + ", but the file has " +
                 std::to_string(count) + " lights");
        }
    });
}

void check_light(const Object& light)
{
    light.require("type");
    light.text("type");
    light.text("name");
    light.numbers("color", 3);
    light.number("intensity");
    light.number("range");
    if (light.value["type"] == "spot") light.require("spot");
    light.object("spot", [](const Object& spot) {
        spot.number("innerConeAngle");
        spot.number("outerConeAngle");
    });
}

void check_camera(const Object& camera)
{
    camera.text("name");
    camera.require("type");
    camera.text("type");
    camera.object("perspective", [](const Object& lens) {
        for (const char* key : {"yfov", "znear", "zfar", "aspectRatio"}) lens.number(key);
    });
    camera.object("orthographic", [](const Object& lens) {
        for (const char* key : {"xmag", "ymag", "znear", "zfar"}) lens.number(key);
    });
}

void check_animation(const Object& animation)
{
    animation.text("name");
    animation.require("samplers");
    animation.require("channels");
    animation.objects("samplers", [](const Object& sampler) {
        sampler.require("input");
        sampler.require("output");
        sampler.reference("input", "accessors");
        sampler.reference("output", "accessors");
        sampler.text("interpolation");
    });
    const std::size_t count = animation.value["samplers"].size();
    animation.objects("channels", [&](const Object& channel) {
        channel.require("sampler");
        channel.require("target");
        channel.integer("sampler", 0, static_cast<std::int64_t>(count) - 1);
        channel.object("target", [](const Object& target) {
            target.reference("node", "nodes");
            target.require("path");
            target.text("path");
        });
    });
}

void check_skin(const Object& skin)
{
    skin.text("name");
    skin.require("joints");
    skin.references("joints", "nodes");
    skin.reference("inverseBindMatrices", "accessors");
    skin.reference("skeleton", "nodes");
}

}  // namespace

void check_gltf(json& root)
{
    // An empty path for the root keeps the names short: "accessors[3].count".
    const Object file{root, "", root};
    file.texts("extensionsUsed");
    file.texts("extensionsRequired");
    // Containers first: what follows looks up elements in them.
    for (const char* key : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials",
                            "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
        file.objects(key, [](const Object& element) {
            if (element.has("extensions") && !element.value["extensions"].is_object()) {
                fail(element.name("extensions") + " is not an object");
            }
        });
    }
    file.extension("KHR_lights_punctual", [](const Object& lights) { lights.objects("lights", check_light); });
    file.objects("buffers", [](const Object& buffer) {
        buffer.require("byteLength");
        buffer.integer("byteLength", 0, max_int);
        buffer.text("uri");
    });
    file.objects("bufferViews", check_buffer_view);
    file.objects("accessors", check_accessor);
    file.objects("images", [](const Object& image) {
        image.text("name");
        image.text("uri");
        image.reference("bufferView", "bufferViews");
    });
    file.objects("samplers", [](const Object& sampler) {
        for (const char* key : {"magFilter", "minFilter", "wrapS", "wrapT"}) sampler.integer(key, 0, max_int);
    });
    file.objects("textures", [](const Object& texture) {
        texture.reference("source", "images");
        texture.reference("sampler", "samplers");
    });
    file.objects("materials", check_material);
    file.objects("meshes", check_mesh);
    file.objects("cameras", check_camera);
    file.objects("nodes", check_node);
    file.objects("animations", check_animation);
    file.objects("skins", check_skin);
    file.objects("scenes", [](const Object& scene) {
        scene.text("name");
        scene.references("nodes", "nodes");
    });
    file.reference("scene", "scenes");
}

}  // namespace conebook::gltf
