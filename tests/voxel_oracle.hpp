// Exact answers for voxelization, in double precision on the CPU. Header only.
// Triangles are in grid space: voxel (i, j, k) is the box [i, i+1] x [j, j+1] x [k, k+1].
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "common/voxel_structs.glsl"
#include "scene/scene.hpp"

namespace conebook::oracle {

using Triangle = std::array<glm::dvec3, 3>;

inline glm::dvec3 normal_of(const Triangle& t) { return glm::cross(t[1] - t[0], t[2] - t[0]); }
inline double area_of(const Triangle& t) { return 0.5 * glm::length(normal_of(t)); }

// The scene's triangles in grid space. Float positions, origin and voxel size are exact; what follows is double. Those
// without area are left out, as voxelization leaves them out.
inline std::vector<Triangle> triangles_of(const Scene& scene, const shared::GridData& grid)
{
    const glm::dvec3 origin = glm::dvec3(glm::vec3(grid.origin));
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < scene.triangle_count(); ++i) {
        Triangle t;
        for (std::size_t c = 0; c < 3; ++c) t[c] = glm::dvec3(scene.vertices[scene.indices[3 * i + c]].position);
        if (area_of(t) == 0.0) continue;
        for (glm::dvec3& p : t) p = (p - origin) / double(grid.origin.w);
        triangles.push_back(t);
    }
    return triangles;
}

// Separating axes: 3 of the box, 1 of the plane, 9 of edges. Closed: touching overlaps. The box is grown by `growth`
// on each side.
inline bool overlaps(const Triangle& triangle, glm::ivec3 voxel, double growth)
{
    const glm::dvec3 center = glm::dvec3(voxel) + 0.5;
    const Triangle t = {triangle[0] - center, triangle[1] - center, triangle[2] - center};
    const double half = 0.5 + growth;
    const auto separates = [&](const glm::dvec3& axis) {
        const double a = glm::dot(axis, t[0]), b = glm::dot(axis, t[1]), c = glm::dot(axis, t[2]);
        const double reach = half * (std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z));
        return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
    };
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 axis(0.0);
        axis[i] = 1.0;
        if (separates(axis)) return false;
    }
    if (separates(normal_of(triangle))) return false;
    for (std::size_t e = 0; e < 3; ++e)
        for (int i = 0; i < 3; ++i) {
            glm::dvec3 axis(0.0);
            axis[i] = 1.0;
            if (separates(glm::cross(axis, t[(e + 1) % 3] - t[e]))) return false;
        }
    return true;
}

// Calls visit(voxel) for every voxel of the grid that the triangle overlaps. Columns along the normal's largest
// component, and in each the range of depth that the plane can have there.
inline void for_each_voxel(const Triangle& t, glm::ivec3 size, double growth,
                           const std::function<void(glm::ivec3)>& visit)
{
    const glm::dvec3 n = normal_of(t), low = glm::min(t[0], glm::min(t[1], t[2])), high = glm::max(t[0], glm::max(t[1], t[2]));
    int z = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(n[i]) > std::abs(n[z])) z = i;
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    const double margin = growth + 1e-9;
    const auto first = [&](int axis) { return std::max(0, int(std::max(-1.0, std::floor(low[axis] - margin) - 1.0))); };
    const auto last = [&](int axis) {
        return std::min(size[axis] - 1, int(std::min(double(size[axis]), std::floor(high[axis] + margin))));
    };
    const double sx = n[z] != 0.0 ? n[x] / n[z] : 0.0, sy = n[z] != 0.0 ? n[y] / n[z] : 0.0;
    const double reach = (0.5 + margin) * (std::abs(sx) + std::abs(sy)) + margin + 1e-6;
    glm::ivec3 v;
    for (v[x] = first(x); v[x] <= last(x); ++v[x])
        for (v[y] = first(y); v[y] <= last(y); ++v[y]) {
            double near = low[z], far = high[z];
            if (n[z] != 0.0) {
                const double middle = t[0][z] - sx * (v[x] + 0.5 - t[0][x]) - sy * (v[y] + 0.5 - t[0][y]);
                near = std::max(near, middle - reach);
                far = std::min(far, middle + reach);
            }
            const int end = int(std::min(double(size[z] - 1), std::floor(far + margin)));
            for (v[z] = int(std::max(0.0, std::floor(near - margin) - 1.0)); v[z] <= end; ++v[z])
                if (overlaps(t, v, growth)) visit(v);
        }
}

// One flag a voxel, x fastest.
inline std::vector<char> overlapped(const std::vector<Triangle>& triangles, glm::ivec3 size, double growth)
{
    std::vector<char> flags(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z), 0);
    for (const Triangle& t : triangles)
        for_each_voxel(t, size, growth, [&](glm::ivec3 v) {
            flags[std::size_t(v.x) + std::size_t(size.x) * (std::size_t(v.y) + std::size_t(size.y) * std::size_t(v.z))] = 1;
        });
    return flags;
}

// The part of a triangle inside a voxel (Sutherland & Hodgman 1974): area and centre of area.
struct Part {
    double area = 0.0;
    glm::dvec3 center{0.0};  // grid space
};
inline Part part_in_voxel(const Triangle& t, glm::ivec3 voxel)
{
    std::vector<glm::dvec3> polygon(t.begin(), t.end());
    for (int plane = 0; plane < 6 && !polygon.empty(); ++plane) {
        const int axis = plane / 2;
        const auto inside = [&](const glm::dvec3& p) {
            return plane % 2 == 0 ? p[axis] - double(voxel[axis]) : double(voxel[axis] + 1) - p[axis];
        };
        std::vector<glm::dvec3> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const glm::dvec3 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
            const double dp = inside(p), dq = inside(q);
            if (dp >= 0.0) kept.push_back(p);
            if ((dp >= 0.0) != (dq >= 0.0)) kept.push_back(p + dp / (dp - dq) * (q - p));
        }
        polygon = kept;
    }
    Part part;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const double area = area_of({polygon[0], polygon[i], polygon[i + 1]});
        part.area += area;
        part.center += area * (polygon[0] + polygon[i] + polygon[i + 1]) / 3.0;
    }
    if (part.area > 0.0) part.center /= part.area;
    return part;
}

// 0 -x, 1 +x, 2 -y, ...: the direction that the normal is nearest to.
inline int face_of(const glm::dvec3& n)
{
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(n[i]) > std::abs(n[axis])) axis = i;
    return 2 * axis + (n[axis] > 0.0 ? 1 : 0);
}

// Weights that sum to 1, of a point in the triangle's plane.
inline glm::dvec3 barycentric(const Triangle& t, const glm::dvec3& p)
{
    const glm::dvec3 n = normal_of(t);
    const double b1 = glm::dot(glm::cross(p - t[0], t[2] - t[0]), n) / glm::dot(n, n);
    const double b2 = glm::dot(glm::cross(t[1] - t[0], p - t[0]), n) / glm::dot(n, n);
    return {1.0 - b1 - b2, b1, b2};
}

}  // namespace conebook::oracle
