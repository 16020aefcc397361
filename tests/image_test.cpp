// Picture files: what is written is what is read, and broken files end in one clear error.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <tinyexr.h>

#include "exr_builder.hpp"
#include "image/image.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

namespace fs = std::filesystem;

ImageF noise(int width, int height)
{
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    ImageF image{width, height, {}};
    for (int i = 0; i < width * height; ++i) {
        const float scale = std::pow(10.0f, 6.0f * normal(random));
        image.pixels.emplace_back(scale * normal(random), normal(random), -scale, std::abs(normal(random)));
    }
    return image;
}

std::string error_of(const std::function<void()>& action)
{
    try {
        action();
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "";
}

void expect_one_line_naming(const std::string& message, const std::string& name)
{
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

std::vector<char> bytes_of(const fs::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
void write_bytes(const fs::path& file, const std::vector<char>& bytes)
{
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

// A file of chosen channels through tinyexr itself, so that our reader is not tested against our writer alone.
void write_channels(const fs::path& file, const std::vector<std::pair<std::string, int>>& channels, int width,
                    int height, const std::function<float(int channel, int pixel)>& value)
{
    std::vector<std::vector<std::uint32_t>> planes;
    std::vector<EXRChannelInfo> infos;
    std::vector<int> stored, given;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        planes.emplace_back();
        for (int i = 0; i < width * height; ++i) {
            const float v = value(int(c), i);
            std::uint32_t bits;
            std::memcpy(&bits, &v, 4);
            planes.back().push_back(channels[c].second == TINYEXR_PIXELTYPE_UINT ? std::uint32_t(v) : bits);
        }
        EXRChannelInfo info{};
        std::strncpy(info.name, channels[c].first.c_str(), sizeof(info.name) - 1);
        infos.push_back(info);
        stored.push_back(channels[c].second);
        given.push_back(channels[c].second == TINYEXR_PIXELTYPE_UINT ? TINYEXR_PIXELTYPE_UINT
                                                                     : TINYEXR_PIXELTYPE_FLOAT);
    }
    std::vector<unsigned char*> pointers;
    for (auto& p : planes) pointers.push_back(reinterpret_cast<unsigned char*>(p.data()));
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = int(channels.size());
    header.channels = infos.data();
    header.pixel_types = given.data();
    header.requested_pixel_types = stored.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIPS;
    EXRImage image;
    InitEXRImage(&image);
    image.num_channels = header.num_channels;
    image.images = pointers.data();
    image.width = width;
    image.height = height;
    const char* message = nullptr;
    ASSERT_EQ(SaveEXRImageToFile(&image, &header, file.c_str(), &message), TINYEXR_SUCCESS) << message;
}

TEST(Exr, EveryBitComesBack)
{
    const TemporaryFolder folder;
    for (const auto& [width, height] : {std::pair(1, 1), {37, 29}, {256, 3}}) {
        ImageF image = noise(width, height);
        image.pixels[0] = {std::numeric_limits<float>::max(), std::numeric_limits<float>::denorm_min(), -0.0f, 1e-30f};
        write_exr(folder / "a.exr", image);
        const ImageF back = read_exr(folder / "a.exr");
        ASSERT_EQ(back.width, width);
        ASSERT_EQ(back.height, height);
        EXPECT_EQ(back.pixels, image.pixels);
    }
}

TEST(Exr, RowZeroIsOnTop)
{
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", {1, 2, {{1, 0, 0, 1}, {2, 0, 0, 1}}});
    float* rgba = nullptr;
    int width = 0, height = 0;
    const char* message = nullptr;
    ASSERT_EQ(LoadEXR(&rgba, &width, &height, (folder / "a.exr").c_str(), &message), TINYEXR_SUCCESS);
    EXPECT_EQ(rgba[0], 1.0f);
    EXPECT_EQ(rgba[4], 2.0f);
    std::free(rgba);
}

TEST(Exr, HalfChannelsAndMissingAlphaAreRead)
{
    const TemporaryFolder folder;
    const auto value = [](int c, int i) { return float(c + 1) * 0.25f + float(i); };  // exact in half
    write_channels(folder / "half.exr",
                   {{"B", TINYEXR_PIXELTYPE_HALF},
                    {"G", TINYEXR_PIXELTYPE_HALF},
                    {"R", TINYEXR_PIXELTYPE_HALF},
                    {"Z", TINYEXR_PIXELTYPE_FLOAT}},
                   5, 4, value);
    const ImageF image = read_exr(folder / "half.exr");
    for (int i = 0; i < 20; ++i) EXPECT_EQ(image.pixels[i], glm::vec4(value(2, i), value(1, i), value(0, i), 1.0f));
}

// The same picture in whatever order and shape its pieces lie.
TEST(Exr, OrderAndShapeOfThePiecesDoNotChangeThePicture)
{
    const TemporaryFolder folder;
    const auto value = [](int c, int x, int y) { return 0.25f * float(1 + c + 4 * x + 100 * y); };  // exact in half
    for (const auto& [tile_w, tile_h] : {std::pair(0, 0), {16, 8}, {7, 5}, {64, 64}, {1, 1}})
        for (int line_order = 0; line_order < (tile_w > 0 ? 3 : 2); ++line_order)
            for (const bool half : {false, true})
                for (const int offset : {0, 9, -9}) {
                    test::ExrBuilder exr{23, 19, {{"A", half}, {"B"}, {"G", half}, {"R", half}, {"Z"}}, line_order};
                    exr.tile_w = tile_w;
                    exr.tile_h = tile_h;
                    exr.x0 = offset;
                    exr.y0 = -2 * offset;
                    const std::string bytes = exr.file(value);
                    write_bytes(folder / "a.exr", {bytes.begin(), bytes.end()});
                    const ImageF image = read_exr(folder / "a.exr");
                    ASSERT_EQ(image.width, 23);
                    ASSERT_EQ(image.height, 19);
                    for (int y = 0; y < 19; ++y)
                        for (int x = 0; x < 23; ++x)
                            ASSERT_EQ(image.at(x, y),
                                      glm::vec4(value(3, x, y), value(2, x, y), value(1, x, y), value(0, x, y)))
                                << tile_w << " " << line_order << half << offset;
                }
}

TEST(Exr, WhatWouldNotBeThePictureIsRefused)
{
    const TemporaryFolder folder;
    const auto refusal = [&](const test::ExrBuilder& exr) {
        const std::string bytes = exr.file([](int, int x, int y) { return float(x + y); });
        write_bytes(folder / "a.exr", {bytes.begin(), bytes.end()});
        return error_of([&] { read_exr(folder / "a.exr"); });
    };
    test::ExrBuilder crop{8, 8};
    crop.x0 = 3;
    crop.is_crop = true;
    expect_one_line_naming(refusal(crop), "a.exr: is a part of its picture");
    test::ExrBuilder chroma{8, 8, {{"B"}, {"G", false, 2}, {"R"}}};
    expect_one_line_naming(refusal(chroma), "a.exr: channel G does not have a value for every pixel");
    for (const int tile : {0, 3}) {
        test::ExrBuilder missing{8, 8};
        missing.tile_w = missing.tile_h = tile;
        EXPECT_EQ(refusal(missing), "");
        missing.left_out = 5;
        expect_one_line_naming(refusal(missing), "a.exr: broken OpenEXR data: a piece of the picture is missing");
        missing.repeated = -1;
        expect_one_line_naming(refusal(missing), "a.exr: broken OpenEXR data: a piece of the picture is missing");
    }
}

TEST(Exr, UnsuitableChannelsAreRefused)
{
    const TemporaryFolder folder;
    const auto value = [](int, int i) { return float(i); };
    write_channels(folder / "grey.exr", {{"Y", TINYEXR_PIXELTYPE_FLOAT}}, 4, 4, value);
    expect_one_line_naming(error_of([&] { read_exr(folder / "grey.exr"); }), "grey.exr: has no channel R");
    write_channels(folder / "uint.exr",
                   {{"B", TINYEXR_PIXELTYPE_UINT}, {"G", TINYEXR_PIXELTYPE_UINT}, {"R", TINYEXR_PIXELTYPE_UINT}}, 4, 4,
                   value);
    expect_one_line_naming(error_of([&] { read_exr(folder / "uint.exr"); }), "uint.exr: integer");
}

TEST(Exr, TruncatedFilesAreRefused)
{
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", noise(32, 32));
    const std::vector<char> bytes = bytes_of(folder / "a.exr");
    for (std::size_t n = 0; n < bytes.size(); n += n < 400 ? 7 : 501) {
        write_bytes(folder / "cut.exr", {bytes.begin(), bytes.begin() + std::ptrdiff_t(n)});
        expect_one_line_naming(error_of([&] { read_exr(folder / "cut.exr"); }), "cut.exr");
    }
}

TEST(Exr, HugeSizeInASmallFileIsRefused)
{
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", noise(8, 8));
    std::vector<char> bytes = bytes_of(folder / "a.exr");
    const std::string key = "dataWindow";
    const auto found = std::search(bytes.begin(), bytes.end(), key.begin(), key.end());
    ASSERT_NE(found, bytes.end());
    // name 0, "box2i" 0, size 4 bytes, then min x, min y, max x, max y.
    const std::size_t max_x = std::size_t(found - bytes.begin()) + 11 + 6 + 4 + 8;
    const std::int32_t huge = 15999;
    std::memcpy(&bytes[max_x], &huge, 4);
    std::memcpy(&bytes[max_x + 4], &huge, 4);
    write_bytes(folder / "huge.exr", bytes);
    expect_one_line_naming(error_of([&] { read_exr(folder / "huge.exr"); }), "huge.exr: is truncated");
}

TEST(Png, EveryByteComesBackAndBrokenFilesAreRefused)
{
    const TemporaryFolder folder;
    Image8 image{13, 7, {}};
    std::mt19937 random(3);
    for (int i = 0; i < 13 * 7 * 4; ++i) image.rgba.push_back(std::uint8_t(random()));
    write_png(folder / "a.png", image);
    const Image8 back = read_png(folder / "a.png");
    EXPECT_EQ(back.width, 13);
    EXPECT_EQ(back.height, 7);
    EXPECT_EQ(back.rgba, image.rgba);
    const std::vector<char> bytes = bytes_of(folder / "a.png");
    for (std::size_t n = 0; n + 20 < bytes.size(); n += 5) {
        write_bytes(folder / "cut.png", {bytes.begin(), bytes.begin() + std::ptrdiff_t(n)});
        expect_one_line_naming(error_of([&] { read_png(folder / "cut.png"); }), "cut.png");
    }
}

TEST(Files, FaultsNameTheFileAndLeaveNothingBehind)
{
    const TemporaryFolder folder;
    const ImageF image = noise(4, 4);
    expect_one_line_naming(error_of([&] { read_exr(folder / "none.exr"); }), "none.exr: no such file");
    expect_one_line_naming(error_of([&] { read_png(folder.path()); }), "is a folder");
    expect_one_line_naming(error_of([&] { write_exr(folder / "none" / "a.exr", image); }), "does not exist");
    fs::create_directory(folder / "dir.exr");
    expect_one_line_naming(error_of([&] { write_exr(folder / "dir.exr", image); }), "it is a folder");
    expect_one_line_naming(error_of([&] { write_exr(folder / "a.exr", {4, 5, image.pixels}); }), "a.exr");
    expect_one_line_naming(error_of([&] { write_png(folder / "a.png", {0, 0, {}}); }), "a.png");
    write_bytes(folder / "text.exr", {'h', 'e', 'l', 'l', 'o'});
    expect_one_line_naming(error_of([&] { read_exr(folder / "text.exr"); }), "text.exr: is not an OpenEXR file");
    expect_one_line_naming(error_of([&] { read_png(folder / "text.exr"); }), "text.exr: is not a PNG file");
    int left = 0;
    for (const auto& entry : fs::directory_iterator(folder.path()))
        left += entry.path().filename() != "dir.exr" && entry.path().filename() != "text.exr";
    EXPECT_EQ(left, 0);
}

// A failing write must not harm the file that was there before.
TEST(Files, AFailedWriteKeepsTheOldFile)
{
    const TemporaryFolder folder;
    const ImageF first = noise(4, 4);
    write_exr(folder / "a.exr", first);
    EXPECT_NE(error_of([&] { write_exr(folder / "a.exr", {0, 0, {}}); }), "");
    EXPECT_EQ(read_exr(folder / "a.exr").pixels, first.pixels);
}

}  // namespace
}  // namespace conebook
