#include "13_ground_truth/background_tracer.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace conebook {

namespace {

constexpr int kLargestPass = 16;  // samples; a picture costs about as much as one

PathTraceOptions options_of(const TraceJob& job)
{
    PathTraceOptions options;
    options.width = job.size.x;
    options.height = job.size.y;
    options.bounces = job.bounces;
    options.parts = {job.part};
    options.sky = glm::vec3(job.sky);
    return options;
}

std::shared_ptr<const Refinement> refinement(const PathTracer& tracer)
{
    PathTraceResult result = tracer.result();
    if (result.non_finite > 0)
        throw std::runtime_error("path tracer: " + std::to_string(result.non_finite) + " samples were NaN or infinite");
    Refinement r;
    r.samples = result.spp;
    r.mean = mean_radiance(result.pictures[0], result.errors[0]);
    for (const glm::vec4& e : result.errors[0].pixels) r.pixel_error += (double(e.x) + e.y + e.z) / 3.0;
    r.pixel_error /= double(result.errors[0].pixels.size());
    r.picture = std::move(result.pictures[0]);
    return std::make_shared<const Refinement>(std::move(r));
}

}  // namespace

bool operator==(const TraceJob& a, const TraceJob& b)
{
    const Camera &c = a.camera, &d = b.camera;
    return c.world_from_camera == d.world_from_camera && c.orthographic == d.orthographic && c.y_fov == d.y_fov &&
           c.x_mag == d.x_mag && c.y_mag == d.y_mag && c.z_near == d.z_near && c.z_far == d.z_far &&
           a.size == b.size && a.part == b.part && a.bounces == b.bounces && a.sky == b.sky;
}

BackgroundTracer::~BackgroundTracer()
{
    const std::lock_guard lock(mutex_);
    pass_.request_stop();
    thread_.request_stop();
}

// snippet: follow
void BackgroundTracer::follow(const TraceJob& job, int samples)
{
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    wanted_samples_ = samples;
    if (!job_ || !(*job_ == job)) {
        job_ = job;
        restart_ = true;
        taken_samples_ = 0;
        newest_.reset();
        pass_.request_stop();  // it would show the old camera
        pass_ = std::stop_source();
    }
    if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    wake_.notify_one();
}
// end snippet

void BackgroundTracer::wait()
{
    std::unique_lock lock(mutex_);
    published_.wait(lock, [&] { return failure_ || taken_samples_ >= wanted_samples_; });
    if (failure_) std::rethrow_exception(failure_);
}

std::shared_ptr<const Refinement> BackgroundTracer::newest() const
{
    const std::lock_guard lock(mutex_);
    return newest_;
}

void BackgroundTracer::run(const std::stop_token& stop)
{
    try {
        trace_passes(stop);
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
        published_.notify_all();
    }
}

void BackgroundTracer::trace_passes(const std::stop_token& stop)
{
    PathTracer tracer(scene_, threads_);
    const auto work_left = [&] { return restart_ || taken_samples_ < wanted_samples_; };
    // snippet: passes
    while (true) {
        std::unique_lock lock(mutex_);
        if (!wake_.wait(lock, stop, work_left) || stop.stop_requested()) return;
        const bool restart = std::exchange(restart_, false);
        const TraceJob job = *job_;
        // Short passes first, so that something is seen soon.
        const int left = std::max(wanted_samples_ - taken_samples_, 1);
        const int count = std::min(std::clamp(taken_samples_ / 4, 1, kLargestPass), left);
        const std::stop_token pass = pass_.get_token();
        lock.unlock();
        if (restart) tracer.start(job.camera, options_of(job));
        if (!tracer.add_samples(count, pass)) continue;
        const std::shared_ptr<const Refinement> next = refinement(tracer);

        lock.lock();
        if (restart_) continue;  // a new job has come since
        newest_ = next;
        taken_samples_ = next->samples;
        published_.notify_all();
    }
    // end snippet
}

}  // namespace conebook
