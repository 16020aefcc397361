#include "image/image.hpp"

#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <tuple>

#include <tinyexr.h>

#include "image/write_file.hpp"

#include "image/codecs.hpp"

namespace conebook {
namespace {

using Bytes = std::vector<unsigned char>;

// A picture of more pixels than this is a broken or hostile header, not a picture of this book.
constexpr std::int64_t kMaxPixels = std::int64_t(1) << 28;

std::runtime_error fault(const std::filesystem::path& file, const std::string& what)
{
    return std::runtime_error(file.string() + ": " + what);
}

Bytes read_bytes(const std::filesystem::path& file)
{
    std::error_code error;
    if (!std::filesystem::exists(file, error)) throw fault(file, "no such file");
    if (std::filesystem::is_directory(file, error)) throw fault(file, "is a folder, not a picture");
    std::ifstream in(file, std::ios::binary);
    if (!in) throw fault(file, "cannot be read");
    Bytes bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    if (bytes.empty()) throw fault(file, "is empty");
    return bytes;
}

void write_bytes(const std::filesystem::path& file, const unsigned char* data, std::size_t size)
{
    write_file(file, {reinterpret_cast<const char*>(data), size});
}

template <typename Picture>
void check_size(const std::filesystem::path& file, const Picture& image, std::size_t have, std::size_t per_pixel)
{
    if (image.width <= 0 || image.height <= 0)
        throw fault(file, "cannot be written: the picture is " + std::to_string(image.width) + "x" +
                              std::to_string(image.height));
    if (have != std::size_t(image.width) * image.height * per_pixel)
        throw fault(file, "cannot be written: the picture's size and its number of values differ");
}

std::string take_message(const char* message, const char* otherwise)
{
    if (!message) return otherwise;
    std::string text = message;
    FreeEXRErrorMessage(message);
    while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
    for (char& c : text)
        if (c == '\n') c = ' ';
    return text;
}

struct ExrHeaderOwner {
    EXRHeader value;
    ExrHeaderOwner() { InitEXRHeader(&value); }
    ~ExrHeaderOwner() { FreeEXRHeader(&value); }
    ExrHeaderOwner(const ExrHeaderOwner&) = delete;
    ExrHeaderOwner& operator=(const ExrHeaderOwner&) = delete;
};

struct ExrImageOwner {
    EXRImage value;
    ExrImageOwner() { InitEXRImage(&value); }
    ~ExrImageOwner() { FreeEXRImage(&value); }
    ExrImageOwner(const ExrImageOwner&) = delete;
    ExrImageOwner& operator=(const ExrImageOwner&) = delete;
};

// tinyexr leaves pixels uninitialised whose piece is missing: every piece of the full picture must be where the file's
// table says ("OpenEXR File Layout", "Line Offset Table" and "Tile Offset Table").
void check_pieces(const std::filesystem::path& file, const Bytes& bytes, const EXRHeader& header, std::int64_t width,
                  std::int64_t height)
{
    const auto read = [&](std::uint64_t at, auto value) {
        if (at > bytes.size() || bytes.size() - at < sizeof value) throw fault(file, "is truncated");
        std::memcpy(&value, &bytes[at], sizeof value);
        return value;
    };
    const std::int64_t lines = header.compression_type == TINYEXR_COMPRESSIONTYPE_PIZ   ? 32
                               : header.compression_type == TINYEXR_COMPRESSIONTYPE_ZIP ? 16
                                                                                        : 1;
    const std::int64_t piece_w = header.tiled ? header.tile_size_x : width;
    const std::int64_t piece_h = header.tiled ? header.tile_size_y : lines;
    if (piece_w < 1 || piece_h < 1) throw fault(file, "broken OpenEXR data: tiles without a size");
    const std::int64_t columns = (width + piece_w - 1) / piece_w, rows = (height + piece_h - 1) / piece_h;
    constexpr std::uint64_t kMagicAndVersion = 8;
    const std::uint64_t table = kMagicAndVersion + header.header_len;
    read(table + 8 * std::uint64_t(columns * rows - 1), std::uint64_t());  // before anything is allocated for it
    std::vector<bool> found(std::size_t(columns * rows));
    for (std::uint64_t i = 0; i < found.size(); ++i) {
        const auto at = read(table + 8 * i, std::uint64_t());
        // A tile starts with its column and row, a piece of scan lines with the first of them.
        std::int64_t column = 0, row = 0;
        if (header.tiled) {
            column = read(at, std::int32_t());
            row = read(at + 4, std::int32_t());
        } else {
            const std::int64_t line = std::int64_t(read(at, std::int32_t())) - header.data_window.min_y;
            row = line % lines == 0 ? line / lines : -1;
        }
        if (column < 0 || column >= columns || row < 0 || row >= rows || found[std::size_t(row * columns + column)])
            throw fault(file, "broken OpenEXR data: a piece of the picture is missing");
        found[std::size_t(row * columns + column)] = true;
    }
}

}  // namespace

void write_exr(const std::filesystem::path& file, const ImageF& image)
{
    check_size(file, image, image.pixels.size(), 1);
    // OpenEXR keeps channels in alphabetical order, each as a plane of its own.
    constexpr std::array<const char*, 4> names{"A", "B", "G", "R"};
    constexpr std::array<int, 4> component{3, 2, 1, 0};
    std::array<std::vector<float>, 4> planes;
    std::array<unsigned char*, 4> plane_pointers{};
    for (int c = 0; c < 4; ++c) {
        planes[c].resize(image.pixels.size());
        for (std::size_t i = 0; i < image.pixels.size(); ++i) planes[c][i] = image.pixels[i][component[c]];
        plane_pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
    }
    std::array<EXRChannelInfo, 4> channels{};
    std::array<int, 4> types{};
    types.fill(TINYEXR_PIXELTYPE_FLOAT);
    for (int c = 0; c < 4; ++c) std::strncpy(channels[c].name, names[c], sizeof(channels[c].name) - 1);

    // Both structs only point into the arrays above, which free themselves: no FreeEXR... here.
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = 4;
    header.channels = channels.data();
    header.pixel_types = types.data();
    header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    EXRImage exr;
    InitEXRImage(&exr);
    exr.num_channels = 4;
    exr.images = plane_pointers.data();
    exr.width = image.width;
    exr.height = image.height;

    unsigned char* memory = nullptr;
    const char* message = nullptr;
    const std::size_t size = SaveEXRImageToMemory(&exr, &header, &memory, &message);
    const std::unique_ptr<unsigned char, void (*)(void*)> owner(memory, std::free);
    if (size == 0) throw fault(file, "cannot be written: " + take_message(message, "OpenEXR encoding failed"));
    write_bytes(file, memory, size);
}

ImageF read_exr(const std::filesystem::path& file)
{
    const Bytes bytes = read_bytes(file);
    EXRVersion version;
    if (ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()) != TINYEXR_SUCCESS)
        throw fault(file, "is not an OpenEXR file");
    if (version.multipart || version.non_image)
        throw fault(file, "multi-part and deep OpenEXR files are not supported");
    ExrHeaderOwner header;
    const char* message = nullptr;
    if (ParseEXRHeaderFromMemory(&header.value, &version, bytes.data(), bytes.size(), &message) != TINYEXR_SUCCESS)
        throw fault(file, "its OpenEXR header cannot be read: " + take_message(message, "unknown reason"));
    const EXRBox2i &window = header.value.data_window, &display = header.value.display_window;
    const std::int64_t width = std::int64_t(window.max_x) - window.min_x + 1;
    const std::int64_t height = std::int64_t(window.max_y) - window.min_y + 1;
    if (width <= 0 || height <= 0 || width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels)
        throw fault(file, "impossible size " + std::to_string(width) + "x" + std::to_string(height));
    // zlib packs at most 1032:1 (zlib technical notes); a header that claims more would only cost memory.
    if (width * height > std::int64_t(bytes.size()) * 1100)
        throw fault(file, "is truncated: " + std::to_string(width) + "x" + std::to_string(height) + " pixels in " +
                              std::to_string(bytes.size()) + " bytes");
    if (std::tie(window.min_x, window.min_y, window.max_x, window.max_y) !=
        std::tie(display.min_x, display.min_y, display.max_x, display.max_y))
        throw fault(file, "is a part of its picture only: its data window is not its display window");

