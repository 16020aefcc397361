#include "reference/flip.hpp"

#include <algorithm>
#include <cmath>

namespace conebook {
namespace {

constexpr float kPixelsPerDegree = kFlipPixelsPerDegree;
constexpr float kPi = 3.14159265358979f;

// Constants of the 2020 paper: section 4.1 (error redistribution), 4.2 (features), 4.3 (their combination).
constexpr float kColorExponent = 0.7f, kColorCut = 0.4f, kColorTarget = 0.95f;
constexpr float kFeatureWidthDegrees = 0.082f, kFeatureExponent = 0.5f;

using Plane = std::vector<float>;
using Colors = std::vector<glm::vec3>;

// Linear RGB (sRGB primaries, D65) to XYZ and back. Columns of the matrices are the primaries.
const glm::mat3 kXyzFromRgb(0.4124564f, 0.2126729f, 0.0193339f, 0.3575761f, 0.7151522f, 0.1191920f, 0.1804375f,
                            0.0721750f, 0.9503041f);
const glm::mat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const glm::vec3 kWhite = kXyzFromRgb * glm::vec3(1.0f);

// Linear opponent space YCxCz (2020 paper, section 4.1).
glm::vec3 ycxcz_from_rgb(const glm::vec3& rgb)
{
    const glm::vec3 n = kXyzFromRgb * rgb / kWhite;
    return {116.0f * n.y - 16.0f, 500.0f * (n.x - n.y), 200.0f * (n.y - n.z)};
}
glm::vec3 rgb_from_ycxcz(const glm::vec3& c)
{
    const float y = (c.x + 16.0f) / 116.0f;
    return kRgbFromXyz * (glm::vec3(y + c.y / 500.0f, y, y - c.z / 200.0f) * kWhite);
}

// CIELAB with the Hunt effect: a and b scaled by 0.01 L.
glm::vec3 hunt_lab(const glm::vec3& rgb)
{
    constexpr float delta = 6.0f / 29.0f;
    const auto f = [](float t) {
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
    };
    const glm::vec3 n = kXyzFromRgb * rgb / kWhite;
    const float x = f(n.x), y = f(n.y), z = f(n.z), l = 116.0f * y - 16.0f;
    return {l, 0.01f * l * 500.0f * (x - y), 0.01f * l * 200.0f * (y - z)};
}
float hyab(const glm::vec3& a, const glm::vec3& b)
{
    const glm::vec3 d = a - b;
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

// 1D correlation along x or y, with the border repeated.
template <typename T>
std::vector<T> filter(const std::vector<T>& in, int width, int height, const std::vector<float>& kernel, bool along_x)
{
    const int radius = int(kernel.size()) / 2;
    std::vector<T> out(in.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            T sum(0.0f);
            for (int k = -radius; k <= radius; ++k) {
                const int sx = along_x ? std::clamp(x + k, 0, width - 1) : x;
                const int sy = along_x ? y : std::clamp(y + k, 0, height - 1);
                sum += kernel[k + radius] * in[std::size_t(sy) * width + sx];
            }
            out[std::size_t(y) * width + x] = sum;
        }
    return out;
}

std::vector<float> gaussian(float sigma, int radius)
{
    std::vector<float> kernel;
    float sum = 0.0f;
    for (int i = -radius; i <= radius; ++i)
        sum += kernel.emplace_back(std::exp(-float(i * i) / (2.0f * sigma * sigma)));
    for (float& k : kernel) k /= sum;
    return kernel;
}

// Contrast sensitivity functions in the spatial domain (2020 paper, eq. 3 and table 1): sums of Gaussians
// a sqrt(pi/b) exp(-(pi x)^2 / b) with x in degrees. Each term is filtered by itself, because a Gaussian is separable.
struct CsfTerm {
    float a, b;
};
Plane filter_csf(const Plane& in, int width, int height, const std::vector<CsfTerm>& terms)
{
    constexpr float widest = 0.04f;
    const int radius = int(std::ceil(3.0f * std::sqrt(widest / (2.0f * kPi * kPi)) * kPixelsPerDegree));
    Plane out(in.size(), 0.0f);
    // Weight of a 2D term before it is normalized: a sqrt(pi/b) * (sum of its 1D kernel)^2.
    std::vector<float> weights;
    float total = 0.0f;
    for (const CsfTerm& t : terms) {
        float sum = 0.0f;
        for (int i = -radius; i <= radius; ++i) {
            const float x = float(i) / kPixelsPerDegree;
            sum += std::exp(-kPi * kPi * x * x / t.b);
        }
        total += weights.emplace_back(t.a * std::sqrt(kPi / t.b) * sum * sum);
    }
    for (std::size_t t = 0; t < terms.size(); ++t) {
        const float sigma = std::sqrt(terms[t].b / (2.0f * kPi * kPi)) * kPixelsPerDegree;
        const auto kernel = gaussian(sigma, radius);
        const Plane once = filter(filter(in, width, height, kernel, true), width, height, kernel, false);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += weights[t] / total * once[i];
    }
    return out;
}

// What the eye resolves: filtered in YCxCz, back to RGB in 0..1, then Hunt-adjusted Lab.
Colors perceived(const Colors& ycxcz, int width, int height)
{
    Plane planes[3];
    for (int c = 0; c < 3; ++c) {
        planes[c].reserve(ycxcz.size());
        for (const glm::vec3& v : ycxcz) planes[c].push_back(v[c]);
    }
    planes[0] = filter_csf(planes[0], width, height, {{1.0f, 0.0047f}});
    planes[1] = filter_csf(planes[1], width, height, {{1.0f, 0.0053f}});
    planes[2] = filter_csf(planes[2], width, height, {{34.1f, 0.04f}, {13.5f, 0.025f}});
    Colors lab(ycxcz.size());
    for (std::size_t i = 0; i < lab.size(); ++i)
        lab[i] = hunt_lab(glm::clamp(rgb_from_ycxcz({planes[0][i], planes[1][i], planes[2][i]}), 0.0f, 1.0f));
    return lab;
}

// Strength of edges and points in the achromatic channel (2020 paper, section 4.2): first and second derivatives of a
// Gaussian, positive weights normalized to 1 and negative ones to -1.
struct Features {
    Plane edges, points;
};
Features features(const Colors& ycxcz, int width, int height)
{
    const float sigma = 0.5f * kFeatureWidthDegrees * kPixelsPerDegree;
    const int radius = int(std::ceil(3.0f * sigma));
    const auto smooth = gaussian(sigma, radius);
    std::vector<float> first, second;
    for (int i = -radius; i <= radius; ++i) {
        first.push_back(-float(i) * smooth[i + radius]);
        second.push_back((float(i * i) / (sigma * sigma) - 1.0f) * smooth[i + radius]);
    }
    for (auto* kernel : {&first, &second}) {
        float positive = 0.0f, negative = 0.0f;
        for (const float k : *kernel) (k > 0.0f ? positive : negative) += std::abs(k);
        for (float& k : *kernel) k /= k > 0.0f ? positive : negative;
    }
    Plane y;
    y.reserve(ycxcz.size());
    for (const glm::vec3& v : ycxcz) y.push_back((v.x + 16.0f) / 116.0f);
    const auto magnitude = [&](const std::vector<float>& derivative) {
        const Plane dx = filter(filter(y, width, height, derivative, true), width, height, smooth, false);
        const Plane dy = filter(filter(y, width, height, smooth, true), width, height, derivative, false);
        Plane m(y.size());
        for (std::size_t i = 0; i < m.size(); ++i) m[i] = std::hypot(dx[i], dy[i]);
        return m;
    };
    return {magnitude(first), magnitude(second)};
}

std::vector<float> flip_of(const Colors& image, const Colors& reference, int width, int height)
{
    Colors a(image.size()), b(image.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] = ycxcz_from_rgb(glm::clamp(image[i], 0.0f, 1.0f));
        b[i] = ycxcz_from_rgb(glm::clamp(reference[i], 0.0f, 1.0f));
    }
    const Features fa = features(a, width, height), fb = features(b, width, height);
    a = perceived(a, width, height);
    b = perceived(b, width, height);
    const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColorExponent);
    const float cut = kColorCut * largest;
    std::vector<float> result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        float color = std::pow(hyab(a[i], b[i]), kColorExponent);
        color = color < cut ? kColorTarget / cut * color
                            : kColorTarget + (color - cut) / (largest - cut) * (1.0f - kColorTarget);
        const float feature = std::pow(
            std::max(std::abs(fa.edges[i] - fb.edges[i]), std::abs(fa.points[i] - fb.points[i])) / std::sqrt(2.0f),
            kFeatureExponent);
        result[i] = std::clamp(std::pow(color, 1.0f - feature), 0.0f, 1.0f);
    }
    return result;
}

