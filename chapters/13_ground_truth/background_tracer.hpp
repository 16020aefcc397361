// The path tracer beside the frame loop: a thread adds samples, pass after pass, while frames go on.
#pragma once

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "reference/path_tracer.hpp"
#include "scene/scene.hpp"

namespace conebook {

// What is to be traced. Any other job than the last one forgets the samples.
struct TraceJob {
    Camera camera;
    glm::ivec2 size{0};  // pixels
    Part part = Part::final;
    int bounces = -1;  // indirect bounces, -1: all
    float sky = 0.0f;  // W/(sr m^2)
};
bool operator==(const TraceJob& a, const TraceJob& b);

// What there is so far.
struct Refinement {
    ImageF picture;            // mean radiance of the samples, alpha = coverage
    int samples = 0;           // of each pixel
    MeanWithError mean;        // of the picture, W/(sr m^2)
    double pixel_error = 0.0;  // mean standard error of a pixel's channels, W/(sr m^2)
};

class BackgroundTracer {
public:
    // The scene must outlive this and not change. No thread is started before follow. threads 0: all cores; the
    // pictures do not depend on it.
    explicit BackgroundTracer(const Scene& scene, int threads = 0) : scene_(scene), threads_(threads) {}
    ~BackgroundTracer();
    BackgroundTracer(const BackgroundTracer&) = delete;
    BackgroundTracer& operator=(const BackgroundTracer&) = delete;

    // Refine this job until every pixel has `samples` samples. Returns at once. Throws what the thread ran into, for
    // example std::runtime_error when Embree fails.
    void follow(const TraceJob& job, int samples);

    // Until the job that is followed has all its samples. Throws as follow.
    void wait();

    // The newest picture of the job that is followed; null while there is none.
    std::shared_ptr<const Refinement> newest() const;

private:
    void run(const std::stop_token& stop);
    void trace_passes(const std::stop_token& stop);

    const Scene& scene_;
    const int threads_;
    mutable std::mutex mutex_;  // guards everything down to `failure_`
    std::condition_variable_any wake_, published_;
    std::optional<TraceJob> job_;
    bool restart_ = false;
    int wanted_samples_ = 0, taken_samples_ = 0;
    std::stop_source pass_;  // ends the pass that is under way
    std::shared_ptr<const Refinement> newest_;
    std::exception_ptr failure_;
    std::jthread thread_;  // last: joined before anything that it uses goes
};

}  // namespace conebook
