#include "image/resample.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace conebook {

double linear_from_srgb(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
double srgb_from_linear(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055; }

namespace {

// What of the `from` texels along a side falls into texel `index` of `to`: [first, last) and the share of the ends.
struct Span {
    int first, last;
    double low, high;  // in texels of `from`
    Span(int index, int from, int to) : low(double(index) * from / to), high(double(index + 1) * from / to)
    {
        first = int(low);
        last = std::min(int(std::ceil(high)), from);
    }
    double weight(int texel) const
    {
        return std::max(0.0, std::min(high, texel + 1.0) - std::max(low, double(texel))) / (high - low);
    }
};

}  // namespace

Image8 shrink(const Image8& image, int width, int height, Encoding encoding)
{
    std::array<std::array<double, 256>, 4> decoded;  // by channel
    for (int c = 0; c < 4; ++c)
        for (int i = 0; i < 256; ++i)
            decoded[c][i] = c < 3 && encoding == Encoding::srgb ? linear_from_srgb(i / 255.0) : i / 255.0;

    Image8 result{width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * 4)};
    std::vector<double> sum(std::size_t(width) * 4);
    for (int y = 0; y < height; ++y) {
        const Span rows(y, image.height, height);
        std::fill(sum.begin(), sum.end(), 0.0);
        for (int from_y = rows.first; from_y < rows.last; ++from_y) {
            const std::uint8_t* texels = &image.rgba[std::size_t(from_y) * std::size_t(image.width) * 4];
            for (int x = 0; x < width; ++x) {
                const Span columns(x, image.width, width);
                for (int from_x = columns.first; from_x < columns.last; ++from_x) {
                    const double weight = rows.weight(from_y) * columns.weight(from_x);
                    for (int c = 0; c < 4; ++c)
                        sum[std::size_t(4 * x + c)] += weight * decoded[c][texels[4 * from_x + c]];
                }
            }
        }
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const bool srgb = i % 4 < 3 && encoding == Encoding::srgb;
            const double value = srgb ? srgb_from_linear(sum[i]) : sum[i];
            result.rgba[std::size_t(y) * sum.size() + i] =
                std::uint8_t(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
        }
    }
    return result;
}

}  // namespace conebook
