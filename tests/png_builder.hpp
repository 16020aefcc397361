// PNG files written byte by byte after RFC 2083, with no compression: a reader's own library is not its only witness.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace conebook::test {

inline std::string big_endian(std::uint32_t value)
{
    return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
            static_cast<char>(value)};
}

// CRC-32 of RFC 2083, section 3.4.
inline std::uint32_t crc32(const std::string& bytes)
{
    std::uint32_t crc = 0xffffffffu;
    for (const char byte : bytes) {
        crc ^= static_cast<std::uint8_t>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
    }
    return ~crc;
}

// Adler-32 of RFC 1950, section 9.
inline std::uint32_t adler32(const std::string& bytes)
{
    std::uint32_t a = 1, b = 0;
    for (const char byte : bytes) {
        a = (a + static_cast<std::uint8_t>(byte)) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

inline std::string png_chunk(const std::string& type, const std::string& data)
{
    return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(crc32(type + data));
}

// zlib (RFC 1950) with one stored block (RFC 1951, 3.2.4) of fewer than 65536 bytes. `adler_error` is added to the sum.
inline std::string zlib_stored(const std::string& raw, std::uint32_t adler_error = 0)
{
    const auto size = static_cast<std::uint16_t>(raw.size());
    const auto little_endian = [](std::uint16_t value) {
        return std::string{static_cast<char>(value), static_cast<char>(value >> 8)};
    };
    return std::string("\x78\x01\x01", 3) + little_endian(size) + little_endian(static_cast<std::uint16_t>(~size)) +
           raw + big_endian(adler32(raw) + adler_error);
}

const std::string png_signature("\x89PNG\r\n\x1a\n", 8);

enum PngColor { grey = 0, rgb = 2, palette = 3, grey_alpha = 4, rgb_alpha = 6 };

struct PngBuilder {
    std::uint32_t width = 1, height = 1;
    int bit_depth = 8;
    PngColor color = rgb_alpha;
    bool interlaced = false;
    std::string between;  // chunks before the pixels: PLTE, tRNS, ...
    std::uint32_t adler_error = 0;

    std::string header() const
    {
        return png_signature + png_chunk("IHDR", big_endian(width) + big_endian(height) +
                                                     std::string{static_cast<char>(bit_depth), static_cast<char>(color),
                                                                 0, 0, static_cast<char>(interlaced ? 1 : 0)});
    }
    // The scan lines, each after its filter byte 0. `sample(x, y, channel)` has bit_depth bits.
    std::string scan_lines(const std::function<std::uint32_t(int x, int y, int channel)>& sample) const
    {
        struct Pass {
            int x, y, step_x, step_y;
        };
        // RFC 2083, section 2.6 (Adam7).
        const std::vector<Pass> passes = interlaced
                                             ? std::vector<Pass>{{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                                                 {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}
                                             : std::vector<Pass>{{0, 0, 1, 1}};
        constexpr std::array channels{1, 0, 3, 1, 2, 0, 4};
        std::string raw;
        for (const Pass& pass : passes) {
            if (pass.x >= int(width) || pass.y >= int(height)) continue;
            for (int y = pass.y; y < int(height); y += pass.step_y) {
                raw += '\0';
                std::uint32_t bits = 0;
                int bit_count = 0;
                for (int x = pass.x; x < int(width); x += pass.step_x)
                    for (int c = 0; c < channels[color]; ++c) {
                        bits = bits << bit_depth | sample(x, y, c);
                        for (bit_count += bit_depth; bit_count >= 8; bit_count -= 8)
                            raw += static_cast<char>(bits >> (bit_count - 8));
                    }
                if (bit_count > 0) raw += static_cast<char>(bits << (8 - bit_count));
            }
        }
        return raw;
    }
    std::string file(const std::function<std::uint32_t(int x, int y, int channel)>& sample) const
    {
        return header() + between + png_chunk("IDAT", zlib_stored(scan_lines(sample), adler_error)) +
               png_chunk("IEND", "");
    }
};

}  // namespace conebook::test
