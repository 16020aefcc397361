#include "03_shadow_map/shadowed_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace conebook {

namespace {

// Convex, counter-clockwise.
template <typename Point>
using Polygon = std::vector<Point>;

// Sutherland & Hodgman 1974: what is left of a polygon where `distance`, linear in the point, is not negative.
template <typename Point, typename Distance>
void clip(Polygon<Point>& polygon, Polygon<Point>& scratch, const Distance& distance)
{
    scratch.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = distance(a), db = distance(b);
        if (da >= 0.0) scratch.push_back(a);
        if ((da < 0.0) != (db < 0.0)) scratch.push_back(a + da / (da - db) * (b - a));
    }
    std::swap(polygon, scratch);
}

// Newell's sum: the z is twice the area in the picture, the whole is normal to the polygon.
glm::dvec3 normal_of(const glm::dvec3* points, std::size_t count)
{
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < count; ++i)
        sum += glm::cross(points[i] - points[0], points[(i + 1) % count] - points[0]);
    return sum;
}

// A hair of the picture; neighbours that share an edge overlap by their rounding, far below it.
constexpr double kLeastArea = 1e-14;

// What the light sees of a triangle.
struct Facet {
    std::size_t first, count;  // of Search::points
    std::uint32_t triangle;
    bool receives;  // light on a side that reflects it
    glm::dvec2 low, high;
    glm::dvec3 plane;  // depth = plane.x x + plane.y y + plane.z
    double depth(const glm::dvec3& p) const { return plane.x * p.x + plane.y * p.y + plane.z; }
};

struct Square {
    glm::dvec2 low;
    double side;
};

bool apart(glm::dvec2 low_a, glm::dvec2 high_a, glm::dvec2 low_b, glm::dvec2 high_b)
{
    return low_a.x >= high_b.x || low_b.x >= high_a.x || low_a.y >= high_b.y || low_b.y >= high_a.y;
}

class Search {
public:
    Search(const glm::dmat4& clip_from_scene, const std::vector<Triangle>& triangles, double diameter_m)
        : triangles_(triangles), scene_from_clip_(glm::inverse(clip_from_scene)), tolerance_m_(2e-7 * diameter_m)
    {
        for (std::uint32_t i = 0; i < triangles.size(); ++i) add(clip_from_scene, i);
    }

    std::optional<NdcBox> run()
    {
        visit_all();
        if (low_.x > high_.x && !is_exhausted()) return {};
        if (is_wide() || is_exhausted()) {
            low_ = glm::dvec2(-1.0);
            high_ = glm::dvec2(1.0);
        }
        const auto [near, far] = depths();
        return NdcBox{glm::dvec3(low_, far), glm::dvec3(high_, near)};
    }

    // Corners of all that the light sees, cut off at the sides of its view.
    const std::vector<glm::dvec3>& points() const { return points_; }

    // Whether shadows fall so far apart that a fitted map would gain nothing. More triangles make them no narrower.
    bool finds_wide_shadows()
    {
        visit_all();
        return is_wide();
    }

private:
    void add(const glm::dmat4& clip_from_scene, std::uint32_t index)
    {
        const Triangle& triangle = triangles_[index];
        corners_.clear();
        for (const glm::vec3& corner : triangle.corners) corners_.push_back(clip_from_scene * glm::dvec4(corner, 1.0));
        for (int axis = 0; axis < 2; ++axis)
            for (const double side : {1.0, -1.0})
                clip(corners_, clipped_, [&](const glm::dvec4& p) { return p.w + side * p[axis]; });
        clip(corners_, clipped_, [](const glm::dvec4& p) { return p.w - p.z; });  // depth 1: the near plane
        Facet facet{points_.size(), corners_.size(), index, false, glm::dvec2(INFINITY), glm::dvec2(-INFINITY), {}};
        for (const glm::dvec4& p : corners_) {
            points_.push_back(glm::dvec3(p) / p.w);
            facet.low = glm::min(facet.low, glm::dvec2(points_.back()));
            facet.high = glm::max(facet.high, glm::dvec2(points_.back()));
        }
        const glm::dvec3 n = facet.count < 3 ? glm::dvec3(0.0) : normal_of(&points_[facet.first], facet.count);
        if (std::abs(n.z) < kLeastArea) {
            points_.resize(facet.first);
            return;
        }
        facet.receives = n.z > 0.0 || triangle.double_sided;
        if (n.z < 0.0) std::reverse(points_.begin() + std::ptrdiff_t(facet.first), points_.end());
        facet.plane = {-n.x / n.z, -n.y / n.z, glm::dot(n, points_[facet.first]) / n.z};
        facets_.push_back(facet);
    }

