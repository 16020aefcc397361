// How far a picture is from a reference. I: picture, R: reference; every mean runs over the red, green and blue of all
// pixels (or blocks) whose reference alpha is above 0, that is, that show geometry.
#pragma once

#include <optional>
#include <string>

#include "image/image.hpp"

namespace conebook {

struct ImageMetrics {
    std::size_t pixels = 0;       // compared, before blocks are made
    double mean_image = 0.0;      // mean I, radiance
    double mean_reference = 0.0;  // mean R
    double signed_ratio = 0.0;    // sum I / sum R: 1 is right, below 1 too dark
    double bias = 0.0;            // mean (I - R), radiance
    double rmse = 0.0;            // sqrt(mean (I - R)^2), radiance
    double nrmse = 0.0;           // rmse / mean R
    double rel_mse = 0.0;         // mean (I - R)^2 / (R^2 + e), Rousselle et al. 2011 sec. 6; e = 0.01 (mean R)^2
    double mape = 0.0;            // mean |I - R| / (|R| + 0.01 mean R)
    double smape = 0.0;           // mean |I - R| / (|I| + |R|), 0..1 (Armstrong 1985 has twice that); 0/0 counts as 0
    double relative_error_p95 = 0.0;  // 95th percentile of |I - R| / (|R| + 0.01 mean R), nearest rank
    std::optional<double> flip;       // HDR-FLIP mean, 0..1 (flip.hpp)

    // With the reference's standard error s (independent per pixel): mean s^2 is what noise adds to mean (I - R)^2.
    std::optional<double> noise_rms;           // sqrt(mean s^2), radiance
    std::optional<double> rmse_without_noise;  // sqrt(max(mean (I - R)^2 - mean s^2, 0))
    // What noise alone would make of smape if I were the truth: mean of E|s| / (|I| + |R|), with E|s| = sqrt(2 / pi) s for
    // a normal distribution. With an error of its own the picture's SMAPE holds less of it.
    std::optional<double> noise_smape;
    bool noisy_reference = false;  // noise_rms is above a tenth of rmse: more samples are needed
};

struct CompareOptions {
    const ImageF* reference_error = nullptr;  // standard error per channel and pixel, as `reference --error` writes
    int block = 1;                            // compare means over block x block pixels
    bool flip = true;                         // it takes longer than all the others together
};

// Throws std::runtime_error when sizes differ, nothing is left to compare, or a value is NaN or infinite.
ImageMetrics compare_images(const ImageF& image, const ImageF& reference, const CompareOptions& options = {});

// Signed relative error (I - R) / (I + R) of the channels' sums: black equal, red too bright, blue too dark, full
// colour at a factor of three; grey where there is nothing to compare.
Image8 error_heatmap(const ImageF& image, const ImageF& reference);

}  // namespace conebook
