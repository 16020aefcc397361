// Ground truth: the rendering equation (Kajiya 1986) solved by Monte Carlo, without bias and without clamping.
//
// Bounces are counted as in the whole book: L(x, k) = Le(x) + direct(x) + [k > 0] integral of f L(y, k - 1) cos.
//   k = 0: direct light of punctual lights and visible emission only.
//   k = 1: rays from the visible surface gather what is directly lit or shines: emissive surfaces and the sky light
//          the scene from here on.
//   k < 0: all bounces (Russian roulette).
// The material model is brdf.hpp; punctual lights are KHR_lights_punctual; the sky is a constant radiance.
// Every lobe is 0 where the light or the eye is below the geometric surface, whatever the shading normal says.
// A pixel is the mean over its square (box filter). Alpha is the part of it that shows geometry.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "image/image.hpp"
#include "reference/scene_tracer.hpp"
#include "scene/scene.hpp"

namespace conebook {

// final = direct + indirect_diffuse + indirect_specular + emission.
enum class Part {
    final,
    direct,             // punctual lights at the visible surface, both lobes
    indirect_diffuse,   // everything gathered through the visible surface's diffuse lobe
    indirect_specular,  // and through its specular lobe
    emission,           // of the visible surface; the sky where there is none
};
Part part_from_name(const std::string& name);  // throws std::runtime_error when there is no such part

struct PathTraceOptions {
    int width = 512, height = 512;
    int spp = 64;      // samples per pixel, >= 1
    int bounces = -1;  // indirect bounces, < 0: all
    std::uint64_t seed = 0;
    std::vector<Part> parts{Part::final};                       // one picture each
    glm::vec3 sky{0.0f};                                        // radiance, W/(sr m^2), of rays that leave the scene
    int threads = 0;                                            // 0: all cores; the pictures do not depend on it
    double max_seconds = 0.0;                                   // stop after the pass that exceeds it; 0: never
    std::function<void(double done, double seconds)> progress;  // done 0..1, called on the calling thread
};

struct PathTraceResult {
    std::vector<ImageF> pictures;  // in the order of options.parts; radiance, alpha = coverage
    std::vector<ImageF> errors;    // standard error of each channel of each pixel, 0 when spp is 1; alpha 1
    int spp = 0;                   // samples taken
    std::uint64_t non_finite = 0;  // samples left out because they were NaN or infinite; 0 for a valid scene
    double seconds = 0.0;         // in all
    double sample_seconds = 0.0;  // for the samples alone: no acceleration structure, no sums made into pictures
};

// The path tracer in passes, for whoever shows pictures before they are done. Every sample of every pixel has random
// numbers of its own, which follow from seed, pixel and the sample's number alone: n samples in any number of passes are
// the same picture, bit for bit.
class PathTracer {
public:
    // Builds the acceleration structure. The scene must outlive the tracer and not change. threads 0: all cores.
    explicit PathTracer(const Scene& scene, int threads = 0);
    ~PathTracer();
    PathTracer(PathTracer&&) noexcept;
    PathTracer& operator=(PathTracer&&) noexcept;

    // Forgets all samples: from here on this camera and these options, of which spp, threads, max_seconds and progress
    // are not looked at. Throws std::runtime_error on impossible options.
    void start(const Camera& camera, const PathTraceOptions& options);

    // The next `count` samples of every pixel. False when `stop` came first: then nothing is left, call start again.
    // `progress` gets the share of this pass that is done, on the calling thread.
    bool add_samples(int count, const std::stop_token& stop = {}, const std::function<void(double)>& progress = {});

    // What there is so far; seconds stays 0. At least one sample must have been taken.
    PathTraceResult result() const;

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

// All of it in one call. Throws std::runtime_error on impossible options.
PathTraceResult path_trace(const Scene& scene, const Camera& camera, const PathTraceOptions& options);

// Mean over the picture and the standard error of that mean (pixels are independent).
struct MeanWithError {
    glm::dvec3 mean{0.0}, standard_error{0.0};
};
MeanWithError mean_radiance(const ImageF& picture, const ImageF& error);

// Irradiance of a surface that faces the light, W/m^2, without shadow and without the cosine: I / d^2, or the
// directional light's own, with range window and spot edge as KHR_lights_punctual recommends. `to_light` is set to the
// light's position, or to a point beyond the scene for directional lights.
glm::vec3 unshadowed_irradiance(const Light& light, const glm::vec3& position, float scene_diameter,
                                glm::vec3* to_light);

}  // namespace conebook
