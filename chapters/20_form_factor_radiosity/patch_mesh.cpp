#include "20_form_factor_radiosity/patch_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

namespace conebook {
namespace {

std::uint64_t edge_name(std::uint32_t a, std::uint32_t b)
{
    return (std::uint64_t(std::min(a, b)) << 32) | std::max(a, b);
}

}  // namespace

BisectedMesh::BisectedMesh(const Scene& scene)
{
    // Walls of several draws share their corners: equal positions are one point, whatever their normals.
    std::map<std::array<float, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> point_of(scene.vertices.size());
    for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
        const glm::vec3 p = scene.vertices[i].position + 0.0f;  // -0 is 0
        const auto [entry, is_new] = known.try_emplace({p.x, p.y, p.z}, std::uint32_t(points_.size()));
        if (is_new) points_.push_back(p);
        point_of[i] = entry->second;
    }
    nodes_.resize(scene.triangle_count());
    for (std::uint32_t t = 0; t < nodes_.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) nodes_[t].corners[k] = point_of[scene.indices[3 * std::size_t(t) + k]];
        nodes_[t].uv = {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)};
        nodes_[t].triangle = t;
        enter(t);
    }
    leaf_count_ = nodes_.size();
}

BisectedMesh::Edge BisectedMesh::edge(std::uint32_t node, int k) const
{
    const auto& corners = nodes_[node].corners;
    const std::uint32_t a = corners[std::size_t(k + 1) % 3], b = corners[std::size_t(k + 2) % 3];
    const glm::dvec3 way = glm::dvec3(points_[std::max(a, b)]) - glm::dvec3(points_[std::min(a, b)]);
    return {glm::dot(way, way), edge_name(a, b)};
}

int BisectedMesh::longest(std::uint32_t node) const
{
    int best = 0;
    for (int k = 1; k < 3; ++k)
        if (edge(node, k) > edge(node, best)) best = k;
    return best;
}

double BisectedMesh::longest_edge(std::uint32_t node) const { return std::sqrt(edge(node, longest(node)).length2); }

double BisectedMesh::area(std::uint32_t node) const
{
    const auto& c = nodes_[node].corners;
    const glm::dvec3 a(points_[c[0]]), b(points_[c[1]]), d(points_[c[2]]);
    return 0.5 * glm::length(glm::cross(b - a, d - a));
}

const std::vector<std::uint32_t>& BisectedMesh::at_edge(std::uint32_t node, int k) const
{
    return leaves_at_edge_.at(edge(node, k).name);
}

std::vector<std::uint32_t> BisectedMesh::leaves() const
{
    std::vector<std::uint32_t> found;
    for (std::uint32_t n = 0; n < nodes_.size(); ++n)
        if (nodes_[n].child < 0) found.push_back(n);
    return found;
}

void BisectedMesh::enter(std::uint32_t node)
{
    for (int k = 0; k < 3; ++k) leaves_at_edge_[edge(node, k).name].push_back(node);
}

void BisectedMesh::leave(std::uint32_t node)
{
    for (int k = 0; k < 3; ++k) std::erase(leaves_at_edge_[edge(node, k).name], node);
}

// snippet: bisect
bool BisectedMesh::bisect(std::uint32_t node, std::vector<std::uint32_t>& made)
{
    // First every neighbour at this edge that has a longer one. Edges grow on the way, so it ends.
    const Edge longest_edge = edge(node, longest(node));
    for (bool ready = false; !ready;) {
        ready = true;
        for (const std::uint32_t other : leaves_at_edge_.at(longest_edge.name))
            if (edge(other, longest(other)) != longest_edge) {
                if (!bisect(other, made)) return false;
                ready = false;  // the list has changed
                break;
            }
    }
    // Then all at once, at one point.
    // end snippet
    const std::uint32_t a = std::uint32_t(longest_edge.name >> 32), b = std::uint32_t(longest_edge.name);
    const glm::vec3 middle = glm::vec3(0.5 * (glm::dvec3(points_[a]) + glm::dvec3(points_[b])));
    if (middle == points_[a] || middle == points_[b]) return false;  // as short as floats are
    const auto [entry, is_new] = middles_.try_emplace(longest_edge.name, std::uint32_t(points_.size()));
    if (is_new) points_.push_back(middle);
    const std::uint32_t m = entry->second;
    const std::vector<std::uint32_t> sharing = leaves_at_edge_.at(longest_edge.name);
    for (const std::uint32_t leaf : sharing) {
        const auto apex = std::size_t(longest(leaf)), next = (apex + 1) % 3, last = (apex + 2) % 3;
        leave(leaf);
        PatchNode first = nodes_[leaf], second = nodes_[leaf];
        const glm::vec2 uv = 0.5f * (first.uv[next] + first.uv[last]);
        first.corners = {first.corners[apex], first.corners[next], m};
        second.corners = {second.corners[apex], m, second.corners[last]};
        first.uv = {first.uv[apex], first.uv[next], uv};
        second.uv = {second.uv[apex], uv, second.uv[last]};
        first.parent = second.parent = std::int32_t(leaf);
        const auto child = std::uint32_t(nodes_.size());
        nodes_[leaf].child = std::int32_t(child);
        nodes_[leaf].apex = std::uint8_t(apex);
        nodes_.push_back(first);
        nodes_.push_back(second);
        for (const std::uint32_t c : {child, child + 1}) {
            enter(c);
            made.push_back(c);
        }
        ++leaf_count_;
    }
    return true;
}

void BisectedMesh::refine(std::size_t leaves, double enough, const std::function<double(std::uint32_t)>& key)
{
    using Entry = std::pair<double, std::uint32_t>;
    const auto later = [](const Entry& a, const Entry& b) {
        return std::pair(a.first, ~a.second) < std::pair(b.first, ~b.second);
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(later)> queue(later);
    for (const std::uint32_t leaf : this->leaves()) queue.push({key(leaf), leaf});
    std::vector<std::uint32_t> made;
    while (leaf_count_ < leaves && !queue.empty() && queue.top().first > enough) {
        const std::uint32_t leaf = queue.top().second;
        queue.pop();
        if (nodes_[leaf].child >= 0) continue;  // bisected on behalf of a neighbour
        made.clear();
        bisect(leaf, made);
        for (const std::uint32_t c : made)
            if (nodes_[c].child < 0) queue.push({key(c), c});
    }
}

// snippet: find
PatchPlace BisectedMesh::find(std::uint32_t triangle, glm::vec2 uv) const
{
    PatchPlace place{triangle, {1.0f - uv.x - uv.y, uv.x, uv.y}};
    while (nodes_[place.node].child >= 0) {
        const PatchNode& node = nodes_[place.node];
        const int apex = node.apex;
        const float p = place.weights[apex], a = place.weights[(apex + 1) % 3], b = place.weights[(apex + 2) % 3];
        // The middle m of the edge a b takes the place of the corner that is further away: a A + b B = (a - b) A +
        // 2 b M.
        place.node = std::uint32_t(node.child) + (a >= b ? 0 : 1);
        place.weights = a >= b ? glm::vec3(p, a - b, 2.0f * b) : glm::vec3(p, 2.0f * a, b - a);
    }
    return place;
}
// end snippet

}  // namespace conebook
