// sheet: several pictures side by side in one PNG, for the figures of the pages.
// Pictures are scaled by averaging linear light over each pixel's area, so a thumbnail is as bright as the original.
// A label says what each picture is, a colour bar what its colours stand for.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "sheet_text.hpp"

namespace {

using namespace conebook;

struct Options {
    std::vector<std::string> files;
    std::string output;
    int columns = 0;                  // 0: all in one row
    int width = 0;                    // pixels of each picture; 0: as it is
    int gap = 8;                      // pixels between pictures
    float exposure = 1.0f;            // factor on the radiance of .exr pictures
    std::vector<int> crop;            // x, y, width, height in pixels of the original; row 0 on top
    std::vector<std::string> labels;  // one a picture, or none
    ScaleBar bar;                     // without colours: none
};

// IEC 61966-2-1
float srgb_encode(float v) { return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

// As the programs do it with their default parameters (shaders/01_first_light/tone_map.frag): Reinhard et al. 2002,
// equation 4, on the luminance (ITU-R BT.709); an exposed luminance of `white` is shown as white.
glm::vec3 tone_map(glm::vec3 radiance)
{
    constexpr float white = 4.0f;
    const float luminance = glm::dot(radiance, glm::vec3(0.2126f, 0.7152f, 0.0722f));
    const float shown = (1 + luminance / (white * white)) / (1 + luminance);
    return glm::clamp(radiance * shown, 0.0f, 1.0f);
}

// A picture in display-referred linear light, 0..1. Radiance is tone mapped.
ImageF read_picture(const std::string& file, float exposure)
{
    if (std::filesystem::path(file).extension() == ".exr") {
        ImageF image = read_exr(file);
        for (auto& p : image.pixels) {
            p = glm::vec4(tone_map(glm::max(glm::vec3(p) * exposure, glm::vec3(0))), 1);
        }
        return image;
    }
    const Image8 stored = read_png(file);
    ImageF image{stored.width, stored.height, {}};
    image.pixels.resize(std::size_t(image.width) * image.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) image.pixels[i][c] = srgb_decode(stored.rgba[4 * i + c] / 255.0f);
        image.pixels[i].a = 1;
    }
    return image;
}

ImageF cut(const ImageF& image, const std::vector<int>& crop, const std::string& file)
{
    const int x0 = crop[0], y0 = crop[1], width = crop[2], height = crop[3];
    if (x0 < 0 || y0 < 0 || width < 1 || height < 1 || x0 + width > image.width || y0 + height > image.height) {
        throw std::runtime_error(file + ": the crop lies outside the picture of " + std::to_string(image.width) + "x" +
                                 std::to_string(image.height));
    }
    ImageF result{width, height, {}};
    for (int y = 0; y < height; ++y) {
        const auto* row = &image.at(x0, y0 + y);
        result.pixels.insert(result.pixels.end(), row, row + width);
    }
    return result;
}

// Along rows: each new pixel is the mean of what it covers. Enlarged pixels stay sharp squares.
ImageF scale_width(const ImageF& image, int width)
{
    ImageF result{width, image.height, {}};
    result.pixels.reserve(std::size_t(width) * image.height);
    const double ratio = double(image.width) / width;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (ratio <= 1) {
                result.pixels.push_back(image.at(int((x + 0.5) * ratio), y));
                continue;
            }
            const double begin = x * ratio, end = (x + 1) * ratio;
            const int last = std::min(int(std::ceil(end)), image.width);
            glm::vec4 sum(0);
            double weights = 0;
            for (int i = int(begin); i < last; ++i) {
                const double weight = std::min(i + 1.0, end) - std::max(double(i), begin);
                sum += float(weight) * image.at(i, y);
                weights += weight;
            }
            result.pixels.push_back(sum / float(weights));
        }
    }
    return result;
}

ImageF transpose(const ImageF& image)
{
    ImageF result{image.height, image.width, {}};
    result.pixels.resize(image.pixels.size());
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) result.at(y, x) = image.at(x, y);
    }
    return result;
}

ImageF scale(const ImageF& image, int width)
{
    const int height = std::max(1, int(std::lround(double(image.height) * width / image.width)));
    return transpose(scale_width(transpose(scale_width(image, width)), height));
}