// The tone curve of the 2021 paper (a fit to ACES by Narkowicz, with exposure 0.6):
// (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5).
constexpr float kToneK0 = 0.36f * 2.51f, kToneK1 = 0.6f * 0.03f, kToneK3 = 0.36f * 2.43f, kToneK4 = 0.6f * 0.59f,
                kToneK5 = 0.14f;

Colors tone_map(const ImageF& image, float exposure)
{
    Colors out;
    out.reserve(image.pixels.size());
    for (const glm::vec4& p : image.pixels) {
        const glm::vec3 x = glm::max(glm::vec3(p), 0.0f) * std::exp2(exposure);
        out.push_back((kToneK0 * x * x + kToneK1 * x) / (kToneK3 * x * x + kToneK4 * x + kToneK5));
    }
    return out;
}

}  // namespace

std::vector<float> ldr_flip(const ImageF& image, const ImageF& reference)
{
    const Colors a(image.pixels.begin(), image.pixels.end()), b(reference.pixels.begin(), reference.pixels.end());
    return flip_of(a, b, image.width, image.height);
}

std::vector<float> hdr_flip(const ImageF& image, const ImageF& reference)
{
    // Exposures from the one that brings the reference's maximum to 0.85 after the tone curve to the one that brings
    // its median there, about one stop apart (2021 paper, section 3.2).
    std::vector<float> luminance;
    luminance.reserve(reference.pixels.size());
    for (const glm::vec4& p : reference.pixels)
        luminance.push_back(glm::dot(glm::vec3(p), glm::vec3(0.2126729f, 0.7151522f, 0.0721750f)));
    std::sort(luminance.begin(), luminance.end());
    const std::size_t n = luminance.size();
    const float largest = luminance.back();
    const float median = std::max(0.5f * (luminance[(n - 1) / 2] + luminance[n / 2]), 1e-6f * largest);
    if (!(largest > 0.0f)) return ldr_flip(image, reference);
    constexpr float target = 0.85f;
    const float a = kToneK0 - target * kToneK3, b = kToneK1 - target * kToneK4, c = -target * kToneK5;
    const float at_target = (-b + std::sqrt(b * b - 4.0f * a * c)) / (2.0f * a);
    const float start = std::log2(at_target / largest), stop = std::log2(at_target / median);
    const int exposures = std::max(2, int(std::ceil(stop - start)));
    std::vector<float> result(n, 0.0f);
    for (int e = 0; e < exposures; ++e) {
        const float exposure = start + float(e) * (stop - start) / float(exposures - 1);
        const auto one = flip_of(tone_map(image, exposure), tone_map(reference, exposure), image.width, image.height);
        for (std::size_t i = 0; i < n; ++i) result[i] = std::max(result[i], one[i]);
    }
    return result;
}

double hdr_flip_mean(const ImageF& image, const ImageF& reference)
{
    const auto map = hdr_flip(image, reference);
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (reference.pixels[i].a <= 0.0f) continue;
        sum += map[i];
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

}  // namespace conebook
