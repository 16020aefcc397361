// Two bounces and more: cones from the voxels themselves.
#pragma once

#include "11_emissives/emitters.hpp"

namespace conebook {

struct BounceParams {
    // Indirect bounces, 0 .. 64, or -1: until nothing changes any more. 0 direct light and visible emission only; 1 cones
    // gather what is directly lit; each further one lets the voxels gather first.
    int bounces = 2;
    // -1 stops when no face changes by more than this share of the brightest one, 1e-6 .. 0.1.
    float tolerance = 1e-3f;
};
void add_parameters(ParameterTable& table, BounceParams& params);

class SecondBounce {
public:
    // `emission_apart`: Emitters::are_apart().
    SecondBounce(gl::Shaders& shaders, bool emission_apart);

    // Make the pyramid of `voxels` hold the light after params.bounces - 1 gatherings from voxel to voxel. The gathered
    // radiance is a mean (weights sum to 1) and the albedo is clamped to 0.99, so no bounce adds more than the last one
    // and the sum is bounded by L(0) / (1 - 0.99).
    void run(LitVoxels& voxels, const Emitters& emitters, const DiffuseConeUniforms& cones,
             const ConeParams& cone_params, const BounceParams& params);

    int gatherings() const { return gatherings_; }  // of the last run
    std::vector<gl::Resource> resources() const { return {gathered_.resource(), bounced_.resource()}; }

private:
    PyramidProgram gather_;
    gl::Program send_on_;
    gl::Buffer gathered_, bounced_, change_;
    int gatherings_ = 0;
};

}  // namespace conebook