// Row by row; each row is as high as its highest picture, each column as wide as its widest.
ImageF arrange(const std::vector<ImageF>& pictures, int columns, int gap)
{
    const int count = int(pictures.size());
    const int rows = (count + columns - 1) / columns;
    std::vector<int> x(columns + 1, 0), y(rows + 1, 0);
    for (int i = 0; i < count; ++i) {
        x[i % columns + 1] = std::max(x[i % columns + 1], pictures[i].width + gap);
        y[i / columns + 1] = std::max(y[i / columns + 1], pictures[i].height + gap);
    }
    for (int i = 0; i < columns; ++i) x[i + 1] += x[i];
    for (int i = 0; i < rows; ++i) y[i + 1] += y[i];
    ImageF sheet{x.back() - gap, y.back() - gap, {}};
    sheet.pixels.resize(std::size_t(sheet.width) * sheet.height, glm::vec4(1));  // white between the pictures
    for (int i = 0; i < count; ++i) {
        const ImageF& picture = pictures[i];
        for (int row = 0; row < picture.height; ++row) {
            std::copy_n(&picture.at(0, row), picture.width, &sheet.at(x[i % columns], y[i / columns] + row));
        }
    }
    return sheet;
}

void make_sheet(const Options& options)
{
    const int count = int(options.files.size());
    if (!options.labels.empty() && int(options.labels.size()) != count) {
        throw std::runtime_error(std::to_string(options.labels.size()) + " labels for " + std::to_string(count) +
                                 " pictures");
    }
    std::vector<ImageF> pictures;
    for (int i = 0; i < count; ++i) {
        const std::string& file = options.files[i];
        ImageF image = read_picture(file, options.exposure);
        if (!options.crop.empty()) image = cut(image, options.crop, file);
        if (options.width > 0 && options.width != image.width) image = scale(image, options.width);
        if (!options.labels.empty()) image = labelled(image, options.labels[i]);
        pictures.push_back(std::move(image));
    }
    const int columns = options.columns > 0 ? std::min(options.columns, count) : count;
    ImageF sheet = arrange(pictures, columns, options.gap);
    if (!options.bar.colors.empty()) sheet = arrange({sheet, scale_bar(options.bar, sheet.width)}, 1, options.gap);
    Image8 stored{sheet.width, sheet.height, {}};
    for (const auto& p : sheet.pixels) {
        for (int c = 0; c < 3; ++c) stored.rgba.push_back(std::uint8_t(std::lround(255 * srgb_encode(p[c]))));
        stored.rgba.push_back(255);
    }
    write_png(options.output, stored);
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app{"Several pictures in one PNG."};
    app.add_option("files", options.files, "pictures, .png or .exr (tone mapped)")->required();
    app.add_option("--output", options.output, "the .png to write")->required();
    app.add_option("--columns", options.columns, "pictures in a row; default all")->check(CLI::Range(1, 64));
    app.add_option("--width", options.width, "width of each picture in pixels; default as it is")
        ->check(CLI::Range(1, 8192));
    app.add_option("--gap", options.gap, "pixels between the pictures")->check(CLI::Range(0, 256));
    app.add_option("--exposure", options.exposure, "factor on the radiance of .exr pictures")
        ->check(CLI::PositiveNumber);
    app.add_option("--crop", options.crop, "X,Y,WIDTH,HEIGHT: only this part of each picture")
        ->delimiter(',')
        ->expected(4)
        ->allow_extra_args(false);
    app.add_option("--label", options.labels, "text above a picture; once for each picture, in their order")
        ->allow_extra_args(false)  // the next word is a picture
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--scale", options.bar.colors,
                   "colour bar below: grey or heat (0 to --scale-end), difference (full colour at --scale-end), counts "
                   "(1 to 16)")
        ->check(CLI::IsMember({"grey", "heat", "difference", "counts"}));
    app.add_option("--scale-end", options.bar.end, "the value at the bar's end; default 1")->check(CLI::PositiveNumber);
    app.add_option("--unit", options.bar.unit, "what the colour bar's numbers are");
    CLI11_PARSE(app, argc, argv);
    try {
        make_sheet(options);
    } catch (const std::exception& error) {
        std::cerr << "sheet: " << error.what() << '\n';
        return 1;
    }
}
