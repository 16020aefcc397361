// Makes a draw of a scene made in code move. Header only.
#pragma once

#include <algorithm>

#include "scene/scene.hpp"

namespace conebook {

// A node of its own for draw `index`, at the origin as it stands, with an animation through these places (m) one second apart.
inline void make_move(Scene& scene, std::size_t index, const std::vector<glm::vec3>& translations)
{
    Draw& draw = scene.draws[index];
    const auto first = scene.indices.begin() + draw.first_index;
    const auto [low, high] = std::minmax_element(first, first + draw.index_count);
    draw.vertices = {*low, *high - *low + 1};
    Node node;
    node.vertices = draw.vertices;
    node.indices = {draw.first_index, draw.index_count};
    node.draws = {std::uint32_t(index), 1};
    node.modelled = {std::uint32_t(scene.modelled.size()), draw.vertices.count};
    node.dynamic = true;
    for (std::uint32_t v = draw.vertices.first; v < draw.vertices.end(); ++v) {
        const Vertex& vertex = scene.vertices[v];
        scene.modelled.push_back({vertex.position, vertex.normal, vertex.tangent});
    }
    AnimationSampler sampler;
    for (const glm::vec3& t : translations) {
        sampler.times.push_back(float(sampler.times.size()));
        for (int i = 0; i < 3; ++i) sampler.values.push_back(t[i]);
    }
    if (scene.animations.empty()) scene.animations.emplace_back();
    Animation& animation = scene.animations[0];
    animation.channels.push_back({int(scene.nodes.size()), AnimationPath::translation, int(animation.samplers.size())});
    animation.samplers.push_back(std::move(sampler));
    scene.nodes.push_back(std::move(node));
}

}  // namespace conebook
