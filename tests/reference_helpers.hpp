// What the tests of the path tracer share: measuring a mean radiance and its standard error. Header only.
// Every tolerance is three of the tracer's own standard errors, and every standard error is asserted to be small against
// what is measured, so that the tests cannot pass by being noisy.
#pragma once

#include <functional>

#include <gtest/gtest.h>

#include "reference/path_tracer.hpp"
#include "scene_builder.hpp"

namespace conebook {

inline constexpr double kPiD = 3.14159265358979323846;

struct Measured {
    double mean = 0.0, error = 0.0;  // of the red channel
};

inline PathTraceOptions options(int bounces, int spp = 64, int size = 32)
{
    PathTraceOptions o;
    o.width = o.height = size;
    o.spp = spp;
    o.bounces = bounces;
    return o;
}

inline Measured measure(const Scene& scene, const Camera& camera, const PathTraceOptions& o)
{
    const PathTraceResult result = path_trace(scene, camera, o);
    EXPECT_EQ(result.non_finite, 0u);
    const MeanWithError m = mean_radiance(result.pictures[0], result.errors[0]);
    return {m.mean.x, m.standard_error.x};
}

// float arithmetic alone gives up to 2e-5 on values without noise.
inline void expect_radiance(const Measured& m, double expected, double relative_error_limit = 0.005, double extra = 0.0)
{
    EXPECT_NEAR(m.mean, expected, 3.0 * m.error + (2e-5 + extra) * expected);
    EXPECT_LT(m.error, relative_error_limit * expected) << "too noisy to test anything";
}

// Looks at one point, 0.1 degrees wide.
inline Camera at_point(const glm::vec3& eye, const glm::vec3& point) { return look_at(eye, point, 0.0017f); }

inline Scene floor_with(const std::function<void(SceneBuilder&)>& add, const glm::vec3& rho = glm::vec3(0.5f))
{
    SceneBuilder b;
    b.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, b.material(lambert(rho)));
    add(b);
    return b.build();
}

}  // namespace conebook
