// All bounces of light from voxel to voxel: every face keeps where its light comes from, and the light goes round.
#pragma once

#include "11_emissives/emitters.hpp"

namespace conebook {

struct BounceParams {
    // Indirect bounces, 0 .. 64, or -1: until nothing changes any more. 0 direct light and visible emission only; 1
    // cones gather what is directly lit; each further one lets the voxels gather first.
    int bounces = -1;
    // -1 stops when no face changes by more than this share of the brightest one, 1e-6 .. 0.1.
    float tolerance = 1e-3f;
    // Links that every face keeps: 1, 5, 9 or 16 rays of equal weight.
    int links = 5;
    // bounces=-1 begins with the last solution instead of with direct light; where faces have come, with their
    // direct light. What is left of the last solution is within the tolerance. For scenes that change from frame to
    // frame (chapter 15).
    bool warm_start = false;
    // With that, bounces in a frame; 0: until nothing changes. The light then lags behind what moves.
    int bounces_a_frame = 0;
    bool operator==(const BounceParams&) const = default;
};
void add_parameters(ParameterTable& table, BounceParams& params);
void add_warm_start(ParameterTable& table, BounceParams& params);

// Light goes from voxel to voxel before cones gather it.
inline bool goes_round(const BounceParams& params) { return params.bounces < 0 || params.bounces > 1; }

// R(k) = R(0) + rho (mean of R(k - 1) over the links + what emitters send + what the sky sends): R(0) is what
// chapter 06's faces reflect of direct light. The links depend on the scene alone, so a bounce is one look-up a link
// (the transport matrix of radiosity, with one entry a link: Cohen & Wallace 1993, section 5.3). Between two
// revisions of the faces, what of them is another: those in voxels low <= v <= high, and those that have no place of
// their own (VoxelFaces::kept()).
struct FaceChange {
    Revision from = 0, to = 0;
    glm::ivec3 low{0}, high{-1};
};

class Bounces {
public:
    explicit Bounces(gl::Shaders& shaders);

    // Where every face's light comes from, if the faces or the rays have changed; says whether they have. With a
    // `change` since the last call, of those faces alone whose rays come by what has changed; the other rays meet
    // what they met, but where a rounding decides between two voxels: leaps of another length round otherwise.
    bool link(const LitVoxels& voxels, const WalkVolume& walk, const Emitters& emitters, const ConeParams& cones,
              const BounceParams& params, const FaceChange& change = {});
    const gl::Buffer& links() const { return links_; }
    // What the faces reflect after params.bounces - 1 bounces from voxel to voxel, at least one, if anything has
    // changed. A mean times an albedo of at most 0.99, so no bounce adds more than the last one and the sum is
    // bounded by R(0) / (1 - 0.99).
    bool run(const LitVoxels& voxels, const ConeParams& cones, const BounceParams& params);
    // Whether the last run ended because nothing changed any more, or was asked for so many bounces.
    bool is_settled() const { return settled_; }

    // Frees what only a run needs; the next one makes it anew.
    void free_scratch()
    {
        for (gl::Buffer& buffer : packed_) buffer = {};
    }

    // vec4 a face: W/(sr m^2).
    const gl::Buffer& reflected() const { return reflected_; }
    Revision revision() const { return revision_; }
    int count() const { return count_; }  // bounces from voxel to voxel of the last run
    std::vector<gl::Resource> resources() const;

private:
    gl::ProgramVariants link_, bounce_;
    gl::Buffer links_, from_emitters_, albedo_, packed_[2], reflected_, last_reflected_, change_;
    bool has_emitters_ = false;
    MadeFrom<Revision, Revision, Revision> linked_from_;  // walk volume, coverage, emitters
    MadeFrom<float, ConeTable, float, int> linked_with_;  // rays, links
    Revision linked_faces_ = 0, linked_order_ = 0;
    MadeFrom<Revision, Revision, float, BounceParams> made_from_;  // links, what is directly lit, sky
    Revision links_revision_ = 0, revision_ = 0;
    int count_ = 0;
    bool settled_ = true;
    Revision solved_faces_ = 0, solved_order_ = 0;  // of the last solution: revision and order of its faces
};

}  // namespace conebook