    // An eighth of the view: what a map of it all shows with 128 of 1024 texels.
    bool is_wide() const { return high_.x - low_.x > 0.25 && high_.y - low_.y > 0.25; }
    bool is_exhausted() const { return work_ > kMostWork; }
    bool is_inside(const Square& s) const
    {
        return s.low.x >= low_.x && s.low.y >= low_.y && s.low.x + s.side <= high_.x && s.low.y + s.side <= high_.y;
    }

    // Whether the facet and a square have a point in common: neither the square's sides nor the facet's keep them
    // apart.
    bool overlaps(const Facet& f, glm::dvec2 low, glm::dvec2 high) const
    {
        if (apart(f.low, f.high, low, high)) return false;
        for (std::size_t i = 0; i < f.count; ++i) {
            const glm::dvec3 &from = points_[f.first + i], &to = points_[f.first + (i + 1) % f.count];
            const glm::dvec2 d(to - from);
            const glm::dvec2 innermost(d.y > 0.0 ? low.x : high.x, d.x > 0.0 ? high.y : low.y);
            if (d.x * (innermost.y - from.y) - d.y * (innermost.x - from.x) < 0.0) return false;
        }
        return true;
    }

    void visit_all()
    {
        std::vector<std::uint32_t> all(facets_.size());
        for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
        visit({glm::dvec2(-1.0), 2.0}, all, 0);
    }

    // Quarter the picture until few facets are left in a square, and compare those with each other.
    void visit(const Square& square, const std::vector<std::uint32_t>& facets, int level)
    {
        constexpr std::size_t kFew = 16;
        constexpr int kMostLevels = 20;
        work_ += facets.size();
        if (facets.size() < 2 || is_wide() || is_exhausted() || is_inside(square) || are_coplanar(facets)) return;
        const double half = 0.5 * square.side;
        std::array<std::vector<std::uint32_t>, 4> parts;
        std::size_t in_parts = 0;
        for (int quarter = 0; quarter < 4 && facets.size() > kFew && level < kMostLevels; ++quarter) {
            const glm::dvec2 low = square.low + half * glm::dvec2(quarter & 1, quarter >> 1);
            for (const std::uint32_t f : facets)
                if (overlaps(facets_[f], low, low + half)) parts[std::size_t(quarter)].push_back(f);
            in_parts += parts[std::size_t(quarter)].size();
        }
        // Where many facets lie over each other, quarters hold nearly all of them again.
        if (in_parts == 0 || in_parts > 3 * facets.size()) {
            for (std::size_t i = 0; i < facets.size(); ++i)
                for (std::size_t j = 0; j < i && !is_wide() && !is_exhausted(); ++j, ++work_)
                    compare(facets_[facets[i]], facets_[facets[j]]);
            return;
        }
        for (int quarter = 0; quarter < 4; ++quarter)
            visit({square.low + half * glm::dvec2(quarter & 1, quarter >> 1), half}, parts[std::size_t(quarter)],
                  level + 1);
    }

    bool are_coplanar(const std::vector<std::uint32_t>& facets) const
    {
        const auto& base = triangles_[facets_[facets[0]].triangle].corners;
        const glm::dvec3 origin(base[0]);
        const glm::dvec3 n = glm::normalize(glm::cross(glm::dvec3(base[1]) - origin, glm::dvec3(base[2]) - origin));
        for (const std::uint32_t f : facets)
            for (const glm::vec3& corner : triangles_[facets_[f].triangle].corners)
                if (!(std::abs(glm::dot(n, glm::dvec3(corner) - origin)) < tolerance_m_)) return false;
        return true;
    }

    // Where the two overlap, does one lie in front of the other, and has the light something to give to that?
    void compare(const Facet& a, const Facet& b)
    {
        if ((!a.receives && !b.receives) || apart(a.low, a.high, b.low, b.high)) return;
        overlap_.assign(points_.begin() + std::ptrdiff_t(a.first), points_.begin() + std::ptrdiff_t(a.first + a.count));
        for (std::size_t i = 0; i < b.count && overlap_.size() > 2; ++i) {
            const glm::dvec3 &from = points_[b.first + i], &to = points_[b.first + (i + 1) % b.count];
            clip(overlap_, scratch_, [&](const glm::dvec3& p) {
                return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
            });
        }
        if (overlap_.size() < 3 || normal_of(overlap_.data(), overlap_.size()).z < kLeastArea) return;
        const bool matters = std::any_of(overlap_.begin(), overlap_.end(), [&](const glm::dvec3& p) {
            const double other = b.depth(p);
            return (p.z > other ? b : a).receives &&
                   glm::distance(scene_point(p, p.z), scene_point(p, other)) > tolerance_m_;
        });
        if (!matters) return;
        for (const glm::dvec3& p : overlap_) {
            low_ = glm::min(low_, glm::dvec2(p));
            high_ = glm::max(high_, glm::dvec2(p));
        }
    }

