#include "sheet_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include <stb/stb_easy_font.h>

#include "common/color_scales.glsl"

namespace conebook {

namespace {

constexpr int kZoom = 2;                          // pixels along a side of the font's squares
constexpr int kLine = 12 * kZoom;                 // height of a line of text, pixels
constexpr int kBarHeight = 18, kWidestBar = 480;  // pixels

ImageF white_picture(int width, int height)
{
    return {width, height, std::vector<glm::vec4>(std::size_t(width) * std::size_t(height), glm::vec4(1))};
}

int text_width(std::string text) { return kZoom * stb_easy_font_width(text.data()); }

void write_text(ImageF& picture, int x, int y, std::string text)
{
    if (!std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }))
        throw std::runtime_error("'" + text + "': only ASCII can be written");
    struct Vertex {
        float x, y, z;
        unsigned char color[4];
    };
    std::vector<Vertex> vertices(text.size() * 64);  // the font draws squares, on the mean 17 vertices a letter
    const int quads =
        stb_easy_font_print(0, 0, text.data(), nullptr, vertices.data(), int(vertices.size() * sizeof(Vertex)));
    for (int q = 0; q < quads; ++q) {
        const Vertex &low = vertices[std::size_t(4 * q)], &high = vertices[std::size_t(4 * q + 2)];
        for (int v = int(kZoom * low.y); v < int(kZoom * high.y); ++v)
            for (int u = int(kZoom * low.x); u < int(kZoom * high.x); ++u)
                if (x + u >= 0 && x + u < picture.width && y + v >= 0 && y + v < picture.height)
                    picture.at(x + u, y + v) = glm::vec4(0, 0, 0, 1);
    }
}

struct Tick {
    double at;  // along the bar, 0..1
    std::string number;
};

std::string short_number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::vector<Tick> ticks_of(const ScaleBar& bar)
{
    if (bar.colors == "counts") return {{0, "1"}, {0.25, "2"}, {0.5, "4"}, {0.75, "8"}, {1, "16"}};
    std::vector<Tick> ticks;
    const double first = bar.colors == "difference" ? -2.0 * double(bar.end) : 0.0;
    for (const double at : {0.0, 0.25, 0.5, 0.75, 1.0})
        ticks.push_back({at, short_number(first + at * (bar.colors == "difference" ? 4.0 : 1.0) * double(bar.end))});
    return ticks;
}

// In linear light, at the place 0..1 of the bar.
glm::vec3 color_at(const ScaleBar& bar, float at)
{
    if (bar.colors == "counts") return color_scales::count_color(std::exp2(4.0f * at));
    const glm::vec3 shown = bar.colors == "grey"   ? glm::vec3(at)
                            : bar.colors == "heat" ? color_scales::heat_color(at)
                                                   : color_scales::difference_color(4.0f * at - 2.0f);
    return {srgb_decode(shown.r), srgb_decode(shown.g), srgb_decode(shown.b)};
}

}  // namespace

float srgb_decode(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

ImageF labelled(const ImageF& picture, const std::string& text)
{
    if (text_width(text) > picture.width)
        throw std::runtime_error("'" + text + "' is wider than its picture of " + std::to_string(picture.width) +
                                 " pixels");
    ImageF all = white_picture(picture.width, picture.height + kLine);
    write_text(all, 0, kZoom, text);
    std::copy(picture.pixels.begin(), picture.pixels.end(), all.pixels.begin() + std::ptrdiff_t(kLine) * all.width);
    return all;
}

ImageF scale_bar(const ScaleBar& bar, int width)
{
    const int length = std::min(width, kWidestBar);
    ImageF all = white_picture(std::max(length, std::min(text_width(bar.unit), width)), kBarHeight + 2 * kLine);
    if (text_width(bar.unit) > width)
        throw std::runtime_error("'" + bar.unit + "' is wider than the sheet of " + std::to_string(width) + " pixels");
    for (int y = 0; y < kBarHeight; ++y)
        for (int x = 0; x < length; ++x) {
            const bool border = x == 0 || y == 0 || x == length - 1 || y == kBarHeight - 1;
            const float at = float(x) / float(length - 1);
            all.at(x, y) = glm::vec4(border ? glm::vec3(0) : color_at(bar, at), 1);
        }
    for (const Tick& tick : ticks_of(bar)) {
        const int middle = int(std::lround(tick.at * (length - 1))), wide = text_width(tick.number);
        write_text(all, std::clamp(middle - wide / 2, 0, length - wide), kBarHeight + kZoom, tick.number);
    }
    write_text(all, 0, kBarHeight + kLine + kZoom, bar.unit);
    return all;
}

}  // namespace conebook
