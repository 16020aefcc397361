#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <stdexcept>
#include <string>

// jpeglib.h uses FILE and size_t without including what declares them.
#include <jerror.h>
#include <jpeglib.h>

#include "image/codecs.hpp"

namespace conebook {
namespace {

// Huffman codes have at least one bit, and every block of 8 x 8 pixels of the finest component has one for its DC
// coefficient (T.81, F.1.2.1 and G.1.2.1): 8 * 64 pixels in a byte at best.
constexpr std::uint64_t kMostPixelsPerByte = 512;

// A progressive file may run over the whole picture with every few bytes. Real ones have about ten scans; TurboJPEG's
// TJFLAG_LIMITSCANS stops at the same number.
constexpr int kMostScans = 500;

// libjpeg leaves a function by longjmp, which runs no destructors: the functions that set a jump hold nothing but
// numbers and pointers, and what owns memory lives in their callers.
struct Errors {
    jpeg_error_mgr base;  // the first member: libjpeg knows only this one
    std::jmp_buf jump;
    char text[JMSG_LENGTH_MAX];
    bool unsupported;  // sound, but of a kind that is not read
};

[[noreturn]] void on_error(j_common_ptr info)
{
    auto* errors = reinterpret_cast<Errors*>(info->err);
    errors->base.format_message(info, errors->text);
    const int code = errors->base.msg_code;
    errors->unsupported = code == JERR_BAD_PRECISION || code == JERR_SOF_UNSUPPORTED;
    std::longjmp(errors->jump, 1);
}

// Negative levels are warnings: libjpeg would go on with grey or made-up pixels.
void on_message(j_common_ptr info, int level)
{
    if (level < 0 && info->err->msg_code != JWRN_JFIF_MAJOR) on_error(info);
}

void say_nothing(j_common_ptr) {}

struct Decoder {
    Errors errors{};
    jpeg_decompress_struct info{};
    Decoder()
    {
        info.err = jpeg_std_error(&errors.base);
        errors.base.error_exit = on_error;
        errors.base.emit_message = on_message;
        errors.base.output_message = say_nothing;
    }
    ~Decoder() { jpeg_destroy_decompress(&info); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
};

class Reader {
public:
    explicit Reader(EncodedBytes bytes) : bytes_(bytes)
    {
        if (!read_header()) fail();
        if (info_.arith_code) {
            errors_.unsupported = true;
            std::snprintf(errors_.text, sizeof errors_.text, "arithmetic coding");
            fail();
        }
        if (std::uint64_t(info_.image_width) * info_.image_height > kMostPixelsPerByte * bytes.size()) {
            std::snprintf(errors_.text, sizeof errors_.text, "it claims %ux%u pixels in %zu bytes", info_.image_width,
                          info_.image_height, bytes.size());
            fail();
        }
    }

    PixelSize size() const { return {int(info_.image_width), int(info_.image_height)}; }

    Image8 pixels()
    {
        Image8 image{size().width, size().height, {}};
        image.rgba.resize(std::size_t(image.width) * std::size_t(image.height) * 4);
        if (!read_pixels(image.rgba.data())) fail();
        if (info_.out_color_space == JCS_CMYK) {
            for (std::size_t i = 0; i < image.rgba.size(); i += 4) to_rgb(&image.rgba[i]);
        }
        return image;
    }

private:
    [[noreturn]] void fail() const
    {
        const std::string kind = errors_.unsupported ? "is of an unsupported kind: " : "is damaged: ";
        throw std::runtime_error(kind + errors_.text);
    }

    bool read_header()
    {
        if (setjmp(errors_.jump)) return false;
        jpeg_create_decompress(&info_);
        jpeg_mem_src(&info_, bytes_.data(), static_cast<unsigned long>(bytes_.size()));
        jpeg_read_header(&info_, TRUE);
        return true;
    }

    bool read_pixels(std::uint8_t* rgba)
    {
        if (setjmp(errors_.jump)) return false;
        const bool inks = info_.jpeg_color_space == JCS_CMYK || info_.jpeg_color_space == JCS_YCCK;
        info_.out_color_space = inks ? JCS_CMYK : JCS_EXT_RGBA;
        info_.do_block_smoothing = FALSE;  // it guesses what scans have not brought yet
        if (!jpeg_has_multiple_scans(&info_)) {
            jpeg_start_decompress(&info_);
            read_rows(rgba);
        } else {
            info_.buffered_image = TRUE;
            jpeg_start_decompress(&info_);
            if (!read_scans()) return false;
            jpeg_start_output(&info_, info_.input_scan_number);
            read_rows(rgba);
            jpeg_finish_output(&info_);
        }
        jpeg_finish_decompress(&info_);
        return true;
    }

    void read_rows(std::uint8_t* rgba)
    {
        while (info_.output_scanline < info_.output_height) {
            JSAMPROW row = rgba + std::size_t(info_.output_scanline) * info_.output_width * 4;
            jpeg_read_scanlines(&info_, &row, 1);
        }
    }

    // Take in every scan. False when one is missing: libjpeg would leave its coefficients at zero without a word.
    bool read_scans()
    {
        unsigned components = scan_components();  // a bit each; the header ended with the first scan's
        for (int status = 0; status != JPEG_REACHED_EOI;) {
            status = jpeg_consume_input(&info_);
            if (status == JPEG_REACHED_SOS) components |= scan_components();
            if (info_.input_scan_number > kMostScans) {
                std::snprintf(errors_.text, sizeof errors_.text, "it has more than %d scans", kMostScans);
                return false;
            }
        }
        bool complete = components == (1u << info_.num_components) - 1;
        // coef_bits: the bits of a coefficient that are still to come, -1: none has come.
        for (int c = 0; info_.progressive_mode && c < info_.num_components; ++c)
            complete = complete && std::all_of(info_.coef_bits[c], info_.coef_bits[c] + DCTSIZE2,
                                               [](int bits) { return bits == 0; });
        if (!complete) std::snprintf(errors_.text, sizeof errors_.text, "scans are missing");
        return complete;
    }

    unsigned scan_components() const
    {
        unsigned bits = 0;
        for (int i = 0; i < info_.comps_in_scan; ++i) bits |= 1u << info_.cur_comp_info[i]->component_index;
        return bits;
    }

    // C M Y K to R G B A in place: inks on white filter it. Adobe's programs, and all that follow them, store how much
    // is left of the light, not how much ink there is.
    void to_rgb(std::uint8_t* pixel) const
    {
        const auto left = [&](int c) { return info_.saw_Adobe_marker ? int(pixel[c]) : 255 - pixel[c]; };
        const int black = left(3);
        for (int c = 0; c < 3; ++c) pixel[c] = std::uint8_t((left(c) * black + 127) / 255);
        pixel[3] = 255;
    }

    EncodedBytes bytes_;
    Decoder decoder_;
    Errors& errors_ = decoder_.errors;
    jpeg_decompress_struct& info_ = decoder_.info;
};

}  // namespace

PixelSize size_of_jpeg(EncodedBytes bytes) { return Reader(bytes).size(); }

Image8 decode_jpeg(EncodedBytes bytes) { return Reader(bytes).pixels(); }

}  // namespace conebook
