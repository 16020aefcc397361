// Pictures on the CPU and in files. Row 0 is the top row, as in PNG and OpenEXR.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

namespace conebook {

// Scene-linear RGBA floats, width * height, row 0 on top.
struct ImageF {
    int width = 0, height = 0;
    std::vector<glm::vec4> pixels;
    glm::vec4& at(int x, int y) { return pixels[std::size_t(y) * width + x]; }
    const glm::vec4& at(int x, int y) const { return pixels[std::size_t(y) * width + x]; }
};

// Display-referred 8 bit RGBA, width * height * 4 bytes, row 0 on top.
struct Image8 {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

// All of these throw std::runtime_error with one line that names the file and the fault. Writers write to a file
// beside the target and rename it, so a failure leaves nothing half-written.
void write_exr(const std::filesystem::path& file, const ImageF& image);  // 32 bit float channels A B G R
void write_png(const std::filesystem::path& file, const Image8& image);
ImageF read_exr(const std::filesystem::path& file);
Image8 read_png(const std::filesystem::path& file);

}  // namespace conebook
