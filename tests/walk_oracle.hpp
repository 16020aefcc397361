// The walk volume read back, and what it must hold, in double precision. Header only.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "08_diffuse_cones/walk_volume.hpp"

namespace conebook {

// Cell c covers [c - 1/2, c + 1/2) of grid space along each axis.
class WalkCells {
public:
    WalkCells() = default;
    explicit WalkCells(const WalkVolume& walk) : size_(walk.volume().size()), words_(gl::read_uints(walk.volume())) {}

    const glm::ivec3& size() const { return size_; }
    GLuint word(const glm::ivec3& c) const
    {
        return words_[(std::size_t(c.z) * std::size_t(size_.y) + std::size_t(c.y)) * std::size_t(size_.x) +
                      std::size_t(c.x)];
    }
    bool holds(const glm::ivec3& c) const
    {
        return glm::all(glm::greaterThanEqual(c, glm::ivec3(0))) && glm::all(glm::lessThan(c, size_));
    }
    bool occupied(const glm::ivec3& c) const { return holds(c) && word(c) >> 31 != 0u; }
    // log2 of the side of the cube that is empty towards the octant (bit a: up along axis a).
    int leap(const glm::ivec3& c, int octant) const { return int(word(c) >> (3 * octant) & 7u); }
    // Units of coverage, of 30, of what looks to the side: 0 -x, 1 +x, ...
    int units(const glm::ivec3& c, int side) const { return int(word(c) >> (5 * side) & 31u); }

    static glm::ivec3 cell_at(const glm::dvec3& position) { return glm::ivec3(glm::floor(position + 0.5)); }

    // Distance to where a ray leaves the scene's bounds, voxels.
    static double exit_distance(const shared::GridData& grid, const glm::dvec3& origin, const glm::dvec3& direction)
    {
        double exit = INFINITY;
        for (int a = 0; a < 3; ++a) {
            if (std::abs(direction[a]) < 1e-6) continue;
            const double side = double(direction[a] > 0.0 ? grid.content_max[a] : grid.content_min[a]);
            exit = std::min(exit, (side - origin[a]) / direction[a]);
        }
        return exit;
    }

    // Texels that a ray looks at until `end`, where nothing stops it.
    int texels(const glm::dvec3& origin, const glm::dvec3& direction, double end) const
    {
        int count = 0, octant = 0;
        for (int a = 0; a < 3; ++a) octant |= direction[a] >= 0.0 ? 1 << a : 0;
        for (double t = 0.0; t < end; ++count) {
            // A little into the cell that it enters.
            const glm::ivec3 c = cell_at(origin + (t + 1e-6) * direction);
            const double side = occupied(c) ? 1.0 : std::ldexp(1.0, leap(c, octant));
            double next = INFINITY;
            for (int a = 0; a < 3; ++a) {
                if (std::abs(direction[a]) < 1e-6) continue;
                const double low = double(c[a]) - 0.5;
                const double far_side = direction[a] >= 0.0 ? low + side : low + 1.0 - side;
                next = std::min(next, (far_side - origin[a]) / direction[a]);
            }
            t = next;
        }
        return count;
    }

private:
    glm::ivec3 size_{0};
    std::vector<GLuint> words_;
};

}  // namespace conebook
