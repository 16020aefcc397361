#include "image.hpp"

#include <algorithm>
#include <string_view>

namespace conebook::generator {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_big_endian(Bytes& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) {
        out.push_back(static_cast<std::uint8_t>(value >> shift));
    }
}

// CRC-32 of RFC 2083, section 3.4 (polynomial 0xEDB88320, reflected).
std::uint32_t crc32(const std::uint8_t* data, std::size_t size) {
    std::uint32_t crc = 0xFFFFFFFFu;
    for (std::size_t i = 0; i < size; ++i) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc >> 1) ^ ((crc & 1u) ? 0xEDB88320u : 0u);
        }
    }
    return ~crc;
}

// Adler-32 of RFC 1950, section 9.
std::uint32_t adler32(const Bytes& data) {
    std::uint32_t a = 1, b = 0;
    for (std::uint8_t byte : data) {
        a = (a + byte) % 65521u;
        b = (b + a) % 65521u;
    }
    return (b << 16) | a;
}

void put_chunk(Bytes& out, std::string_view type, const Bytes& data) {
    put_big_endian(out, static_cast<std::uint32_t>(data.size()));
    const std::size_t start = out.size();
    out.insert(out.end(), type.begin(), type.end());
    out.insert(out.end(), data.begin(), data.end());
    put_big_endian(out, crc32(out.data() + start, out.size() - start));
}

Bytes zlib_stored(const Bytes& data) {
    Bytes out = {0x78, 0x01};
    constexpr std::size_t longest_block = 65535;
    for (std::size_t begin = 0; begin < data.size(); begin += longest_block) {
        const std::size_t size = std::min(longest_block, data.size() - begin);
        const auto length = static_cast<std::uint16_t>(size), complement = static_cast<std::uint16_t>(~size);
        out.push_back(begin + size == data.size() ? 1 : 0);
        for (std::uint16_t word : {length, complement}) {
            out.push_back(static_cast<std::uint8_t>(word & 255));
            out.push_back(static_cast<std::uint8_t>(word >> 8));
        }
        out.insert(out.end(), data.begin() + static_cast<std::ptrdiff_t>(begin),
                   data.begin() + static_cast<std::ptrdiff_t>(begin + size));
    }
    put_big_endian(out, adler32(data));
    return out;
}

}  // namespace

Picture make_picture(int width, int height, int channels, const std::function<glm::ivec4(int, int)>& texel) {
    Picture picture{width, height, channels, {}};
    picture.texels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height * channels));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::ivec4 value = texel(x, y);
            for (int c = 0; c < channels; ++c) {
                picture.texels.push_back(static_cast<std::uint8_t>(std::clamp(value[c], 0, 255)));
            }
        }
    }
    return picture;
}

std::vector<std::uint8_t> encode_png(const Picture& picture) {
    Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    Bytes header;
    put_big_endian(header, static_cast<std::uint32_t>(picture.width));
    put_big_endian(header, static_cast<std::uint32_t>(picture.height));
    const std::uint8_t colour_type = picture.channels == 4 ? 6 : 2;
    header.insert(header.end(), {8, colour_type, 0, 0, 0});
    put_chunk(out, "IHDR", header);

    Bytes rows;
    const auto row_size = static_cast<std::ptrdiff_t>(picture.width) * picture.channels;
    for (int y = 0; y < picture.height; ++y) {
        rows.push_back(0);  // filter type: none
        rows.insert(rows.end(), picture.texels.begin() + y * row_size, picture.texels.begin() + (y + 1) * row_size);
    }
    put_chunk(out, "IDAT", zlib_stored(rows));
    put_chunk(out, "IEND", {});
    return out;
}

}  // namespace conebook::generator
