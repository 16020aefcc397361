// From a scene to the irradiance of all its surfaces: patches, form factors, direct light, solution, corners.
#pragma once

#include <memory>

#include "20_form_factor_radiosity/hemicube.hpp"
#include "20_form_factor_radiosity/reconstruction.hpp"
#include "app/statistics.hpp"
#include "gl/gpu_scene.hpp"

namespace conebook {

struct RadiosityParams {
    PatchParams patches;
    FormFactorParams form_factors;
    SolverParams solver;
    ReconstructionParams reconstruction;
};
void add_parameters(ParameterTable& table, RadiosityParams& params);

// Patches of a scene: bisected evenly, and, if asked, further where a first solution by rays changes from patch to
// patch.
Patches make_patches(const SceneTracer& tracer, const PatchParams& params, const std::vector<Light>& lights);

// Each step runs when something that it depends on has changed, and says whether it did. In this order.
class Radiosity {
public:
    Radiosity(gl::Shaders& shaders, const Scene& scene);

    bool make_patches(const RadiosityParams& params, const GpuScene& scene);
    bool find_form_factors(const RadiosityParams& params);
    bool light_patches(const GpuScene& scene);
    bool solve(const RadiosityParams& params);
    bool fit_corners(const RadiosityParams& params);

    const SceneTracer& tracer() const { return tracer_; }
    const Patches& patches() const { return *patches_; }
    const FormFactors& form_factors() const { return form_factors_; }
    const Solution& solution() const { return solution_; }
    Hemicubes& hemicubes();
    // Irradiance at corners after so many bounces less than asked for as Solution::before says; null where none is
    // left.
    const CornerValues* corners_before(int mirrors) const;
    const CornerValues& corners() const { return corners_.back(); }
    Revision corners_revision() const { return corners_revision_; }

    std::vector<Count> counts() const;
    std::vector<gl::Resource> resources() const;
    std::vector<Need> needs(const RadiosityParams& params) const;

private:
    Irradiance light_of(const Lamps& lamps) const;  // directly, W/m^2
    gl::Shaders* shaders_;
    const Scene* scene_;
    SceneTracer tracer_;
    std::unique_ptr<Hemicubes> hemicubes_;  // made when first needed
    std::unique_ptr<Patches> patches_;
    FormFactors form_factors_;
    Solution solution_;
    std::unique_ptr<Surfaces> surfaces_;
    std::vector<CornerValues> corners_;  // as Solution::after; without mirrors the last one alone
    Revision patches_revision_ = 0, lit_revision_ = 0, factors_revision_ = 0, solution_revision_ = 0,
             corners_revision_ = 0;
    MadeFrom<PatchParams, Revision> patches_from_;
    MadeFrom<FormFactorParams, Revision> factors_from_;
    MadeFrom<Revision, Revision> lit_from_;
    MadeFrom<SolverParams, Revision, Revision> solution_from_;
    MadeFrom<ReconstructionParams, Revision> corners_from_;
};

}  // namespace conebook
