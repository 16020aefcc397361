// Animations and skins: read and checked. pose.cpp plays them.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "scene/parts.hpp"

namespace conebook::gltf {
namespace {

std::vector<float> read_floats(const AccessorReader& reader)
{
    const auto components = static_cast<std::size_t>(reader.components());
    std::vector<float> values(reader.count() * components);
    for (std::size_t i = 0; i < reader.count(); ++i) reader.element(i, &values[i * components]);
    if (!std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); })) {
        fail("holds values that are not finite");
    }
    return values;
}

AnimationSampler read_sampler(const Document& document, const tinygltf::AnimationSampler& source,
                              std::uint64_t& values_so_far)
{
    AnimationSampler sampler;
    if (source.interpolation == "STEP") {
        sampler.interpolation = Interpolation::step;
    } else if (source.interpolation == "CUBICSPLINE") {
        sampler.interpolation = Interpolation::cubic_spline;
    } else if (source.interpolation != "LINEAR") {
        fail("has the unknown interpolation '" + source.interpolation + "'");
    }
    const AccessorReader times(document, source.input, "input"), values(document, source.output, "output");
    values_so_far += times.count() + values.count() * static_cast<std::uint64_t>(values.components());
    if (values_so_far > max_animation_values) fail("has more than 67 million values with those before it");
    if (times.count() == 0 || times.components() != 1 || !times.is_float()) {
        fail("has times that are not float scalars, one at least");
    }
    sampler.times = read_floats(times);
    if (sampler.times[0] < 0.0f || !std::is_sorted(sampler.times.begin(), sampler.times.end())) {
        fail("has times that are negative or do not ascend");
    }
    sampler.values = read_floats(values);
    const std::size_t keys = sampler.times.size() * (sampler.interpolation == Interpolation::cubic_spline ? 3 : 1);
    if (sampler.values.empty() || sampler.values.size() % keys != 0) {
        fail("has " + std::to_string(sampler.values.size()) + " values for " + std::to_string(keys) + " keys");
    }
    return sampler;
}

AnimationPath read_path(const std::string& path)
{
    if (path == "translation") return AnimationPath::translation;
    if (path == "rotation") return AnimationPath::rotation;
    if (path == "scale") return AnimationPath::scale;
    if (path == "weights") return AnimationPath::weights;
    fail("moves '" + path + "', which is not known");
}

// How many floats a key of this channel must have.
std::size_t width_of(AnimationPath path, const Node& node)
{
    if (path == AnimationPath::weights) return node.weights.size();
    return path == AnimationPath::rotation ? 4 : 3;
}

std::string quoted(const std::string& name) { return name.empty() ? "" : " '" + name + "'"; }

// Node in Scene::nodes by its index in the file, -1: not in the scene.
std::vector<int> nodes_by_file_index(const Document& document, const std::vector<Node>& nodes)
{
    std::vector<int> result(document.model.nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        result[static_cast<std::size_t>(nodes[i].file_index)] = static_cast<int>(i);
    }
    return result;
}

