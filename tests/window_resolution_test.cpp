// How coarse a window's pictures are, for programs whose time is known: a part for every picture and a part for every pixel.
#include <gtest/gtest.h>

#include "app/window_resolution.hpp"

namespace conebook {
namespace {

struct Costs {
    double fixed_s, whole_s;  // of any picture; more for one of all pixels
    double of(int divisor) const { return fixed_s + whole_s / double(divisor * divisor); }
};

// The reader moves for many pictures; the divisors of them.
std::vector<int> while_moving(WindowResolution& resolution, const Costs& costs, int pictures = 20)
{
    std::vector<int> divisors;
    for (int i = 0; i < pictures; ++i) {
        resolution.change();
        divisors.push_back(resolution.divisor());
        EXPECT_TRUE(resolution.answers());
        resolution.shown(costs.of(resolution.divisor()), true);
    }
    return divisors;
}

TEST(WindowResolution, AnswersInTimeWhateverAPictureCosts)
{
    for (const double whole_s : {0.001, 0.03, 0.2, 0.7, 1.5, 5.0})
        for (const double fixed_s : {0.0, 0.01, 0.02}) {
            const Costs costs{fixed_s, whole_s};
            for (const int guess : {1, 4}) {
                WindowResolution resolution(guess);
                const std::vector<int> divisors = while_moving(resolution, costs);
                // One answer corrects what a whole picture says of coarse ones; from 8 to 1 by halves it takes four.
                constexpr std::size_t kSettled = 4;
                for (std::size_t i = 2; i < divisors.size(); ++i) {
                    EXPECT_LE(costs.of(divisors[i]), WindowResolution::kAnswer_s) << whole_s << " " << fixed_s << " at " << i;
                    if (i >= kSettled) {
                        EXPECT_EQ(divisors[i], divisors[kSettled]) << "sharp and blurred by turns";
                    }
                }
            }
        }
}

TEST(WindowResolution, IsNoCoarserThanItMustBe)
{
    for (const double whole_s : {0.001, 0.03, 0.2, 0.7, 1.5, 5.0}) {
        WindowResolution resolution(4);
        const int divisor = while_moving(resolution, {0.0, whole_s}).back();
        if (divisor > 1) {
            EXPECT_GT(whole_s / (divisor * divisor / 4.0), WindowResolution::kAnswer_s) << whole_s;
        }
    }
}

TEST(WindowResolution, StaysAtTheCoarsestWhenNothingHelps)
{
    WindowResolution resolution(4);
    EXPECT_EQ(while_moving(resolution, {10.0, 100.0}).back(), WindowResolution::kCoarsest);
}

TEST(WindowResolution, GoesUpToTheWholePictureThenToTheLastSample)
{
    const Costs costs{0.0, 1.0};
    WindowResolution resolution(4);
    while_moving(resolution, costs);
    std::vector<int> divisors;
    constexpr int kSamples = 5;
    for (int whole = 0; !resolution.done() && divisors.size() < 100;) {
        const int divisor = resolution.divisor();
        EXPECT_FALSE(resolution.answers());
        divisors.push_back(divisor);
        whole += int(divisor == 1);
        resolution.shown(costs.of(divisor), divisor > 1 || whole < kSamples);
    }
    EXPECT_EQ(divisors, (std::vector<int>{2, 1, 1, 1, 1, 1}));
    resolution.change();
    EXPECT_FALSE(resolution.done());
}

// A picture of few pixels is never the last one, even when there is nothing to add to it.
TEST(WindowResolution, IsNotDoneBeforeThePictureIsWhole)
{
    WindowResolution resolution(2);
    resolution.shown(0.01, false);
    EXPECT_FALSE(resolution.done());
    EXPECT_EQ(resolution.divisor(), 1);
    resolution.shown(0.01, false);
    EXPECT_TRUE(resolution.done());
}

}  // namespace
}  // namespace conebook
