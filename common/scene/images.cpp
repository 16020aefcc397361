#include <algorithm>
#include <atomic>
#include <future>

#include "image/codecs.hpp"
#include "scene/parts.hpp"

namespace conebook::gltf {
namespace {

struct Encoded {
    std::string what;                   // for errors
    std::vector<std::uint8_t> storage;  // of an image with a uri
    EncodedBytes bytes;
    Codec codec = Codec::png;
    PixelSize size;
};

// The image's own name, or that of its file.
std::string name_of(const tinygltf::Image& image)
{
    return image.name.empty() && !image.uri.starts_with("data:") ? image.uri : image.name;
}

// glTF 2.0, 3.8.3: the first bytes decide, and only PNG and JPEG are allowed.
Codec find_codec(EncodedBytes bytes, const std::string& what)
{
    if (const auto codec = codec_of(bytes)) return *codec;
    const auto starts_with = [&](std::initializer_list<int> magic) {
        return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
    };
    if (starts_with({0xab, 'K', 'T', 'X'})) fail(what + " is a KTX texture; only PNG and JPEG are supported");
    if (starts_with({'R', 'I', 'F', 'F'})) fail(what + " is a WebP image; only PNG and JPEG are supported");
    fail(what + " is neither PNG nor JPEG");
}

Encoded find_bytes(const Document& document, int source)
{
    const auto& image = document.model.images.at(static_cast<std::size_t>(source));
    Encoded result;
    const std::string name = name_of(image);
    result.what = "images[" + std::to_string(source) + "]" + (name.empty() ? "" : " '" + name + "'");
    if (image.bufferView >= 0) {
        const Bytes view = view_bytes(document, image.bufferView, result.what);
        result.bytes = {view.data, view.size};
    } else if (!image.uri.empty()) {
        result.storage = read_uri(document, image.uri, result.what);
        result.bytes = result.storage;
    } else {
        fail(result.what + " has neither a uri nor a bufferView");
    }
    result.codec = find_codec(result.bytes, result.what);
    try {
        result.size = result.codec == Codec::png ? size_of_png(result.bytes) : size_of_jpeg(result.bytes);
    } catch (const std::runtime_error& e) {
        fail(result.what + " " + e.what());
    }
    return result;
}

std::vector<std::uint8_t> decode(const Encoded& encoded, PixelSize wanted, Encoding encoding)
{
    try {
        Image8 image = encoded.codec == Codec::png ? decode_png(encoded.bytes) : decode_jpeg(encoded.bytes);
        if (wanted.width != image.width || wanted.height != image.height)
            image = shrink(image, wanted.width, wanted.height, encoding);
        return std::move(image.rgba);
    } catch (const std::runtime_error& e) {
        fail(encoded.what + " " + e.what());
    }
}

}  // namespace

std::vector<Image> read_images(const Document& document, const std::vector<ImageSource>& sources, Warnings& warnings)
{
    std::vector<Encoded> encoded;
    std::vector<Image> images;
    std::uint64_t pixels = 0;
    for (const ImageSource& source : sources) {
        encoded.push_back(find_bytes(document, source.image));
        const auto [width, height] = encoded.back().size;
        const std::string& what = encoded.back().what;
        const std::string size = std::to_string(width) + "x" + std::to_string(height) + " pixels";
        const std::uint64_t count = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
        if (count > max_image_pixels) fail(what + " has " + size + ", more than 64 Mpx");
        pixels += count;
        if (pixels > max_total_pixels) fail("the images have more than 512 Mpx together");
        Image image;
        image.name = name_of(document.model.images.at(static_cast<std::size_t>(source.image)));
        // The least that OpenGL 4.5 promises for MAX_TEXTURE_SIZE. Shrunk here and not where
        // textures are made, so that the path tracer sees the same scene.
        image.width = std::min(width, max_image_side);
        image.height = std::min(height, max_image_side);
        if (image.width != width || image.height != height) {
            warn(warnings, what + " has " + size + " and is shrunk to " + std::to_string(image.width) + "x" +
                               std::to_string(image.height) + ": textures are at most 16384 wide and high");
        }
        images.push_back(std::move(image));
    }
    // Decoding is most of a textured scene's loading time; the images are independent.
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < images.size(); i = next++)
            images[i].rgba = decode(encoded[i], {images[i].width, images[i].height}, sources[i].encoding);
    };
    if (images.size() < 2) {
        work();
    } else {
        auto other = std::async(std::launch::async, work);
        std::exception_ptr error;
        try {
            work();
        } catch (...) {
            error = std::current_exception();
        }
        other.get();
        if (error) std::rethrow_exception(error);
    }
    return images;
}

}  // namespace conebook::gltf
