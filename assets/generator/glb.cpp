#include "glb.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

namespace conebook::generator {
namespace {

using nlohmann::ordered_json;

// Numbers that come out of trigonometry are rounded, so that every maths library gives the same text.
double rounded(double value) { return std::round(value * 1e9) / 1e9 + 0.0; }

ordered_json array_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
ordered_json array_of(const glm::dquat& q) { return {rounded(q.x), rounded(q.y), rounded(q.z), rounded(q.w)}; }

// Rotation that turns -z, along which glTF cameras and lights look, to `forward`.
ordered_json look_rotation(const glm::dvec3& forward, glm::dvec3 up) {
    const glm::dvec3 z = -glm::normalize(forward);
    if (glm::length(glm::cross(up, z)) < 1e-3) {
        up = glm::dvec3(0.0, 0.0, -1.0);
    }
    const glm::dvec3 x = glm::normalize(glm::cross(up, z));
    const glm::dquat q = glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z));
    return array_of(q);
}

class Writer {
public:
    explicit Writer(const Asset& asset) : asset_(asset) {}

    std::vector<std::uint8_t> write() {
        json_["asset"] = {
            {"version", "2.0"}, {"generator", "conebook make_assets"}, {"copyright", "conebook, CC BY 4.0"}};
        json_["extensionsUsed"] = ordered_json::array();
        json_["scene"] = 0;
        json_["scenes"] = {{{"name", asset_.name}, {"nodes", ordered_json::array()}}};
        json_["nodes"] = ordered_json::array();
        for (const Material& material : asset_.materials) {
            json_["materials"].push_back(material_json(material));
        }
        write_textures();
        write_objects();
        write_lights();
        write_cameras();
        write_skin();
        write_tracks();
        json_["extensionsUsed"] = extensions_;
        if (extensions_.empty()) {
            json_.erase("extensionsUsed");
        }
        json_["buffers"] = {{{"byteLength", bin_.size()}}};
        return assemble();
    }

private:
    template <class T>
    std::size_t buffer_view(const std::vector<T>& data, int target) {
        while (bin_.size() % 4 != 0) {
            bin_.push_back(0);
        }
        const std::size_t offset = bin_.size(), size = data.size() * sizeof(T);
        bin_.resize(offset + size);
        std::memcpy(bin_.data() + offset, data.data(), size);
        ordered_json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}};
        if (target != 0) {
            view["target"] = target;
        }
        json_["bufferViews"].push_back(view);
        return json_["bufferViews"].size() - 1;
    }

    std::size_t accessor(std::size_t view, int component_type, std::size_t count, const char* type) {
        json_["accessors"].push_back(
            {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
        return json_["accessors"].size() - 1;
    }

    // The extent that glTF asks for of positions.
    void bound(std::size_t accessor, const std::vector<glm::vec3>& values) {
        glm::vec3 low = values.at(0), high = low;
        for (const glm::vec3& value : values) {
            low = glm::min(low, value);
            high = glm::max(high, value);
        }
        json_["accessors"][accessor]["min"] = array_of(low);
        json_["accessors"][accessor]["max"] = array_of(high);
    }

    ordered_json mesh_primitive(const Mesh& mesh) {
        constexpr int array_buffer = 34962, element_buffer = 34963, float32 = 5126, uint16 = 5123;
        if (mesh.positions.size() > 65535) {
            throw std::runtime_error(asset_.name + ": a mesh has more than 65535 vertices");
        }
        const std::size_t count = mesh.positions.size();
        const auto positions = accessor(buffer_view(mesh.positions, array_buffer), float32, count, "VEC3");
        bound(positions, mesh.positions);
        const auto normals = accessor(buffer_view(mesh.normals, array_buffer), float32, count, "VEC3");
        const auto uvs = accessor(buffer_view(mesh.uvs, array_buffer), float32, count, "VEC2");
        const std::vector<std::uint16_t> indices(mesh.indices.begin(), mesh.indices.end());
        const auto index = accessor(buffer_view(indices, element_buffer), uint16, indices.size(), "SCALAR");
        ordered_json primitive = {
            {"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}}, {"indices", index}};
        if (!mesh.joints.empty()) {
            constexpr int uint8 = 5121;
            primitive["attributes"]["JOINTS_0"] =
                accessor(buffer_view(mesh.joints, array_buffer), uint8, count, "VEC4");
            primitive["attributes"]["WEIGHTS_0"] =
                accessor(buffer_view(mesh.joint_weights, array_buffer), float32, count, "VEC4");
        }
        for (const Mesh::Target& target : mesh.targets) {
            const auto moved = accessor(buffer_view(target.positions, array_buffer), float32, count, "VEC3");
            bound(moved, target.positions);
            const auto turned = accessor(buffer_view(target.normals, array_buffer), float32, count, "VEC3");
            primitive["targets"].push_back(ordered_json{{"POSITION", moved}, {"NORMAL", turned}});
        }
        return primitive;
    }

    ordered_json material_json(const Material& m) {
        ordered_json out = {{"name", m.name}};
        ordered_json pbr = {{"baseColorFactor", {m.base_color.r, m.base_color.g, m.base_color.b, 1.0}},
                            {"metallicFactor", m.metallic},
                            {"roughnessFactor", m.roughness}};
        if (m.base_color_texture >= 0) {
            pbr["baseColorTexture"] = {{"index", m.base_color_texture}};
        }
        if (m.metallic_roughness_texture >= 0) {
            pbr["metallicRoughnessTexture"] = {{"index", m.metallic_roughness_texture}};
        }
        out["pbrMetallicRoughness"] = pbr;
        if (m.normal_texture >= 0) {
            out["normalTexture"] = {{"index", m.normal_texture}};
        }
        if (m.emission_texture >= 0) {
            out["emissiveTexture"] = {{"index", m.emission_texture}};
        }
        const double strength = glm::max(m.emission.r, glm::max(m.emission.g, m.emission.b));
        if (strength > 0.0) {
            // emissiveFactor is at most 1; what is above goes into the strength.
            const double scale = glm::max(strength, 1.0);
            out["emissiveFactor"] = array_of(m.emission / scale);
            if (scale > 1.0) {
                out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", scale}};
                extensions_.insert("KHR_materials_emissive_strength");
            }
        }
        if (m.specular != 1.0) {
            out["extensions"]["KHR_materials_specular"] = {{"specularFactor", m.specular}};
            extensions_.insert("KHR_materials_specular");
        }
        if (m.alpha_mask) {
            out["alphaMode"] = "MASK";
            out["alphaCutoff"] = 0.5;
        }
        if (m.double_sided) {
            out["doubleSided"] = true;
        }
        return out;
    }

    void write_textures() {
        if (asset_.textures.empty()) {
            return;
        }
        constexpr int linear = 9729, linear_mipmap_linear = 9987, repeat = 10497;
        json_["samplers"] = {
            {{"magFilter", linear}, {"minFilter", linear_mipmap_linear}, {"wrapS", repeat}, {"wrapT", repeat}}};
        for (std::size_t i = 0; i < asset_.textures.size(); ++i) {
            json_["textures"].push_back({{"sampler", 0}, {"source", i}});
            json_["images"].push_back(
                {{"bufferView", buffer_view(encode_png(asset_.textures[i]), 0)}, {"mimeType", "image/png"}});
        }
    }

    // One glTF mesh per object: objects of one Mesh share its accessors, whatever their materials.
    void write_objects() {
        std::vector<ordered_json> primitives;
        for (const Mesh& mesh : asset_.meshes) {
            primitives.push_back(mesh_primitive(mesh));
        }
        for (const Object& object : asset_.objects) {
            ordered_json node;
            node["name"] = object.name;
            if (object.mesh >= 0) {
                const auto mesh = static_cast<std::size_t>(object.mesh);
                ordered_json primitive = primitives.at(mesh);
                primitive["material"] = object.material;
                json_["meshes"].push_back({{"name", object.name}, {"primitives", {primitive}}});
                if (!asset_.meshes[mesh].targets.empty()) {
                    json_["meshes"].back()["weights"] = std::vector<double>(asset_.meshes[mesh].targets.size(), 0.0);
                }
                node["mesh"] = json_["meshes"].size() - 1;
            }
            if (object.skinned) {
                node["skin"] = 0;
            }
            if (object.translation != glm::dvec3(0.0)) {
                node["translation"] = array_of(object.translation);
            }
            if (object.rotation != glm::dquat(1.0, 0.0, 0.0, 0.0)) {
                node["rotation"] = array_of(object.rotation);
            }
            add_node(node, object.parent);
        }
    }

    void write_lights() {
        ordered_json lights = ordered_json::array();
        for (const Light& light : asset_.lights) {
            constexpr const char* kinds[] = {"directional", "point", "spot"};
            ordered_json out = {{"name", light.name},
                                {"type", kinds[static_cast<int>(light.kind)]},
                                {"color", array_of(light.color)},
                                {"intensity", light.intensity}};
            if (light.kind == LightKind::spot) {
                out["spot"] = {{"innerConeAngle", rounded(glm::radians(light.inner_degrees))},
                               {"outerConeAngle", rounded(glm::radians(light.outer_degrees))}};
            }
            ordered_json node = {{"name", light.name}, {"translation", array_of(light.position)}};
            if (light.kind != LightKind::point) {
                node["rotation"] = look_rotation(light.direction, {0.0, 1.0, 0.0});
            }
            node["extensions"]["KHR_lights_punctual"] = {{"light", lights.size()}};
            lights.push_back(out);
            add_node(node, light.parent);
        }
        if (!lights.empty()) {
            json_["extensions"]["KHR_lights_punctual"] = {{"lights", lights}};
            extensions_.insert("KHR_lights_punctual");
        }
    }

    void write_cameras() {
        for (const Camera& camera : asset_.cameras) {
            json_["cameras"].push_back(
                {{"name", camera.name},
                 {"type", "perspective"},
                 {"perspective", {{"yfov", rounded(glm::radians(camera.y_fov_degrees))}, {"znear", 0.01}}}});
            add_node({{"name", camera.name},
                      {"camera", json_["cameras"].size() - 1},
                      {"translation", array_of(camera.eye)},
                      {"rotation", look_rotation(camera.target - camera.eye, camera.up)}});
        }
    }

    // Object i is node i, which a child names as its parent.
    void add_node(const ordered_json& node, int parent = -1) {
        const std::size_t index = json_["nodes"].size();
        if (parent < 0) {
            json_["scenes"][0]["nodes"].push_back(index);
        } else {
            json_["nodes"].at(static_cast<std::size_t>(parent))["children"].push_back(index);
        }
        json_["nodes"].push_back(node);
    }

    // World from object, as everything stands without animation.
    glm::dmat4 rest(int object) const {
        const Object& o = asset_.objects.at(static_cast<std::size_t>(object));
        glm::dmat4 local = glm::mat4_cast(o.rotation);
        local[3] = glm::dvec4(o.translation, 1.0);
        return o.parent < 0 ? local : rest(o.parent) * local;
    }

    // The mesh is modelled where the joints stand at rest.
    void write_skin() {
        if (asset_.joints.empty()) {
            return;
        }
        std::vector<glm::mat4> inverse_bind;
        for (const int joint : asset_.joints) {
            const glm::dmat4 exact = glm::inverse(rest(joint));
            glm::mat4& matrix = inverse_bind.emplace_back();
            for (int i = 0; i < 16; ++i) {
                matrix[i / 4][i % 4] = snapped(exact[i / 4][i % 4]);
            }
        }
        const auto matrices = accessor(buffer_view(inverse_bind, 0), 5126, inverse_bind.size(), "MAT4");
        json_["skins"].push_back(ordered_json{{"inverseBindMatrices", matrices}, {"joints", asset_.joints}});
    }

    void write_tracks() {
        if (asset_.tracks.empty()) {
            return;
        }
        constexpr const char* paths[] = {"translation", "rotation", "scale", "weights"};
        constexpr const char* ways[] = {"STEP", "LINEAR", "CUBICSPLINE"};
        ordered_json channels, samplers;
        for (const Track& track : asset_.tracks) {
            const std::vector<float> times(track.times_s.begin(), track.times_s.end());
            std::vector<float> values;
            for (const std::vector<double>& row : track.values) {
                for (const double value : row) {
                    values.push_back(snapped(value));
                }
            }
            constexpr int float32 = 5126;
            const auto input = accessor(buffer_view(times, 0), float32, times.size(), "SCALAR");
            json_["accessors"][input]["min"] = std::vector<float>{times.front()};
            json_["accessors"][input]["max"] = std::vector<float>{times.back()};
            const bool weights = track.path == Path::weights;
            const auto output =
                accessor(buffer_view(values, 0), float32, weights ? values.size() : track.values.size(),
                         weights ? "SCALAR" : track.path == Path::rotation ? "VEC4" : "VEC3");
            const ordered_json target = {{"node", track.object}, {"path", paths[static_cast<int>(track.path)]}};
            channels.push_back(ordered_json{{"sampler", samplers.size()}, {"target", target}});
            samplers.push_back(
                {{"input", input}, {"output", output}, {"interpolation", ways[static_cast<int>(track.interpolation)]}});
        }
        json_["animations"].push_back(
            ordered_json{{"name", "motion"}, {"channels", channels}, {"samplers", samplers}});
    }

    // glTF 2.0, section 4: magic, version, length; each chunk: length, type, data padded to four bytes.
    std::vector<std::uint8_t> assemble() {
        std::string text = json_.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        bin_.resize((bin_.size() + 3) / 4 * 4, 0);
        std::vector<std::uint8_t> out;
        const auto put = [&out](std::size_t value) {
            for (int shift = 0; shift < 32; shift += 8) {
                out.push_back(static_cast<std::uint8_t>(value >> shift));
            }
        };
        put(0x46546C67);  // "glTF"
        put(2);
        put(12 + 8 + text.size() + 8 + bin_.size());
        put(text.size());
        put(0x4E4F534A);  // "JSON"
        out.insert(out.end(), text.begin(), text.end());
        put(bin_.size());
        put(0x004E4942);  // "BIN"
        out.insert(out.end(), bin_.begin(), bin_.end());
        return out;
    }

    const Asset& asset_;
    ordered_json json_;
    std::vector<std::uint8_t> bin_;
    std::set<std::string> extensions_;
};

}  // namespace

Material lambert(std::string name, glm::dvec3 rho, glm::dvec3 emission) {
    Material material;
    material.name = std::move(name);
    material.base_color = rho;
    material.specular = 0.0;
    material.emission = emission;
    return material;
}

int Asset::add(std::string object_name, Mesh mesh, Material material) {
    meshes.push_back(std::move(mesh));
    materials.push_back(std::move(material));
    const int mesh_index = int(meshes.size()) - 1, material_index = int(materials.size()) - 1;
    Object object;
    object.name = std::move(object_name);
    object.mesh = mesh_index;
    object.material = material_index;
    objects.push_back(std::move(object));
    return int(objects.size()) - 1;
}

int Asset::add_joint(std::string object_name, int parent, glm::dvec3 translation) {
    Object object;
    object.name = std::move(object_name);
    object.mesh = -1;
    object.translation = translation;
    object.parent = parent;
    objects.push_back(std::move(object));
    return int(objects.size()) - 1;
}

void write_glb(const Asset& asset, const std::filesystem::path& file) {
    const std::vector<std::uint8_t> bytes = Writer(asset).write();
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
        throw std::runtime_error(file.string() + ": cannot write");
    }
}

}  // namespace conebook::generator
