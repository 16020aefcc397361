#include "reference/compare_images.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "common/color_scales.glsl"
#include "reference/flip.hpp"

namespace conebook {
namespace {

constexpr double kRelativeFloor = 0.01;  // of the mean: keeps relative errors of black pixels finite
constexpr double kNoiseShare = 0.1;      // of the error, above which the reference counts as noisy

std::string size_text(const ImageF& image) { return std::to_string(image.width) + "x" + std::to_string(image.height); }

void check_finite(const ImageF& image, const char* which)
{
    std::size_t bad = 0, first = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const glm::vec4& p = image.pixels[i];
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.w)) continue;
        if (bad++ == 0) first = i;
    }
    if (bad > 0)
        throw std::runtime_error(std::string(which) + " has NaN or infinite values in " + std::to_string(bad) +
                                 " pixels, first at x=" + std::to_string(first % image.width) +
                                 " y=" + std::to_string(first / image.width));
}

void check_size(const ImageF& image, const ImageF& reference, const char* which)
{
    if (image.width != reference.width || image.height != reference.height)
        throw std::runtime_error(std::string("sizes differ: ") + which + " is " + size_text(image) +
                                 ", the reference " + size_text(reference));
}

// A channel of a pixel or block: picture, reference, and the variance of the reference.
struct Pair {
    double image, reference, variance;
};

std::vector<Pair> collect(const ImageF& image, const ImageF& reference, const CompareOptions& options)
{
    std::vector<Pair> pairs;
    const int block = std::max(1, options.block);
    for (int y0 = 0; y0 < image.height; y0 += block)
        for (int x0 = 0; x0 < image.width; x0 += block) {
            glm::dvec3 i(0.0), r(0.0), v(0.0);
            double n = 0.0;
            for (int y = y0; y < std::min(y0 + block, image.height); ++y)
                for (int x = x0; x < std::min(x0 + block, image.width); ++x) {
                    if (reference.at(x, y).a <= 0.0f) continue;
                    i += glm::dvec3(image.at(x, y));
                    r += glm::dvec3(reference.at(x, y));
                    if (options.reference_error) {
                        const glm::dvec3 s(options.reference_error->at(x, y));
                        v += s * s;
                    }
                    n += 1.0;
                }
            if (n == 0.0) continue;
            for (int c = 0; c < 3; ++c) pairs.push_back({i[c] / n, r[c] / n, v[c] / (n * n)});
        }
    return pairs;
}

}  // namespace

ImageMetrics compare_images(const ImageF& image, const ImageF& reference, const CompareOptions& options)
{
    check_size(image, reference, "the picture");
    check_finite(image, "the picture");
    check_finite(reference, "the reference");
    if (options.reference_error) {
        check_size(*options.reference_error, reference, "the error picture");
        check_finite(*options.reference_error, "the error picture");
    }
    if (options.block < 1) throw std::runtime_error("blocks must be at least 1 pixel wide");
    const std::vector<Pair> pairs = collect(image, reference, options);
    if (pairs.empty()) throw std::runtime_error("nothing to compare: the reference's alpha is 0 everywhere");

    ImageMetrics m;
    for (const glm::vec4& p : reference.pixels) m.pixels += p.a > 0.0f;
    const double n = double(pairs.size());
    double variance = 0.0, mse = 0.0;
    for (const Pair& p : pairs) {
        m.mean_image += p.image / n;
        m.mean_reference += p.reference / n;
        mse += (p.image - p.reference) * (p.image - p.reference) / n;
        variance += p.variance / n;
    }
    m.bias = m.mean_image - m.mean_reference;
    // Two black pictures are equal; against a black reference every other ratio is infinite, which JSON cannot hold.
    const auto over_mean = [&](double value) {
        if (m.mean_reference > 0.0) return value / m.mean_reference;
        return value == 0.0 ? 0.0 : HUGE_VAL;
    };
    m.signed_ratio = m.mean_image == m.mean_reference ? 1.0 : over_mean(m.mean_image);
    m.rmse = std::sqrt(mse);
    m.nrmse = over_mean(m.rmse);
    const double floor = kRelativeFloor * m.mean_reference;
    const double floor2 = kRelativeFloor * m.mean_reference * m.mean_reference;
    std::vector<double> relative;
    relative.reserve(pairs.size());
    double noise_smape = 0.0;
    for (const Pair& p : pairs) {
        const double d = std::abs(p.image - p.reference);
        const double both = std::abs(p.image) + std::abs(p.reference);
        const double relative_error = d > 0.0 ? d / (std::abs(p.reference) + floor) : 0.0;
        relative.push_back(relative_error);
        m.mape += relative_error / n;
        m.smape += both > 0.0 ? d / both / n : 0.0;
        const double noise = std::sqrt(2.0 / std::numbers::pi * p.variance);
        noise_smape += noise > 0.0 ? std::min(noise / both, 1.0) / n : 0.0;
        m.rel_mse += d > 0.0 ? d * d / (p.reference * p.reference + floor2) / n : 0.0;
    }
    const auto rank = std::size_t(std::ceil(0.95 * n)) - 1;
    std::nth_element(relative.begin(), relative.begin() + std::ptrdiff_t(rank), relative.end());
    m.relative_error_p95 = relative[rank];
    if (options.reference_error) {
        m.noise_rms = std::sqrt(variance);
        m.rmse_without_noise = std::sqrt(std::max(mse - variance, 0.0));
        m.noise_smape = noise_smape;
        m.noisy_reference = *m.noise_rms > kNoiseShare * m.rmse;
    }
    if (options.flip) m.flip = hdr_flip_mean(image, reference);
    return m;
}

Image8 error_heatmap(const ImageF& image, const ImageF& reference)
{
    check_size(image, reference, "the picture");
    Image8 map{image.width, image.height, {}};
    map.rgba.reserve(image.pixels.size() * 4);
    const auto byte = [](float x) { return std::uint8_t(std::lround(255.0f * x)); };
    for (std::size_t k = 0; k < image.pixels.size(); ++k) {
        const glm::dvec3 a(image.pixels[k]), b(reference.pixels[k]);
        const double i = a.x + a.y + a.z, r = b.x + b.y + b.z;
        if (reference.pixels[k].a <= 0.0f) {
            map.rgba.insert(map.rgba.end(), {96, 96, 96, 255});
            continue;
        }
        // (I - R)/(I + R) is +-1/2 at a factor of three; the second half of the scale goes on to white.
        const glm::vec3 c = color_scales::difference_color(i + r > 0.0 ? float(2.0 * (i - r) / (i + r)) : 0.0f);
        map.rgba.insert(map.rgba.end(), {byte(c.r), byte(c.g), byte(c.b), 255});
    }
    return map;
}

}  // namespace conebook
