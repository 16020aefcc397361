// PNG and JPEG: every kind that a texture may be is read as it stands, and no damaged file is taken for a picture.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <jpeglib.h>

#include "image/codecs.hpp"
#include "image/resample.hpp"
#include "png_builder.hpp"

namespace conebook::test {
namespace {

EncodedBytes bytes_of(const std::string& text)
{
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string fault_of(const std::function<void()>& action)
{
    try {
        action();
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "";
}

std::string png_fault(const std::string& file)
{
    return fault_of([&] { decode_png(bytes_of(file)); });
}

std::string jpeg_fault(const std::string& file)
{
    return fault_of([&] { decode_jpeg(bytes_of(file)); });
}

bool says_damaged(const std::string& fault) { return fault.starts_with("is damaged: ") && !fault.ends_with(": "); }

std::vector<std::uint8_t> texel(const Image8& image, int x, int y)
{
    const auto begin = image.rgba.begin() + 4 * (y * image.width + x);
    return {begin, begin + 4};
}

// Some value of `bit_depth` bits, different in neighbours and channels.
std::uint32_t sample(int x, int y, int channel, int bit_depth)
{
    return (std::uint32_t(x) * 40503u + std::uint32_t(y) * 30011u + std::uint32_t(channel) * 20011u) &
           ((1u << bit_depth) - 1);
}

TEST(Png, EveryKindOfPixelIsRead)
{
    struct Kind {
        PngColor color;
        std::vector<int> bit_depths;
    };
    for (const Kind& kind : {Kind{grey, {1, 2, 4, 8, 16}}, {rgb, {8, 16}}, {grey_alpha, {8, 16}}, {rgb_alpha, {8, 16}}})
        for (const int bits : kind.bit_depths)
            for (const bool interlaced : {false, true}) {
                const std::string what = "colour type " + std::to_string(kind.color) + ", " + std::to_string(bits) +
                                         " bits" + (interlaced ? ", interlaced" : "");
                const PngBuilder png{13, 11, bits, kind.color, interlaced, "", 0};
                const auto value = [&](int x, int y, int c) { return sample(x, y, c, bits); };
                const Image8 image = decode_png(bytes_of(png.file(value)));
                ASSERT_EQ(image.width, 13) << what;
                ASSERT_EQ(image.height, 11) << what;
                const bool is_grey = kind.color == grey || kind.color == grey_alpha;
                const bool has_alpha = kind.color == grey_alpha || kind.color == rgb_alpha;
                for (int y = 0; y < 11; ++y)
                    for (int x = 0; x < 13; ++x)
                        for (int c = 0; c < 4; ++c) {
                            const int channel = c < 3 ? (is_grey ? 0 : c) : (is_grey ? 1 : 3);
                            const double full = std::pow(2.0, bits) - 1.0;
                            const double right = c == 3 && !has_alpha ? 255.0 : 255.0 * value(x, y, channel) / full;
                            ASSERT_EQ(texel(image, x, y)[std::size_t(c)], std::lround(right)) << what;
                        }
            }
}

TEST(Png, PalettesAndTransparentColoursAreSpreadOut)
{
    PngBuilder png{5, 3, 4, palette, false, "", 0};
    png.between = png_chunk("PLTE", std::string("\1\2\3\x10\x20\x30\xff\xfe\xfd", 9)) + png_chunk("tRNS", "\x40\x80");
    Image8 image = decode_png(bytes_of(png.file([](int x, int y, int) { return std::uint32_t(x + y) % 3; })));
    EXPECT_EQ(texel(image, 0, 0), (std::vector<std::uint8_t>{1, 2, 3, 0x40}));
    EXPECT_EQ(texel(image, 1, 0), (std::vector<std::uint8_t>{0x10, 0x20, 0x30, 0x80}));
    EXPECT_EQ(texel(image, 1, 1), (std::vector<std::uint8_t>{0xff, 0xfe, 0xfd, 0xff}));

    // A colour that is transparent is compared before 16 bits become 8: a neighbour that rounds to it is not.
    png = {2, 1, 16, rgb, false, png_chunk("tRNS", std::string("\x12\x34\x12\x34\x12\x34", 6)), 0};
    image = decode_png(bytes_of(png.file([](int x, int, int) { return x == 0 ? 0x1234u : 0x1235u; })));
    EXPECT_EQ(texel(image, 0, 0), (std::vector<std::uint8_t>{0x12, 0x12, 0x12, 0}));
    EXPECT_EQ(texel(image, 1, 0), (std::vector<std::uint8_t>{0x12, 0x12, 0x12, 255}));
}

// glTF 2.0, 3.8.3: colour space information in images is ignored. Texts and unknown ancillary chunks do no harm either.
TEST(Png, GammaAndOtherAncillaryChunksChangeNothing)
{
    PngBuilder png{4, 4, 8, rgb, false, "", 0};
    const auto value = [](int x, int y, int c) { return sample(x, y, c, 8); };
    const Image8 plain = decode_png(bytes_of(png.file(value)));
    png.between = png_chunk("gAMA", big_endian(100000)) + png_chunk("iCCP", "not a profile") +
                  png_chunk("tEXt", "Comment") + png_chunk("abCd", "unknown");
    EXPECT_EQ(decode_png(bytes_of(png.file(value))).rgba, plain.rgba);
    EXPECT_EQ(decode_png(bytes_of(png.file(value) + "behind the end")).rgba, plain.rgba);
}

TEST(Png, WhatIsWrittenIsRead)
{
    Image8 image{37, 5, {}};
    for (int i = 0; i < 37 * 5 * 4; ++i) image.rgba.push_back(std::uint8_t(i * i));
    const Image8 back = decode_png(encode_png(image));
    EXPECT_EQ(back.width, 37);
    EXPECT_EQ(back.height, 5);
    EXPECT_EQ(back.rgba, image.rgba);
}

TEST(Png, EveryFlippedBitAndEveryCutIsFound)
{
    for (const bool interlaced : {false, true}) {
        const PngBuilder png{4, 4, 8, rgb, interlaced, png_chunk("tEXt", "Comment"), 0};
        const std::string file = png.file([](int x, int y, int c) { return sample(x, y, c, 8); });
        ASSERT_EQ(png_fault(file), "");
        for (std::size_t i = 0; i < file.size(); ++i)
            for (int bit = 0; bit < 8; ++bit) {
                std::string flipped = file;
                flipped[i] = char(flipped[i] ^ 1 << bit);
                ASSERT_TRUE(says_damaged(png_fault(flipped))) << "byte " << i << " bit " << bit << png_fault(flipped);
            }
        for (std::size_t n = 0; n < file.size(); ++n)
            ASSERT_TRUE(says_damaged(png_fault(file.substr(0, n)))) << n << " bytes " << png_fault(file.substr(0, n));
    }
}

// With right checksums around them, so that the fault itself is found.
TEST(Png, FaultsBehindARightChecksumAreFound)
{
    const auto value = [](int x, int y, int c) { return sample(x, y, c, 8); };
    PngBuilder png{4, 4, 8, rgb, false, "", 1};
    EXPECT_TRUE(says_damaged(png_fault(png.file(value)))) << "Adler-32 of the pixels";
    png.adler_error = 0;
    const std::string lines = png.scan_lines(value), end = png_chunk("IEND", "");
    const auto with_pixels = [&](const std::string& zlib) { return png.header() + png_chunk("IDAT", zlib) + end; };
    ASSERT_EQ(png_fault(with_pixels(zlib_stored(lines))), "");
    EXPECT_TRUE(says_damaged(png_fault(with_pixels(zlib_stored(lines.substr(0, lines.size() - 1)))))) << "a byte less";
    EXPECT_TRUE(says_damaged(png_fault(with_pixels(zlib_stored(lines).substr(0, 30))))) << "cut";
    EXPECT_TRUE(says_damaged(png_fault(with_pixels("")))) << "empty";
    EXPECT_TRUE(says_damaged(png_fault(png.header() + end))) << "no pixels";
    EXPECT_TRUE(says_damaged(png_fault(png.header() + png_chunk("IDAT", zlib_stored(lines))))) << "no end";
    std::string bad_filter = lines;
    bad_filter[0] = 7;
    EXPECT_TRUE(says_damaged(png_fault(with_pixels(zlib_stored(bad_filter))))) << "filter 7";
    png = {4, 4, 3, rgb, false, "", 0};
    EXPECT_TRUE(says_damaged(png_fault(png.file(value)))) << "3 bits";
    png = {0, 4, 8, rgb, false, "", 0};
    EXPECT_TRUE(says_damaged(png_fault(png.file(value)))) << "no width";
}

// Apple's variant: red and blue are swapped, alpha is multiplied in, and zlib's header and sum are left out.
TEST(Png, CgbiIsRefusedByName)
{
    const PngBuilder png{4, 4, 8, rgb_alpha, false, "", 0};
    std::string file = png.file([](int x, int y, int c) { return sample(x, y, c, 8); });
    file.insert(8, png_chunk("CgBI", std::string("\x50\0\x20\2", 4)));
    EXPECT_NE(png_fault(file).find("CgBI"), std::string::npos) << png_fault(file);
    EXPECT_TRUE(says_damaged(png_fault(file)));
}

TEST(Png, AClaimThatTheBytesCannotHoldIsRefusedFromTheHeader)
{
    for (const auto& [width, height] : {std::pair(30000u, 30000u), {0x7fffffffu, 1u}, {1u, 0x7fffffffu}}) {
        const PngBuilder png{width, height, 8, rgb_alpha, false, "", 0};
        const std::string file = png.header() + png_chunk("IDAT", zlib_stored("abc")) + png_chunk("IEND", "");
        const std::string fault = fault_of([&] { size_of_png(bytes_of(file)); });
        EXPECT_NE(fault.find("claims " + std::to_string(width) + "x"), std::string::npos) << fault;
    }
    // The best that deflate can do is no reason to refuse: 4000 x 4000 white pixels.
    EXPECT_EQ(size_of_png(encode_png({4000, 4000, std::vector<std::uint8_t>(64'000'000, 255)})).width, 4000);
}

// ---- JPEG: written by libjpeg's compressor, damaged by hand ----

struct JpegKind {
    J_COLOR_SPACE color = JCS_RGB;  // of `sample`: grey, RGB, CMYK
    bool progressive = false;
    bool scan_a_component = false;  // a sequential scan for every component
    int restart_interval = 0;       // MCUs
    bool subsampled = false;        // colour at half resolution
    int width = 40, height = 24;
};

// Smooth, so that compression changes it by little.
int jpeg_sample(int x, int y, int c)
{
    return 40 + 2 * x + (c == 1 ? 4 * y : c == 2 ? -2 * y : c == 3 ? y : 0) + 10 * c;
}

std::string jpeg(const JpegKind& kind)
{
    jpeg_compress_struct info{};
    jpeg_error_mgr errors;
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&info, &memory, &size);
    info.image_width = JDIMENSION(kind.width);
    info.image_height = JDIMENSION(kind.height);
    info.in_color_space = kind.color;
    info.input_components = kind.color == JCS_GRAYSCALE ? 1 : kind.color == JCS_CMYK ? 4 : 3;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 100, TRUE);
    for (int c = 0; c < info.num_components && !kind.subsampled; ++c)
        info.comp_info[c].h_samp_factor = info.comp_info[c].v_samp_factor = 1;
    jpeg_scan_info scans[3] = {{1, {0}, 0, 63, 0, 0}, {1, {1}, 0, 63, 0, 0}, {1, {2}, 0, 63, 0, 0}};
    if (kind.progressive) jpeg_simple_progression(&info);
    if (kind.scan_a_component) {
        info.scan_info = scans;
        info.num_scans = 3;
    }
    info.restart_interval = unsigned(kind.restart_interval);
    jpeg_start_compress(&info, TRUE);
    std::vector<std::uint8_t> row(std::size_t(kind.width) * std::size_t(info.input_components));
    for (int y = 0; y < kind.height; ++y) {
        for (int x = 0; x < kind.width; ++x)
            for (int c = 0; c < info.input_components; ++c)
                row[std::size_t(x * info.input_components + c)] = std::uint8_t(jpeg_sample(x, y, c));
        JSAMPROW rows = row.data();
        jpeg_write_scanlines(&info, &rows, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    const std::string file(reinterpret_cast<const char*>(memory), size);
    std::free(memory);
    return file;
}

const std::string end_of_image("\xff\xd9", 2);

// Where the markers SOS (start of scan) are.
std::vector<std::size_t> scan_starts(const std::string& file)
{
    std::vector<std::size_t> starts;
    for (std::size_t at = 2; at + 4 <= file.size();) {
        const auto byte = [&](std::size_t i) { return std::size_t(std::uint8_t(file[i])); };
        const std::size_t marker = byte(at + 1);
        if (byte(at) != 0xff || marker == 0 || marker == 0xff || (marker >= 0xd0 && marker <= 0xd9)) {
            ++at;  // within a scan's data
            continue;
        }
        if (marker == 0xda) starts.push_back(at);
        at += 2 + (byte(at + 2) << 8) + byte(at + 3);
    }
    return starts;
}

TEST(Jpeg, EveryKindOfPixelIsRead)
{
    for (const bool progressive : {false, true})
        for (const bool scan_a_component : {false, true})
            for (const int restart_interval : {0, 3})
                for (const bool subsampled : {false, true})
                    for (const J_COLOR_SPACE color : {JCS_GRAYSCALE, JCS_RGB, JCS_CMYK}) {
                        if (scan_a_component && (progressive || color != JCS_RGB)) continue;
                        if (subsampled && color != JCS_RGB) continue;
                        const std::string file =
                            jpeg({color, progressive, scan_a_component, restart_interval, subsampled});
                        ASSERT_EQ(size_of_jpeg(bytes_of(file)).width, 40);
                        const Image8 image = decode_jpeg(bytes_of(file));
                        ASSERT_EQ(image.width, 40);
                        ASSERT_EQ(image.height, 24);
                        double largest = 0.0;
                        for (int y = 0; y < 24; ++y)
                            for (int x = 0; x < 40; ++x)
                                for (int c = 0; c < 4; ++c) {
                                    double right = c == 3 ? 255 : jpeg_sample(x, y, color == JCS_GRAYSCALE ? 0 : c);
                                    // libjpeg writes Adobe's marker into CMYK: values are what is left of the light.
                                    if (color == JCS_CMYK && c < 3) right *= jpeg_sample(x, y, 3) / 255.0;
                                    const double error = texel(image, x, y)[std::size_t(c)] - right;
                                    largest = std::max(largest, std::abs(error));
                                }
                        // Quality 100 rounds coefficients to 1 and YCbCr to 8 bit: 2.2 at most as measured, 4.7 with
                        // colour at half resolution, where a row changes by 4.
                        EXPECT_LT(largest, subsampled ? 6.0 : 3.0) << color << progressive << scan_a_component;
                    }
}

TEST(Jpeg, CmykWithoutAdobesMarkerIsInk)
{
    std::string file = jpeg({JCS_CMYK});
    const std::size_t adobe = file.find("Adobe");
    ASSERT_NE(adobe, std::string::npos);
    file[adobe] = 'N';  // an APP14 of somebody else
    const Image8 image = decode_jpeg(bytes_of(file));
    for (int c = 0; c < 3; ++c) {
        const double right = (255.0 - jpeg_sample(20, 10, c)) * (255.0 - jpeg_sample(20, 10, 3)) / 255.0;
        EXPECT_NEAR(texel(image, 20, 10)[std::size_t(c)], right, 3.0);
    }
}

TEST(Jpeg, AFileThatEndsBeforeItsFirstScanIsDamaged)
{
    for (const bool progressive : {false, true}) {
        const std::string file = jpeg({JCS_RGB, progressive});
        EXPECT_TRUE(says_damaged(jpeg_fault(file.substr(0, scan_starts(file).at(0)) + end_of_image)));
        EXPECT_TRUE(says_damaged(jpeg_fault(file.substr(0, scan_starts(file).at(0)))));
        // The scan's header, and none of its data.
        EXPECT_TRUE(says_damaged(jpeg_fault(file.substr(0, scan_starts(file).at(0) + 14) + end_of_image)));
    }
}

TEST(Jpeg, EveryCutIsFound)
{
    for (const JpegKind& kind : {JpegKind{}, {JCS_GRAYSCALE}, {JCS_RGB, true}, {JCS_RGB, false, true}, {JCS_CMYK}}) {
        const std::string file = jpeg(kind);
        ASSERT_EQ(jpeg_fault(file), "");
        for (std::size_t n = 0; n < file.size(); ++n)
            ASSERT_TRUE(says_damaged(jpeg_fault(file.substr(0, n)))) << n << " of " << file.size() << " bytes";
    }
}

// Cut and ended properly: at a scan's border nothing but the missing scan tells.
TEST(Jpeg, MissingScansAreFound)
{
    for (const JpegKind& kind : {JpegKind{JCS_RGB, true}, {JCS_GRAYSCALE, true}, {JCS_RGB, false, true}}) {
        const std::string file = jpeg(kind);
        const std::vector<std::size_t> scans = scan_starts(file);
        ASSERT_GE(scans.size(), 3u);
        for (std::size_t i = 1; i < scans.size(); ++i) {
            // A scan's own Huffman table stands before it: where it begins does not matter, a table alone is no scan.
            const std::string fault = jpeg_fault(file.substr(0, scans[i]) + end_of_image);
            EXPECT_TRUE(says_damaged(fault)) << "scan " << i << " of " << scans.size() << ": " << fault;
        }
    }
    // Between two borders too, in a file of one scan: the rest of its blocks.
    const std::string file = jpeg({});
    for (std::size_t n = scan_starts(file).at(0) + 14; n + 2 < file.size(); n += 3)
        if (std::uint8_t(file[n - 1]) != 0xff) {
            EXPECT_TRUE(says_damaged(jpeg_fault(file.substr(0, n) + end_of_image))) << n;
        }
}

TEST(Jpeg, OtherDamageIsFound)
{
    const std::string file = jpeg({JCS_RGB, false, false, 3});
    std::string without_restart = file;
    const std::size_t restart = file.find("\xff\xd1");
    ASSERT_NE(restart, std::string::npos);
    without_restart.erase(restart, 2);
    EXPECT_TRUE(says_damaged(jpeg_fault(without_restart)));
    EXPECT_TRUE(says_damaged(jpeg_fault(std::string("\xff\xd8\xff", 3))));
    EXPECT_TRUE(says_damaged(jpeg_fault(std::string("\xff\xd8\xff\xd9", 4))));
}

TEST(Jpeg, UnsupportedKindsAreNamedAsSuch)
{
    std::string lossless = jpeg({});
    lossless[lossless.find("\xff\xc0") + 1] = '\xc3';
    EXPECT_TRUE(jpeg_fault(lossless).starts_with("is of an unsupported kind: ")) << jpeg_fault(lossless);
    std::string twelve_bits = jpeg({});
    twelve_bits[twelve_bits.find("\xff\xc0") + 4] = 12;
    EXPECT_TRUE(jpeg_fault(twelve_bits).starts_with("is of an unsupported kind: ")) << jpeg_fault(twelve_bits);
}

TEST(Jpeg, AClaimThatTheBytesCannotHoldIsRefusedFromTheHeader)
{
    std::string file = jpeg({});
    file.replace(file.find("\xff\xc0") + 5, 4, "\xff\xdc\xff\xdc");  // height and width 65500
    const std::string fault = fault_of([&] { size_of_jpeg(bytes_of(file)); });
    EXPECT_NE(fault.find("claims 65500x65500"), std::string::npos) << fault;
    // The least that libjpeg makes of a picture of one colour is no reason to refuse.
    EXPECT_EQ(jpeg_fault(jpeg({JCS_GRAYSCALE, true, false, 0, false, 2000, 2000})), "");
}

// ---- Shrinking ----

TEST(Shrink, IsTheMeanOverTheAreaInLinearLight)
{
    // 3 texels to 2: each takes one and a half.
    const Image8 image{3, 1, {0, 10, 100, 0, 255, 20, 100, 255, 255, 40, 200, 255}};
    const Image8 linear = shrink(image, 2, 1, Encoding::linear);
    EXPECT_EQ(texel(linear, 0, 0), (std::vector<std::uint8_t>{85, 13, 100, 85}));
    EXPECT_EQ(texel(linear, 1, 0), (std::vector<std::uint8_t>{255, 33, 167, 255}));
    // A third of white: 1.055 (1/3)^(1/2.4) - 0.055 = 0.6124; alpha stays linear.
    const Image8 srgb = shrink(image, 2, 1, Encoding::srgb);
    EXPECT_EQ(texel(srgb, 0, 0)[0], 156);
    EXPECT_EQ(texel(srgb, 0, 0)[2], 100);
    EXPECT_EQ(texel(srgb, 0, 0)[3], 85);
    // Down a column as along a row.
    const Image8 column = shrink({1, 3, image.rgba}, 1, 2, Encoding::srgb);
    EXPECT_EQ(column.rgba, srgb.rgba);
}

TEST(Shrink, KeepsTheMean)
{
    Image8 image{1000, 37, {}};
    double mean = 0.0;
    for (int i = 0; i < 1000 * 37 * 4; ++i) {
        image.rgba.push_back(std::uint8_t(sample(i % 4000, i / 4000, i % 4, 8)));
        mean += image.rgba.back() / (1000.0 * 37.0 * 4.0);
    }
    double shrunk = 0.0;
    const Image8 smaller = shrink(image, 613, 11, Encoding::linear);
    for (const std::uint8_t value : smaller.rgba) shrunk += value / (613.0 * 11.0 * 4.0);
    // Each value is rounded by up to 0.5, by 0.29 / sqrt(27000) in the mean.
    EXPECT_NEAR(shrunk, mean, 0.01);
}

}  // namespace
}  // namespace conebook::test
