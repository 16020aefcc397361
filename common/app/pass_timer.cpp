#include "app/pass_timer.hpp"

#include <chrono>

namespace conebook {

void PassTimer::time(const std::string& pass, Scope scope, const std::function<bool()>& work, Statistics& statistics)
{
    const gl::DebugGroup group(pass);
    // What a pass stores must not overtake what the ones before still read of it, be it the last frame's picture: stores
    // wait for all accesses before these barriers (OpenGL 4.5, 7.12.2). What they wrote, each pass makes visible itself.
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    if (clock_ == Clock::cpu_around_finish) {
        glFinish();
        const auto start = std::chrono::steady_clock::now();
        if (!work()) return;
        glFinish();
        const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
        statistics.add_time(pass, scope, elapsed.count());
        return;
    }
    if (unused_.empty()) {
        GLuint id = 0;
        glCreateQueries(GL_TIME_ELAPSED, 1, &id);
        unused_.emplace_back(id);
    }
    pending_.push_back({pass, scope, frame_, std::move(unused_.back())});
    unused_.pop_back();
    bool ran = false;
    const auto end = [&] {
        glEndQuery(GL_TIME_ELAPSED);
        if (ran) return;
        unused_.push_back(std::move(pending_.back().query));
        pending_.pop_back();
    };
    glBeginQuery(GL_TIME_ELAPSED, pending_.back().query.id());
    try {
        ran = work();
    } catch (...) {
        end();
        throw;
    }
    end();
}

void PassTimer::end_frame(Statistics& statistics)
{
    ++frame_;
    while (!pending_.empty()) {
        GLint arrived = GL_FALSE;
        glGetQueryObjectiv(pending_.front().query.id(), GL_QUERY_RESULT_AVAILABLE, &arrived);
        if (arrived == GL_FALSE && frame_ - pending_.front().frame < kFramesInFlight) return;
        take_oldest(statistics);
    }
}

void PassTimer::finish(Statistics& statistics)
{
    while (!pending_.empty()) take_oldest(statistics);
}

void PassTimer::take_oldest(Statistics& statistics)
{
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(pending_.front().query.id(), GL_QUERY_RESULT, &nanoseconds);
    statistics.add_time(pending_.front().pass, pending_.front().scope, 1e-6 * double(nanoseconds));
    unused_.push_back(std::move(pending_.front().query));
    pending_.pop_front();
}

}  // namespace conebook
