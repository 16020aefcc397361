#include <algorithm>
#include <atomic>
#include <future>
#include <memory>

#include <stb/stb_image.h>

#include "scene/parts.hpp"

namespace conebook::gltf {
namespace {

struct Encoded {
    std::string what;                   // for errors
    std::vector<std::uint8_t> storage;  // of an image with a uri
    Bytes bytes;
    int width = 0, height = 0;
};

// glTF 2.0, 3.8.3: the first bytes decide, and only PNG and JPEG are allowed.
void check_format(Bytes bytes, const std::string& what)
{
    const auto starts_with = [&](std::initializer_list<int> magic) {
        return bytes.size >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.data);
    };
    if (starts_with({0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}) || starts_with({0xff, 0xd8, 0xff})) return;
    if (starts_with({0xab, 'K', 'T', 'X'})) fail(what + " is a KTX texture; only PNG and JPEG are supported");
    if (starts_with({'R', 'I', 'F', 'F'})) fail(what + " is a WebP image; only PNG and JPEG are supported");
    fail(what + " is neither PNG nor JPEG");
}

Encoded find_bytes(const Document& document, int source)
{
    const auto& image = document.model.images.at(static_cast<std::size_t>(source));
    Encoded result;
    result.what = "images[" + std::to_string(source) + "]" + (image.name.empty() ? "" : " '" + image.name + "'");
    if (image.bufferView >= 0) {
        result.bytes = view_bytes(document, image.bufferView, result.what);
    } else if (!image.uri.empty()) {
        result.storage = read_uri(document, image.uri, result.what);
        result.bytes = {result.storage.data(), result.storage.size()};
    } else {
        fail(result.what + " has neither a uri nor a bufferView");
    }
    check_format(result.bytes, result.what);
    int channels = 0;
    if (!stbi_info_from_memory(result.bytes.data, static_cast<int>(result.bytes.size), &result.width, &result.height,
                               &channels) ||
        result.width < 1 || result.height < 1) {
        const char* reason = stbi_failure_reason();
        fail(result.what + " is damaged: its header cannot be read" + (reason ? std::string(" (") + reason + ")" : ""));
    }
    const std::uint64_t pixels = static_cast<std::uint64_t>(result.width) * static_cast<std::uint64_t>(result.height);
    if (pixels > max_image_pixels || pixels > max_pixels_per_byte * result.bytes.size) {
        fail(result.what + " claims " + std::to_string(result.width) + "x" + std::to_string(result.height) +
             " pixels in " + std::to_string(result.bytes.size) + " bytes, which is not plausible");
    }
    return result;
}

std::vector<std::uint8_t> decode(const Encoded& encoded)
{
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(encoded.bytes.data, static_cast<int>(encoded.bytes.size), &width, &height, &channels, 4),
        stbi_image_free);
    if (!pixels) {
        const char* reason = stbi_failure_reason();
        fail(encoded.what + " is damaged: " + (reason ? reason : "it cannot be decoded"));
    }
    if (width != encoded.width || height != encoded.height) fail(encoded.what + " is damaged: its size is not clear");
    return {pixels.get(), pixels.get() + static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4};
}

}  // namespace

std::vector<Image> read_images(const Document& document, const std::vector<int>& image_sources)
{
    std::vector<Encoded> encoded;
    std::vector<Image> images;
    std::uint64_t pixels = 0;
    for (const int source : image_sources) {
        encoded.push_back(find_bytes(document, source));
        const auto& file_image = document.model.images.at(static_cast<std::size_t>(source));
        Image image;
        image.name = file_image.name.empty() && !file_image.uri.starts_with("data:") ? file_image.uri : file_image.name;
        image.width = encoded.back().width;
        image.height = encoded.back().height;
        images.push_back(std::move(image));
        pixels += static_cast<std::uint64_t>(encoded.back().width) * static_cast<std::uint64_t>(encoded.back().height);
        if (pixels > max_total_pixels) fail("the images have more than 512 Mpx together");
    }
    // Decoding is most of a textured scene's loading time; the images are independent.
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < images.size(); i = next++) images[i].rgba = decode(encoded[i]);
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
