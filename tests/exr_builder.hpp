// OpenEXR files written byte by byte after "OpenEXR File Layout", uncompressed, in every order that the layout allows.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace conebook::test {

struct ExrChannel {
    std::string name;
    bool half = false;  // else float
    int sampling = 1;   // 2: a value for every other column and row, as luminance-chroma files have; scan lines only
};

struct ExrBuilder {
    int width = 1, height = 1;
    std::vector<ExrChannel> channels{{"A"}, {"B"}, {"G"}, {"R"}};  // alphabetical, as the layout asks
    int line_order = 0;                                            // 0 increasing y, 1 decreasing y, 2 random y (tiles)
    int tile_w = 0, tile_h = 0;                                    // 0: scan lines
    int x0 = 0, y0 = 0;                                            // of the data window
    bool is_crop = false;                                          // the display window stays at 0, 0
    int left_out = -1, repeated = 0;                               // piece `left_out` claims to be piece `repeated`

    // `value(channel, x, y)`, x and y from 0 at the top left; half channels need what a half holds exactly.
    std::string file(const std::function<float(int, int, int)>& value) const
    {
        const bool tiled = tile_w > 0;
        std::string out("\x76\x2f\x31\x01", 4);
        out += i32(2 | (tiled ? 0x200 : 0));
        std::string list;
        for (const ExrChannel& c : channels)
            list += c.name + '\0' + i32(c.half ? 1 : 2) + i32(0) + i32(c.sampling) + i32(c.sampling);
        out += attribute("channels", "chlist", list + '\0');
        out += attribute("compression", "compression", std::string(1, '\0'));
        out += attribute("dataWindow", "box2i", box(x0, y0));
        out += attribute("displayWindow", "box2i", is_crop ? box(0, 0) : box(x0, y0));
        out += attribute("lineOrder", "lineOrder", std::string(1, char(line_order)));
        out += attribute("pixelAspectRatio", "float", i32(std::bit_cast<std::int32_t>(1.0f)));
        out += attribute("screenWindowCenter", "v2f", i32(0) + i32(0));
        out += attribute("screenWindowWidth", "float", i32(std::bit_cast<std::int32_t>(1.0f)));
        if (tiled) out += attribute("tiles", "tiledesc", i32(tile_w) + i32(tile_h) + '\0');
        out += '\0';

        const int w = tiled ? tile_w : width, h = tiled ? tile_h : 1;
        const int columns = (width + w - 1) / w, rows = (height + h - 1) / h, count = columns * rows;
        std::vector<std::string> pieces;  // by place: row by row
        for (int i = 0; i < count; ++i) {
            const int named = i == left_out ? repeated : i, x = i % columns * w, y = i / columns * h;
            std::string data;
            for (int line = y; line < std::min(y + h, height); ++line)
                for (std::size_t c = 0; c < channels.size(); ++c) {
                    if (line % channels[c].sampling != 0) continue;
                    for (int column = x; column < std::min(x + w, width); column += channels[c].sampling)
                        data += bytes_of(value(int(c), column, line), channels[c].half);
                }
            const std::string place =
                tiled ? i32(named % columns) + i32(named / columns) + i32(0) + i32(0) : i32(y0 + named);
            pieces.push_back(place + i32(std::int32_t(data.size())) + data);
        }
        // The table is by place; the pieces lie in the order that lineOrder promises.
        std::vector<std::uint64_t> table(pieces.size());
        std::string body;
        for (int k = 0; k < count; ++k) {
            const int row = line_order == 1 ? rows - 1 - k / columns : k / columns;
            const int i = line_order == 2 ? (k * 7 + 3) % count : row * columns + k % columns;
            table[std::size_t(i)] = out.size() + 8 * table.size() + body.size();
            body += pieces[std::size_t(i)];
        }
        out.append(reinterpret_cast<const char*>(table.data()), 8 * table.size());
        return out + body;
    }

private:
    static std::string i32(std::int32_t value) { return {reinterpret_cast<const char*>(&value), 4}; }
    static std::string attribute(const std::string& name, const std::string& type, const std::string& value)
    {
        return name + '\0' + type + '\0' + i32(std::int32_t(value.size())) + value;
    }
    std::string box(int x, int y) const { return i32(x) + i32(y) + i32(x + width - 1) + i32(y + height - 1); }
    // A half has 5 bits of exponent with bias 15 and 10 of mantissa; a float 8 with bias 127 and 23.
    static std::string bytes_of(float value, bool half)
    {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        if (!half) return i32(std::int32_t(bits));
        const auto small =
            std::uint16_t(value == 0.0f ? 0 : (bits >> 16 & 0x8000) | ((bits >> 13 & 0x3ffff) - (112 << 10)));
        return {reinterpret_cast<const char*>(&small), 2};
    }
};

}  // namespace conebook::test
