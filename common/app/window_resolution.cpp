#include "app/window_resolution.hpp"

#include <algorithm>

namespace conebook {

void WindowResolution::change()
{
    divisor_ = answer_divisor_;
    answers_ = true;
    done_ = false;
}

void WindowResolution::shown(double seconds, bool more)
{
    // Time goes with the pixels, but for a part that does not. So a coarse picture says too much of finer ones, which is
    // safe, and a fine one too little of coarser ones, which the next answer corrects.
    const double whole_s = seconds * double(divisor_ * divisor_);
    answer_divisor_ = 1;
    while (answer_divisor_ < kCoarsest && whole_s > kAnswer_s * double(answer_divisor_ * answer_divisor_))
        answer_divisor_ *= 2;
    done_ = divisor_ == 1 && !more;
    divisor_ = std::max(1, divisor_ / 2);
    answers_ = false;
}

}  // namespace conebook
