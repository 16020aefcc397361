// Form factors: which share of a patch's view every other patch fills, directly and by way of mirrors.
#pragma once

#include <cstdint>
#include <vector>

#include "20_form_factor_radiosity/patches.hpp"

namespace conebook {

enum class FormFactorMethod : int { hemicube, embree, hybrid };
enum class TexelWeights : int { exact, density, draft };

struct FormFactorParams {
    // hemicube: all by rasterization; embree: all by rays; hybrid: rasterized, rays from the mirrors on.
    int form_factors = int(FormFactorMethod::embree);
    // Texels along a side of the hemicube's top, 8 .. 1024, even.
    int resolution = 64;
    // Item buffers a patch, 1 .. 16: one at its middle, or as many stratified places.
    int samples = 1;
    // Rays a patch, 16 .. 65536, from 16 stratified places.
    int rays = 256;
    // Of few emitters: exact form factors and rays that ask whether they are hidden. Off: whatever the rays meet.
    bool aim_at_lamps = true;
    // Mirrors along a path, 0 .. 64.
    int reflections = 8;
    // exact: integrals over texels; density: the integrand at its middle; draft: the draft's formula, exponent 1.
    int texel_weights = int(TexelWeights::exact);
    bool operator==(const FormFactorParams&) const = default;
};
void add_parameters(ParameterTable& table, FormFactorParams& params);

// F_ij of what patch i sees directly: the share of the cosine-weighted hemisphere over i that j fills.
struct FormFactorEntry {
    std::uint32_t patch;
    float share;
};
// The same of what it sees over so many mirrors, 1 or more; the share is the product of their rho_s.
struct MirroredFormFactor {
    std::uint32_t patch, reflections;
    glm::vec3 share;
};

// Rows of F^. Sparse: what a patch does not see is not there. Each row's entries are in the order of the patches.
struct FormFactorRow {
    std::vector<FormFactorEntry> direct;
    std::vector<MirroredFormFactor> mirrored;
};
struct FormFactors {
    std::vector<FormFactorRow> rows;
    double rays = 0.0;          // that were traced
    double item_buffers = 0.0;  // that were rendered
    std::size_t entries() const;
    std::size_t bytes() const;
};

// Adds up what is seen from a patch, in any order, and makes a row of it.
class RowBuilder {
public:
    void add(std::uint32_t patch, float share)
    {
        if (!direct_.empty() && direct_.back().patch == patch)
            direct_.back().share += share;
        else
            direct_.push_back({patch, share});
    }
    void add(std::uint32_t patch, std::uint32_t reflections, const glm::vec3& share)
    {
        mirrored_.push_back({patch, reflections, share});
    }
    void scale(std::size_t first_direct, float direct_scale);  // of the entries from there on
    std::size_t direct_count() const { return direct_.size(); }
    void append(const RowBuilder& other);
    FormFactorRow finish();

private:
    std::vector<FormFactorEntry> direct_;
    std::vector<MirroredFormFactor> mirrored_;
};

// Follows a ray from a mirror to what it meets, over further mirrors. `hit` was met along `direction` (unit) with
// `share` of the row. Returns the number of rays.
int follow_mirrors(const Patches& patches, SurfaceHit hit, glm::vec3 direction, glm::vec3 share, int reflections,
                   RowBuilder& row);

// All rows by rays (Embree).
FormFactors trace_form_factors(const Patches& patches, const FormFactorParams& params);

}  // namespace conebook
