// How long each pass of a frame takes, without waiting for the frame that is being drawn.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "app/statistics.hpp"
#include "gl/handles.hpp"

namespace conebook {

class PassTimer {
public:
    // cpu_around_finish: for software drivers, whose timer queries do not count the work (llvmpipe: 0.00 ms for 400 ms).
    // gpu_queries: everywhere else; nothing waits, results come up to kFramesInFlight frames later.
    enum class Clock { cpu_around_finish, gpu_queries };
    explicit PassTimer(Clock clock) : clock_(clock) {}

    // Do `work`, which says whether there was anything to do; if not, no time is counted. It times no pass itself: timer
    // queries do not nest (OpenGL 4.5, 4.2.3).
    void time(const std::string& pass, Scope scope, const std::function<bool()>& work, Statistics& statistics);
    // Hand over what has arrived of this and earlier frames, in the order in which the passes ran.
    void end_frame(Statistics& statistics);
    // Wait for all that is still on its way.
    void finish(Statistics& statistics);

    // A driver keeps at most two or three frames waiting for its device, so after four a result is there.
    static constexpr int kFramesInFlight = 4;

private:
    struct Pending {
        std::string pass;
        Scope scope;
        int frame;
        gl::Handle<gl::delete_query> query;
    };
    void take_oldest(Statistics& statistics);
    Clock clock_;
    int frame_ = 0;
    std::deque<Pending> pending_;  // oldest first
    std::vector<gl::Handle<gl::delete_query>> unused_;
};

}  // namespace conebook
