// compare: every measure of the difference between a picture and its reference (compare_images.hpp).
#include <cmath>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "image/write_file.hpp"
#include "reference/compare_images.hpp"

using namespace conebook;

namespace {

// JSON has no infinity: a ratio against a black reference becomes null.
nlohmann::ordered_json number(double x)
{
    return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json();
}

int run(int argc, char** argv)
{
    std::string image_file, reference_file, json_file, heatmap_file, error_file;
    CompareOptions options;
    bool no_flip = false;
    CLI::App app{"Measures how far a picture is from its reference; both scene-linear .exr of the same size."};
    app.add_option("image", image_file, "picture, .exr")->required();
    app.add_option("reference", reference_file, "reference, .exr; pixels with alpha 0 are left out")->required();
    app.add_option("--json", json_file, "write the measures here");
    app.add_option("--heatmap", heatmap_file, ".png: red too bright, blue too dark, full at a factor of three");
    app.add_option("--reference-error", error_file, ".exr: standard error per pixel, as reference --error writes it");
    app.add_option("--block", options.block, "compare means over N x N pixels, default 1")->check(CLI::Range(1, 4096));
    app.add_flag("--no-flip", no_flip, "leave out HDR-FLIP, which takes longest");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& e) {
        return app.exit(e);
    } catch (const CLI::ParseError& e) {
        throw std::runtime_error(e.what());
    }
    options.flip = !no_flip;
    const ImageF image = read_exr(image_file), reference = read_exr(reference_file);
    ImageF error;
    if (!error_file.empty()) {
        error = read_exr(error_file);
        options.reference_error = &error;
    }
    ImageMetrics m;
    try {
        m = compare_images(image, reference, options);
    } catch (const std::exception& e) {
        throw std::runtime_error(image_file + " against " + reference_file + ": " + e.what());
    }

    nlohmann::ordered_json json{{"image", image_file},
                                {"reference", reference_file},
                                {"width", image.width},
                                {"height", image.height},
                                {"block", options.block},
                                {"pixels", m.pixels},
                                {"mean_image", number(m.mean_image)},
                                {"mean_reference", number(m.mean_reference)},
                                {"signed_ratio", number(m.signed_ratio)},
                                {"bias", number(m.bias)},
                                {"rmse", number(m.rmse)},
                                {"nrmse", number(m.nrmse)},
                                {"rel_mse", number(m.rel_mse)},
                                {"mape", number(m.mape)},
                                {"smape", number(m.smape)},
                                {"relative_error_p95", number(m.relative_error_p95)}};
    if (m.flip) json["hdr_flip"] = number(*m.flip);
    std::printf("signed ratio sum(I)/sum(R)   %.5f\n", m.signed_ratio);
    std::printf("bias mean(I - R)             %.5g   (mean I %.5g, mean R %.5g)\n", m.bias, m.mean_image,
                m.mean_reference);
    std::printf("RMSE                         %.5g   (%.5g of mean R)\n", m.rmse, m.nrmse);
    std::printf("relMSE                       %.5g\n", m.rel_mse);
    std::printf("MAPE                         %.5g\n", m.mape);
    std::printf("SMAPE |I-R|/(|I|+|R|), 0..1  %.5g\n", m.smape);
    std::printf("95th percentile of |I-R|/R   %.5g\n", m.relative_error_p95);
    if (m.flip) std::printf("HDR-FLIP, 0..1               %.5g\n", *m.flip);
    if (m.noise_rms) {
        json["noise_rms"] = number(*m.noise_rms);
        json["rmse_without_noise"] = number(*m.rmse_without_noise);
        json["noise_smape"] = number(*m.noise_smape);
        json["noisy_reference"] = m.noisy_reference;
        std::printf("RMSE without the reference's noise  %.5g   (noise %.5g; of SMAPE %.5g)\n", *m.rmse_without_noise,
                    *m.noise_rms, *m.noise_smape);
        if (m.noisy_reference)
            std::printf("the reference's noise is above a tenth of the error: render it with more samples\n");
    }
    if (!json_file.empty()) write_file(json_file, json.dump(2) + "\n");
    if (!heatmap_file.empty()) write_png(heatmap_file, error_heatmap(image, reference));
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    try {
        return run(argc, argv);
    } catch (const std::exception& e) {
        std::cerr << "compare: " << e.what() << "\n";
        return 1;
    }
}
