// How fine a window's next picture is: coarse while things move, so that the answer comes soon; finer while they stay.
#pragma once

namespace conebook {

// A picture has 1 / divisor of the pixels of the window along each side. What was measured of the last says how coarse
// an answer must be. Knows neither a window nor OpenGL.
class WindowResolution {
public:
    // `first_divisor`: a guess for the first picture, when nothing has been measured.
    explicit WindowResolution(int first_divisor) : divisor_(first_divisor), answer_divisor_(first_divisor) {}

    // Of the next picture: 1, 2, 4 or 8.
    int divisor() const { return divisor_; }
    // Whether the next picture is the first one since a change. Such a one is finished whatever happens meanwhile, or a
    // reader who keeps moving would see none; a later one may be given up for a newer view of things.
    bool answers() const { return answers_; }
    // Whether the last picture was all that could be shown.
    bool done() const { return done_; }

    // What is to be seen has changed: the next picture is coarse.
    void change();
    // The picture was shown after `seconds` of work for the camera. `more`: a further picture of
    // the same size would add something (accumulation).
    void shown(double seconds, bool more);

    // Work for an answer. Before it ends one slice of the picture that is given up, or another answer; after it comes
    // the way to the screen: 0.25 s in all.
    static constexpr double kAnswer_s = 0.1;
    static constexpr int kCoarsest = 8;

private:
    int divisor_, answer_divisor_;
    bool answers_ = true, done_ = false;
};

}  // namespace conebook
