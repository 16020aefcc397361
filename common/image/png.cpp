#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>

#include <png.h>

#include "image/codecs.hpp"

namespace conebook {
namespace {

constexpr unsigned char kSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

// Deflate packs at most 1032 : 1 (zlib's "Technical Details", "Maximum Compression Factor").
constexpr std::uint64_t kMostDeflated = 1032;

// libpng leaves a function by longjmp, which runs no destructors: the functions that set a jump hold nothing but
// numbers and pointers, and what owns memory lives in their callers.
struct Fault {
    char text[160] = "unknown reason";
};

void on_error(png_structp png, png_const_charp message)
{
    auto* fault = static_cast<Fault*>(png_get_error_ptr(png));
    std::snprintf(fault->text, sizeof fault->text, "%s", message);
    png_longjmp(png, 1);
}

// What could mean damage is made an error below; the rest is of no consequence for the pixels.
void on_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep out, std::size_t count)
{
    auto* rest = static_cast<EncodedBytes*>(png_get_io_ptr(png));
    if (count > rest->size()) png_error(png, "the file ends too early");
    std::memcpy(out, rest->data(), count);
    *rest = rest->subspan(count);
}

struct Decoder {
    Fault fault;
    png_structp png = nullptr;
    png_infop info = nullptr;
    Decoder()
    {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &fault, on_error, on_warning);
        info = png ? png_create_info_struct(png) : nullptr;
    }
    ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
};

class Reader {
public:
    explicit Reader(EncodedBytes bytes) : rest_(bytes), size_(bytes.size())
    {
        if (!info_) throw std::bad_alloc();
        // Apple's tools put a chunk CgBI first, swap red and blue, and leave out zlib's header.
        if (bytes.size() >= 16 && std::memcmp(bytes.data() + 12, "CgBI", 4) == 0)
            throw std::runtime_error("is damaged: it is CgBI, a PNG that only Apple's programs can read");
        if (!read_info()) fail();
        const std::uint64_t row_bits = std::uint64_t(png_get_image_width(png_, info_)) *
                                       png_get_bit_depth(png_, info_) * png_get_channels(png_, info_);
        if ((row_bits + 7) / 8 * png_get_image_height(png_, info_) > kMostDeflated * size_) {
            std::snprintf(decoder_.fault.text, sizeof decoder_.fault.text, "it claims %dx%d pixels in %zu bytes",
                          size().width, size().height, size_);
            fail();
        }
    }

    PixelSize size() const { return {int(png_get_image_width(png_, info_)), int(png_get_image_height(png_, info_))}; }

    Image8 pixels()
    {
        Image8 image{size().width, size().height, {}};
        image.rgba.resize(std::size_t(image.width) * std::size_t(image.height) * 4);
        if (!read_pixels(image.rgba.data(), std::size_t(image.width) * 4, image.height)) fail();
        return image;
    }

private:
    [[noreturn]] void fail() const { throw std::runtime_error(std::string("is damaged: ") + decoder_.fault.text); }

    bool read_info()
    {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_read_fn(png_, &rest_, read_bytes);
        png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
        png_set_benign_errors(png_, 0);  // too much or too little data, a wrong Adler sum
        // Nothing but size, palette, transparency and pixels is asked for: gamma, profiles and texts are skipped unread.
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);      // the callers limit the number of pixels
        png_set_option(png_, PNG_MAXIMUM_INFLATE_WINDOW, PNG_OPTION_ON);  // some writers declare too small a window
        png_read_info(png_, info_);
        return true;
    }

    bool read_pixels(std::uint8_t* rgba, std::size_t row_bytes, int height)
    {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_expand(png_);  // palette to RGB, 1 2 4 bit to 8, a transparent colour to alpha
        png_set_scale_16(png_);
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 0xff, PNG_FILLER_AFTER);
        const int passes = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        if (png_get_rowbytes(png_, info_) != row_bytes) png_error(png_, "its pixels are of an unknown kind");
        for (int pass = 0; pass < passes; ++pass)
            for (int y = 0; y < height; ++y) png_read_row(png_, rgba + std::size_t(y) * row_bytes, nullptr);
        png_read_end(png_, nullptr);
        return true;
    }

    EncodedBytes rest_;
    std::size_t size_;
    Decoder decoder_;
    png_structp png_ = decoder_.png;
    png_infop info_ = decoder_.info;
};

void append_bytes(png_structp png, png_bytep data, std::size_t count)
{
    auto* out = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
    out->insert(out->end(), data, data + count);
}

bool write_pixels(png_structp png, png_infop info, const Image8& image, std::vector<std::uint8_t>& out)
{
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &out, append_bytes, nullptr);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png, info, png_uint_32(image.width), png_uint_32(image.height), 8, PNG_COLOR_TYPE_RGB_ALPHA,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = 0; y < image.height; ++y)
        png_write_row(png, image.rgba.data() + std::size_t(y) * std::size_t(image.width) * 4);
    png_write_end(png, info);
    return true;
}

}  // namespace

std::optional<Codec> codec_of(EncodedBytes bytes)
{
    if (bytes.size() >= 8 && std::equal(kSignature, kSignature + 8, bytes.begin())) return Codec::png;
    if (bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff) return Codec::jpeg;
    return std::nullopt;
}

PixelSize size_of_png(EncodedBytes bytes) { return Reader(bytes).size(); }

Image8 decode_png(EncodedBytes bytes) { return Reader(bytes).pixels(); }

std::vector<std::uint8_t> encode_png(const Image8& image)
{
    std::vector<std::uint8_t> bytes;
    Fault fault;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &fault, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool good = info && write_pixels(png, info, image, bytes);
    png_destroy_write_struct(&png, &info);
    if (!good) throw std::runtime_error(std::string("a picture cannot be encoded as PNG: ") + fault.text);
    return bytes;
}

}  // namespace conebook
