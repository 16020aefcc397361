// Bytes of PNG and JPEG files to pixels and back: libpng and libjpeg-turbo, which check what they read.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "image/image.hpp"

namespace conebook {

using EncodedBytes = std::span<const std::uint8_t>;

enum class Codec { png, jpeg };

// By the first bytes; empty for anything else.
std::optional<Codec> codec_of(EncodedBytes bytes);

struct PixelSize {
    int width = 0, height = 0;
};

// What follows throws std::runtime_error with a fault that continues the image's name: "is damaged: CRC error".

// From the header alone. A size that so few bytes cannot hold, by what the format can pack at best, is damage, so that
// a small file makes no large allocation.
PixelSize size_of_png(EncodedBytes bytes);
PixelSize size_of_jpeg(EncodedBytes bytes);

// As RGBA of 8 bit, values as stored: no gamma or colour profile is applied (glTF 2.0, 3.8.3, asks for that). 16 bit are
// rounded to 8, palette and grey are spread out, CMYK becomes RGB as its inks filter white. All of the file must be
// sound: a checksum that is wrong, an end that is missing, a scan that is missing is damage.
Image8 decode_png(EncodedBytes bytes);
Image8 decode_jpeg(EncodedBytes bytes);

// The bytes of a file.
std::vector<std::uint8_t> encode_png(const Image8& image);

}  // namespace conebook
