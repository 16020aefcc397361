// Sets of cones that stand for the hemisphere above a surface.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace conebook {

struct ConeSet {
    std::vector<glm::vec4> cones;  // xyz: unit direction, z along the normal; w: weight; the weights sum to 1
    float half_angle_rad = 0.0f;   // of every cone
};

enum class ConeTable : int { tilted = 0, thesis = 1, thesis_added = 2 };

// What a set must fulfil so that light that varies linearly with direction is gathered exactly: the mean of cos over the
// cones, each uniform within its half angle a, is that of the cosine-weighted hemisphere,
//     sum_i w_i cos(t_i) (1 + cos a) / 2 = 2/3.
double first_moment(const ConeSet& set);

// count: 1, 5, 6, 9, 16 or 32. aperture_rad: full aperture of every cone; 0: as wide as covers the hemisphere's share.
// tilted: tilts solve the equation above. thesis: the table of Villegas 2016 for 6 cones (tilts of 60 degrees, weights
// 1/4 and 3/20), and cell centres for the others; their moment is too small, so light from above is lost. thesis_added:
// the same as its code has them (section 3.6.1), which does not rotate the directions but adds their part across the normal
// to the normal: tilts of 40.9 degrees, a moment of 0.762, so light from above counts too much.
ConeSet make_cone_set(int count, ConeTable table, double aperture_rad);

// `sets` different sets of `count` cones each, one after another, for neighbouring pixels to share: every set divides the
// hemisphere into the same cells, and each has its cones at other places of them, so that together they are one set of
// sets * count cones (interleaved sampling, Keller & Heidrich 2001). sets = 1 gives make_cone_set.
ConeSet make_interleaved_cones(int count, ConeTable table, double aperture_rad, int sets);

}  // namespace conebook