bool says_dynamic(const std::string& extras)
{
    const auto json = nlohmann::json::parse(extras, nullptr, false);
    const auto found = json.is_object() ? json.find("dynamic") : json.end();
    return json.is_object() && found != json.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace

std::vector<Animation> read_animations(const Document& document, const std::vector<Node>& nodes, Warnings& warnings)
{
    const std::vector<int> by_file_index = nodes_by_file_index(document, nodes);
    std::vector<Animation> animations;
    std::uint64_t values = 0;
    for (std::size_t i = 0; i < document.model.animations.size(); ++i) {
        const tinygltf::Animation& source = document.model.animations[i];
        const std::string where = "animations[" + std::to_string(i) + "]" + quoted(source.name);
        Animation animation;
        animation.name = source.name;
        std::string part;
        try {
            for (std::size_t s = 0; s < source.samplers.size(); ++s) {
                part = ".samplers[" + std::to_string(s) + "] ";
                animation.samplers.push_back(read_sampler(document, source.samplers[s], values));
            }
            for (std::size_t c = 0; c < source.channels.size(); ++c) {
                part = ".channels[" + std::to_string(c) + "] ";
                const tinygltf::AnimationChannel& from = source.channels[c];
                if (from.target_node < 0) {
                    warn(warnings, where + part + "moves no node and is left out");
                    continue;
                }
                AnimationChannel channel;
                channel.node = by_file_index[static_cast<std::size_t>(from.target_node)];
                if (channel.node < 0) continue;  // of another scene of the file
                channel.path = read_path(from.target_path);
                channel.sampler = from.sampler;
                const Node& node = nodes[static_cast<std::size_t>(channel.node)];
                const std::size_t width = animation.samplers[static_cast<std::size_t>(from.sampler)].width();
                if (width != width_of(channel.path, node)) {
                    fail("has " + std::to_string(width) + " floats a key for the " + from.target_path + " of nodes[" +
                         std::to_string(from.target_node) + "]");
                }
                if (node.matrix && channel.path != AnimationPath::weights) {
                    fail("moves nodes[" + std::to_string(from.target_node) + "], which has a matrix");
                }
                animation.channels.push_back(channel);
            }
        } catch (const std::runtime_error& e) {
            warn(warnings, where + " is left out: " + part.substr(1) + e.what());
            continue;
        }
        if (!animation.channels.empty()) animations.push_back(std::move(animation));
    }
    return animations;
}

std::vector<Skin> read_skins(const Document& document, std::vector<Node>& nodes, Warnings& warnings)
{
    const std::vector<int> by_file_index = nodes_by_file_index(document, nodes);
    std::vector<int> kept(document.model.skins.size(), -1);
    std::vector<Skin> skins;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const tinygltf::Skin& source = document.model.skins[i];
        try {
            Skin skin;
            skin.name = source.name;
            if (source.skeleton >= 0) skin.skeleton = by_file_index[static_cast<std::size_t>(source.skeleton)];
            for (const int joint : source.joints) {
                skin.joints.push_back(by_file_index[static_cast<std::size_t>(joint)]);
                if (skin.joints.back() < 0) fail("its joint nodes[" + std::to_string(joint) + "] is not in the scene");
            }
            if (skin.joints.empty()) fail("it has no joints");
            skin.inverse_bind.assign(skin.joints.size(), glm::mat4(1.0f));
            if (source.inverseBindMatrices >= 0) {
                const AccessorReader matrices(document, source.inverseBindMatrices, "inverseBindMatrices");
                if (matrices.components() != 16 || !matrices.is_float() || matrices.count() < skin.joints.size()) {
                    fail("its inverseBindMatrices are not a float matrix a joint");
                }
                for (std::size_t j = 0; j < skin.joints.size(); ++j) {
                    float* matrix = &skin.inverse_bind[j][0][0];  // column by column, as the file has them
                    matrices.element(j, matrix);
                    if (!std::all_of(matrix, matrix + 16, [](float value) { return std::isfinite(value); })) {
                        fail("its inverseBindMatrices are not finite");
                    }
                }
            }
            kept[i] = static_cast<int>(skins.size());
            skins.push_back(std::move(skin));
        } catch (const std::runtime_error& e) {
            warn(warnings, "skins[" + std::to_string(i) + "]" + quoted(source.name) + " is left out: " + e.what());
        }
    }
    for (Node& node : nodes) {
        const int skin = document.model.nodes[static_cast<std::size_t>(node.file_index)].skin;
        if (skin >= 0) node.skin = kept[static_cast<std::size_t>(skin)];
    }
    return skins;
}

void mark_dynamic(Scene& scene)
{
    std::vector<std::uint8_t> moves(scene.nodes.size(), 0), morphs(scene.nodes.size(), 0);
    for (const Animation& animation : scene.animations) {
        for (const AnimationChannel& channel : animation.channels) {
            const bool weights = channel.path == AnimationPath::weights;
            (weights ? morphs : moves)[static_cast<std::size_t>(channel.node)] = 1;
        }
    }
    for (std::size_t i = 0; i < moves.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (says_dynamic(node.extras) || (node.parent >= 0 && moves[static_cast<std::size_t>(node.parent)])) moves[i] = 1;
    }
    for (std::size_t i = 0; i < moves.size(); ++i) {
        Node& node = scene.nodes[i];
        node.dynamic = moves[i] || morphs[i];
        if (node.skin < 0) continue;
        for (const int joint : scene.skins[static_cast<std::size_t>(node.skin)].joints) {
            node.dynamic = node.dynamic || moves[static_cast<std::size_t>(joint)];
        }
    }
}

}  // namespace conebook::gltf