    std::array<int, 4> plane{-1, -1, -1, -1};
    for (int c = 0; c < header.value.num_channels; ++c) {
        const std::string name = header.value.channels[c].name;
        constexpr std::array<const char*, 4> names{"R", "G", "B", "A"};
        for (int k = 0; k < 4; ++k)
            if (name == names[k]) plane[k] = c;
    }
    for (int k = 0; k < 4; ++k) {
        if (plane[k] < 0) {
            if (k < 3) throw fault(file, std::string("has no channel ") + "RGBA"[k]);
            continue;
        }
        const EXRChannelInfo& channel = header.value.channels[plane[k]];
        if (channel.pixel_type == TINYEXR_PIXELTYPE_UINT)
            throw fault(file, "integer channels are not supported (half or float is)");
        if (channel.x_sampling != 1 || channel.y_sampling != 1)
            throw fault(file, std::string("channel ") + channel.name + " does not have a value for every pixel");
    }
    for (int c = 0; c < header.value.num_channels; ++c)
        if (header.value.pixel_types[c] == TINYEXR_PIXELTYPE_HALF)
            header.value.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;

    check_pieces(file, bytes, header.value, width, height);
    // lineOrder says in which order the pieces lie in the file. Each says itself where it belongs, and its rows run
    // downwards ("OpenEXR File Layout"); tinyexr would turn the picture over, and lose tiles.
    header.value.line_order = 0;
    ExrImageOwner exr;
    exr.value.num_channels = header.value.num_channels;  // else tinyexr loses the planes when it fails
    if (LoadEXRImageFromMemory(&exr.value, &header.value, bytes.data(), bytes.size(), &message) != TINYEXR_SUCCESS) {
        InitEXRImage(&exr.value);  // tinyexr 1.0.1 has freed its planes already when it fails, but keeps the pointers
        throw fault(file, "broken OpenEXR data: " + take_message(message, "unknown reason"));
    }
    ImageF image{int(width), int(height), std::vector<glm::vec4>(std::size_t(width * height), glm::vec4(0, 0, 0, 1))};
    const auto copy = [&](unsigned char** planes, int x0, int y0, int w, int h, int stride) {
        for (int k = 0; k < 4; ++k) {
            if (plane[k] < 0) continue;
            const float* values = reinterpret_cast<const float*>(planes[plane[k]]);
            for (int y = 0; y < h && y0 + y < image.height; ++y)
                for (int x = 0; x < w && x0 + x < image.width; ++x)
                    image.at(x0 + x, y0 + y)[k] = values[std::size_t(y) * stride + x];
        }
    };
    if (header.value.tiled) {
        const int tile_w = header.value.tile_size_x, tile_h = header.value.tile_size_y;
        for (int t = 0; t < exr.value.num_tiles; ++t) {
            const EXRTile& tile = exr.value.tiles[t];
            copy(tile.images, tile.offset_x * tile_w, tile.offset_y * tile_h, tile.width, tile.height, tile_w);
        }
    } else {
        copy(exr.value.images, 0, 0, image.width, image.height, image.width);
    }
    return image;
}

void write_png(const std::filesystem::path& file, const Image8& image)
{
    check_size(file, image, image.rgba.size(), 4);
    const Bytes bytes = encode_png(image);
    write_bytes(file, bytes.data(), bytes.size());
}

Image8 read_png(const std::filesystem::path& file)
{
    const Bytes bytes = read_bytes(file);
    if (codec_of(bytes) != Codec::png) throw fault(file, "is not a PNG file");
    try {
        const auto [width, height] = size_of_png(bytes);
        if (std::int64_t(width) * height > kMaxPixels)
            throw std::runtime_error("is too large: " + std::to_string(width) + "x" + std::to_string(height));
        return decode_png(bytes);
    } catch (const std::runtime_error& e) {
        throw fault(file, e.what());
    }
}

}  // namespace conebook