    glm::dvec3 scene_point(const glm::dvec3& ndc, double depth) const
    {
        const glm::dvec4 p = scene_from_clip_ * glm::dvec4(ndc.x, ndc.y, depth, 1.0);
        return glm::dvec3(p) / p.w;
    }

    // Nearest and farthest depth of all that lies within the box.
    std::pair<double, double> depths()
    {
        double near = -INFINITY, far = INFINITY;
        for (const Facet& f : facets_) {
            if (apart(f.low, f.high, low_, high_)) continue;
            overlap_.assign(points_.begin() + std::ptrdiff_t(f.first),
                            points_.begin() + std::ptrdiff_t(f.first + f.count));
            for (int axis = 0; axis < 2; ++axis) {
                clip(overlap_, scratch_, [&](const glm::dvec3& p) { return p[axis] - low_[axis]; });
                clip(overlap_, scratch_, [&](const glm::dvec3& p) { return high_[axis] - p[axis]; });
            }
            for (const glm::dvec3& p : overlap_) {
                near = std::max(near, p.z);
                far = std::min(far, p.z);
            }
        }
        return {near, far};
    }

    const std::vector<Triangle>& triangles_;
    glm::dmat4 scene_from_clip_;
    double tolerance_m_;  // surfaces nearer to each other are one: what a float leaves open
    std::vector<glm::dvec3> points_;
    std::vector<Facet> facets_;
    Polygon<glm::dvec4> corners_, clipped_;
    Polygon<glm::dvec3> overlap_, scratch_;
    glm::dvec2 low_{INFINITY}, high_{-INFINITY};
    // Facets looked at and pairs compared; a second's worth at the most.
    static constexpr std::size_t kMostWork = 4'000'000;
    std::size_t work_ = 0;
};

// All that the light sees, and the depths of it. Only triangles on the sides of the view have to be cut.
NdcBox whole_view(const glm::dmat4& clip_from_scene, const std::vector<Triangle>& triangles, double diameter_m)
{
    NdcBox box{glm::dvec3(-1.0, -1.0, 1.0), glm::dvec3(1.0, 1.0, 0.0)};
    const auto extend = [&](double depth) {
        box.low.z = std::min(box.low.z, depth);
        box.high.z = std::max(box.high.z, depth);
    };
    std::vector<Triangle> cut;
    for (const Triangle& triangle : triangles) {
        std::array<glm::dvec4, 3> p;
        int outside_any = 0, outside_all = 31;  // a bit for each side of the view
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = clip_from_scene * glm::dvec4(triangle.corners[i], 1.0);
            const int outside = (p[i].w + p[i].x < 0.0 ? 1 : 0) | (p[i].w - p[i].x < 0.0 ? 2 : 0) |
                                (p[i].w + p[i].y < 0.0 ? 4 : 0) | (p[i].w - p[i].y < 0.0 ? 8 : 0) |
                                (p[i].w - p[i].z < 0.0 ? 16 : 0);
            outside_any |= outside;
            outside_all &= outside;
        }
        if (outside_any == 0)
            for (const glm::dvec4& corner : p) extend(corner.z / corner.w);
        else if (outside_all == 0)
            cut.push_back(triangle);
    }
    const Search on_sides(clip_from_scene, cut, diameter_m);
    for (const glm::dvec3& point : on_sides.points()) extend(point.z);
    return box;
}

}  // namespace

std::optional<NdcBox> shadowed_box(const glm::dmat4& clip_from_scene, const std::vector<Triangle>& triangles,
                                   double diameter_m)
{
    // The largest triangles tell in most scenes that all of the map is needed.
    constexpr std::size_t kLargest = 1024;
    if (triangles.size() > 4 * kLargest) {
        const auto area = [](const Triangle& t) {
            return glm::length(glm::cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]));
        };
        std::vector<std::pair<float, std::uint32_t>> by_area;
        by_area.reserve(triangles.size());
        for (std::uint32_t i = 0; i < triangles.size(); ++i) by_area.emplace_back(area(triangles[i]), i);
        std::nth_element(by_area.begin(), by_area.begin() + kLargest, by_area.end(), std::greater<>());
        std::vector<Triangle> largest;
        for (std::size_t i = 0; i < kLargest; ++i) largest.push_back(triangles[by_area[i].second]);
        if (Search(clip_from_scene, largest, diameter_m).finds_wide_shadows())
            return whole_view(clip_from_scene, triangles, diameter_m);
    }
    return Search(clip_from_scene, triangles, diameter_m).run();
}

}  // namespace conebook
