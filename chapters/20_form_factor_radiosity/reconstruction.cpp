#include "20_form_factor_radiosity/reconstruction.hpp"

#include <algorithm>
#include <cmath>

namespace conebook {
namespace {

bool has_corner(const PatchNode& node, std::uint32_t point)
{
    return std::find(node.corners.begin(), node.corners.end(), point) != node.corners.end();
}

// The value at `point` of the linear function that fits values at the patches' centres best.
glm::dvec3 fitted(const Patches& patches, const std::vector<std::uint32_t>& ring, const glm::dvec3& point,
                  const glm::dvec3& normal, const Irradiance& values)
{
    const Frame frame{glm::vec3(normal)};
    const glm::dvec3 t(frame.t), b(frame.b);
    double size2 = 0.0, area = 0.0;
    for (const std::uint32_t p : ring) {
        const glm::dvec3 way = glm::dvec3(patches[p].center) - point;
        size2 += double(patches[p].area) * glm::dot(way, way);
        area += double(patches[p].area);
    }
    if (!(area > 0.0)) return glm::dvec3(0.0);
    size2 = std::max(size2 / area, 1e-30);
    // Normal equations of (1, x, y), lengths in the ring's own size. Slopes that nothing determines stay small.
    constexpr double kLeastSlopeWeight = 0.004;
    glm::dmat3 matrix(0.0), right(0.0);  // right: a column a channel
    glm::dvec3 low(1e300), high(-1e300);
    double total = 0.0;
    for (const std::uint32_t p : ring) {
        if (!(patches[p].area > 0.0f)) continue;
        const glm::dvec3 way = (glm::dvec3(patches[p].center) - point) / std::sqrt(size2);
        const glm::dvec3 basis(1.0, glm::dot(way, t), glm::dot(way, b)), value(values[p]);
        const double weight = double(patches[p].area) / area / (0.25 + glm::dot(way, way));
        matrix += weight * glm::outerProduct(basis, basis);
        for (int c = 0; c < 3; ++c) right[c] += weight * value[c] * basis;
        low = glm::min(low, value);
        high = glm::max(high, value);
        total += weight;
    }
    matrix[1][1] += kLeastSlopeWeight * total;
    matrix[2][2] += kLeastSlopeWeight * total;
    const glm::dmat3 inverse = glm::inverse(matrix);
    glm::dvec3 result;
    for (int c = 0; c < 3; ++c) result[c] = (inverse * right[c])[0];
    // No further beyond the patches' values than they differ.
    const glm::dvec3 range = high - low;
    return glm::max(glm::clamp(result, low - range, high + range), glm::dvec3(0.0));
}

}  // namespace

void add_parameters(ParameterTable& table, ReconstructionParams& params)
{
    table.add("smooth", params.smooth, "irradiance is fitted at corners and interpolated; off: one value a patch");
    table.add("smooth_angle", params.smooth_angle, 0.0, 180.0, "deg", "between normals over which light is continuous");
}

Surfaces::Surfaces(const Patches& patches, const ReconstructionParams& params)
    : patches_(&patches), params_(params), neighbours_(patches.size())
{
    const BisectedMesh& mesh = patches.mesh();
    const float least_cosine = std::cos(glm::radians(params.smooth_angle)) - 1e-6f;
    for_all(patches.size(), [&](std::size_t index) {
        const Patch& patch = patches[index];
        for (int k = 0; k < 3; ++k) {
            std::uint32_t best = kNoPatch;
            bool is_foot = false;
            for (const std::uint32_t leaf : mesh.at_edge(patch.node, k)) {
                if (leaf == patch.node) continue;
                std::uint32_t other = kNoPatch;
                for (const bool front : {true, false}) {
                    const std::uint32_t side = patches.on(leaf, front);
                    if (side != kNoPatch && glm::dot(patches[side].normal, patch.normal) >= least_cosine) other = side;
                }
                if (other != kNoPatch) {
                    best = other;
                    continue;
                }
                // Something else at this edge: does it rise on this side?
                const PatchNode& node = mesh.nodes()[leaf];
                float highest = 0.0f, size = 0.0f;
                for (const std::uint32_t corner : node.corners) {
                    const glm::vec3 way = mesh.points()[corner] - patch.center;
                    highest = std::max(highest, glm::dot(way, patch.normal));
                    size = std::max(size, glm::length(way));
                }
                is_foot = is_foot || highest > 0.05f * size;
            }
            if (best != kNoPatch && !is_foot) neighbours_[index].push_back(best);
        }
    });
}

CornerValues Surfaces::corners(const Irradiance& values, const Irradiance& from_lamps, const Lamps& lamps) const
{
    const Patches& patches = *patches_;
    const BisectedMesh& mesh = patches.mesh();
    CornerValues result(patches.size());
    std::vector<std::array<std::uint32_t, 3>> owners(patches.size());  // the patch that finds the value for its ring
    Irradiance rest(values);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= from_lamps[i];
    for_all(patches.size(), [&](std::size_t index) {
        const Patch& patch = patches[index];
        result[index].fill(values[index]);
        owners[index].fill(std::uint32_t(index));
        if (!params_.smooth || patch.exposed == 0) return;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = mesh.nodes()[patch.node].corners[k];
            // snippet: ring
            // Round the corner, from neighbour to neighbour, as far as the surface goes on; then one step further.
            std::vector<std::uint32_t> ring{std::uint32_t(index)};
            const auto grow = [&](std::size_t count, auto wanted) {
                for (std::size_t i = 0; i < std::min(count, ring.size()); ++i)
                    for (const std::uint32_t n : neighbours_[ring[i]])
                        if (wanted(n) && std::find(ring.begin(), ring.end(), n) == ring.end()) ring.push_back(n);
            };
            grow(~std::size_t(0), [&](std::uint32_t n) { return has_corner(mesh.nodes()[patches[n].node], corner); });
            const auto exposed_first = [&](std::uint32_t a, std::uint32_t b) {
                return std::pair(patches[a].exposed == 0, a) < std::pair(patches[b].exposed == 0, b);
            };
            owners[index][k] = *std::min_element(ring.begin(), ring.end(), exposed_first);
            grow(ring.size(), [](std::uint32_t) { return true; });
            // end snippet
            if (owners[index][k] != index) continue;
            glm::dvec3 normal(0.0);
            for (const std::uint32_t p : ring) normal += double(patches[p].area) * glm::dvec3(patches[p].normal);
            if (!(glm::length(normal) > 0.0)) continue;
            normal = glm::normalize(normal);
            const glm::vec3 point = mesh.points()[corner];
            glm::dvec3 value = fitted(patches, ring, glm::dvec3(point), normal, lamps.empty() ? values : rest);
            if (!lamps.empty()) {
                // A hundredth of the way into the patch: at the corner itself other walls begin.
                const glm::vec3 inside = glm::mix(point, patch.center, 0.01f);
                value += is_buried(patches.tracer(), inside, patch.normal, corner)
                             ? fitted(patches, ring, glm::dvec3(point), normal, from_lamps)
                             : glm::dvec3(lamps.irradiance(patches, inside, glm::vec3(normal), corner));
            }
            result[index][k] = glm::vec3(value);
        }
    });
    for (std::size_t i = 0; i < patches.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t owner = owners[i][k];
            if (owner == i) continue;
            const auto& own = mesh.nodes()[patches[i].node].corners;
            const auto& theirs = mesh.nodes()[patches[owner].node].corners;
            result[i][k] = result[owner][std::size_t(std::find(theirs.begin(), theirs.end(), own[k]) - theirs.begin())];
        }
    return result;
}

}  // namespace conebook
