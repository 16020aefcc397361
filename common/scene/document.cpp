#include "scene/document.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include <nlohmann/json.hpp>

namespace conebook::gltf {
namespace {

using nlohmann::json;

constexpr std::array supported_extensions = {
    "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_specular",
    "KHR_materials_unlit", "KHR_texture_transform",
};

bool is_supported(const std::string& extension)
{
    return std::find(supported_extensions.begin(), supported_extensions.end(), extension) != supported_extensions.end();
}

std::vector<std::uint8_t> read_file(const std::filesystem::path& file)
{
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) fail("no such file");
    if (!std::filesystem::is_regular_file(status)) fail("not a regular file");  // a fifo or device would never end
    const std::uint64_t size = std::filesystem::file_size(file, error);
    if (error) fail("cannot be read: " + error.message());
    if (size > max_file_bytes) fail("larger than 2 GiB");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail("cannot be opened");
    std::vector<std::uint8_t> bytes(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<std::uint64_t>(stream.gcount()) != size) fail("cannot be read to its end");
    return bytes;
}

std::uint32_t little_endian_u32(const std::uint8_t* bytes)
{
    return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

struct Container {
    std::string json_text;
    std::vector<std::uint8_t> binary;
    bool has_binary = false;
};

// GLB container, glTF 2.0, 4.4: 12 bytes of header, then chunks of (u32 length, u32 type, data).
Container split_glb(const std::vector<std::uint8_t>& file)
{
    if (file.size() < 20) fail("truncated: a .glb has at least 20 bytes, this one " + std::to_string(file.size()));
    const std::uint32_t version = little_endian_u32(&file[4]);
    if (version != 2) fail("glTF binary container version " + std::to_string(version) + " is not supported (only 2)");
    const std::uint64_t length = little_endian_u32(&file[8]);
    if (length > file.size()) {
        fail("truncated: the header says " + std::to_string(length) + " bytes, the file has " +
             std::to_string(file.size()));
    }
    Container result;
    bool first = true;
    for (std::uint64_t at = 12; at + 8 <= length;) {
        const std::uint64_t size = little_endian_u32(&file[at]);
        const std::uint32_t type = little_endian_u32(&file[at + 4]);
        at += 8;
        if (size > length - at) fail("truncated: a chunk of " + std::to_string(size) + " bytes does not fit");
        const auto begin = file.begin() + static_cast<std::ptrdiff_t>(at);
        const auto end = begin + static_cast<std::ptrdiff_t>(size);
        if (first && type != 0x4E4F534A) fail("the first chunk of the .glb is not JSON");
        if (first) {
            result.json_text.assign(begin, end);
        } else if (type == 0x004E4942 && !result.has_binary) {
            result.binary.assign(begin, end);
            result.has_binary = true;
        }
        first = false;
        at += (size + 3) & ~3ull;
    }
    if (first) fail("truncated: the .glb has no JSON chunk");
    return result;
}

Container split_container(const std::vector<std::uint8_t>& file)
{
    if (file.size() >= 4 && std::memcmp(file.data(), "glTF", 4) == 0) return split_glb(file);
    if (file.empty()) fail("the file is empty");
    Container result;
    result.json_text.assign(file.begin(), file.end());
    return result;
}

// tinygltf copies extensions and extras recursively: deep nesting would overflow its stack. (A limit in the callback of
// json::parse would do too, but that parser takes quadratic time.)
void check_depth(const std::string& text)
{
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > max_json_depth)
                fail("JSON nested more than " + std::to_string(max_json_depth) + " levels deep");
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
}

json parse_json(const std::string& text)
{
    check_depth(text);
    try {
        return json::parse(text);
    } catch (const json::exception& e) {
        fail(std::string("not valid JSON: ") + e.what());
    }
}

// "2.1" -> 2001; -1 when malformed.
int parse_version(const std::string& text)
{
    int major = 0, minor = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%3d.%3d%c", &major, &minor, &rest) != 2 || major < 0 || minor < 0) return -1;
    return major * 1000 + minor;
}

// root[key], or an empty array.
const json& elements(const json& root, const char* key)
{
    static const json none = json::array();
    const auto found = root.find(key);
    return found == root.end() ? none : *found;
}

// Before the rest is checked: another version has another structure.
void check_version(const json& root)
{
    if (!root.is_object()) fail("not a glTF file: its JSON is not an object");
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object()) fail("not a glTF file: asset is missing or not an object");
    for (const char* key : {"version", "minVersion"}) {
        if (asset->contains(key) && !asset->at(key).is_string()) fail(std::string("asset.") + key + " is not a string");
    }
    if (!asset->contains("version")) fail("asset.version is missing");
    const std::string version = asset->at("version").get<std::string>();
    if (asset->contains("minVersion")) {
        const std::string minimum = asset->at("minVersion").get<std::string>();
        if (parse_version(minimum) < 0) fail("asset.minVersion '" + minimum + "' is not a version");
        if (parse_version(minimum) > 2000) fail("needs glTF version " + minimum + "; supported is 2.0");
    }
    // A minor version above ours must still be readable (glTF 2.0, 3.2).
    if (parse_version(version) / 1000 != 2) fail("glTF version '" + version + "' is not supported (only 2.x)");
}

void check_extensions(const json& root, Warnings& warnings)
{
    std::string refused;
    for (const json& name : elements(root, "extensionsRequired")) {
        if (!is_supported(name)) refused += (refused.empty() ? "" : ", ") + name.get<std::string>();
    }
    if (!refused.empty()) fail("requires the extension " + refused + ", which is not supported");
    for (const json& name : elements(root, "extensionsUsed")) {
        if (!is_supported(name)) warn(warnings, "extension " + name.get<std::string>() + " is ignored");
    }
}

// The unsupported extension whose stream is all the data that buffer `i` stands for, or "". EXT_meshopt_compression and
// its successors mark a buffer that only a decoder can fill as a fallback, and need not give it bytes.
std::string extension_that_fills(const json& root, std::size_t i, bool has_binary)
{
    const json& buffer = root.at("buffers").at(i);
    if (buffer.contains("uri") || (i == 0 && has_binary) || !buffer.contains("extensions")) return "";
    for (const auto& [name, extension] : buffer.at("extensions").items()) {
        if (extension.is_object() && extension.value("fallback", json()) == true) return name;
    }
    return "";
}

// Optional compression without an uncompressed fallback: what it leaves out would silently read as zeros.
void check_compression(const json& root, bool has_binary)
{
    const auto refuse = [](const std::string& what, const std::string& extension) {
        fail(what + " is compressed by " + extension + ", which is not supported, and has no uncompressed data");
    };
    const auto check_view = [&](const json& owner, const std::string& what) {
        if (!owner.contains("bufferView")) return;
        const json& view = root.at("bufferViews").at(owner.at("bufferView").get<std::size_t>());
        const std::string extension = extension_that_fills(root, view.at("buffer").get<std::size_t>(), has_binary);
        if (!extension.empty()) refuse(what, extension);
    };
    const json& meshes = elements(root, "meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const json& primitives = meshes[m].at("primitives");
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const std::string where = "meshes[" + std::to_string(m) + "].primitives[" + std::to_string(p) + "].";
            json accessors = primitives[p].at("attributes");
            if (primitives[p].contains("indices")) accessors["indices"] = primitives[p].at("indices");
            for (const auto& [name, index] : accessors.items()) {
                const json& accessor = root.at("accessors").at(index.get<std::size_t>());
                check_view(accessor, where + name);
                if (accessor.contains("sparse")) {
                    check_view(accessor.at("sparse").at("indices"), where + name);
                    check_view(accessor.at("sparse").at("values"), where + name);
                }
                // An extension with a bufferView of its own (KHR_draco_mesh_compression) holds the indices and the
                // attributes that it lists. Sparse values may replace some of what they are, not all.
                if (accessor.contains("bufferView") || !primitives[p].contains("extensions")) continue;
                for (const auto& [extension, stream] : primitives[p].at("extensions").items()) {
                    if (!stream.is_object() || !stream.contains("bufferView")) continue;
                    const json listed = stream.value("attributes", json());
                    if (name == "indices" || !listed.is_object() || listed.contains(name))
                        refuse(where + name, extension);
                }
            }
        }
    }
}

std::string decode_percent(const std::string& uri)
{
    const auto hex = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        if (c >= 'A' && c <= 'F') return c - 'A' + 10;
        return -1;
    };
    std::string result;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
            result += static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2]));
            i += 2;
        } else {
            result += uri[i];
        }
    }
    return result;
}

std::vector<std::uint8_t> decode_base64(std::string_view text)
{
    std::array<int, 256> value;
    value.fill(-1);
    const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < digits.size(); ++i) value[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    std::vector<std::uint8_t> result;
    result.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        const int digit = value[static_cast<unsigned char>(c)];
        if (digit < 0) fail("its data: uri is not valid base64");
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            result.push_back(static_cast<std::uint8_t>(bits >> bit_count & 0xff));
        }
    }
    return result;
}

void read_buffers(const json& root, const Container& container, Document& document)
{
    std::uint64_t total = 0;
    const json& buffers = elements(root, "buffers");
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::string what = "buffers[" + std::to_string(i) + "]";
        const auto byte_length = buffers[i].at("byteLength").get<std::uint64_t>();
        tinygltf::Buffer buffer;
        if (buffers[i].contains("uri")) {
            buffer.uri = buffers[i].at("uri").get<std::string>();
            buffer.data = read_uri(document, buffer.uri, what);
        } else if (i == 0 && container.has_binary) {
            buffer.data = container.binary;
        } else if (!extension_that_fills(root, i, container.has_binary).empty()) {
            document.model.buffers.push_back(std::move(buffer));  // nothing that is read lies in it: check_compression
            continue;
        } else {
            fail(what + " has neither a uri nor a binary chunk in a .glb");
        }
        if (buffer.data.size() < byte_length) {
            fail(what + " says " + std::to_string(byte_length) + " bytes and has " +
                 std::to_string(buffer.data.size()));
        }
        buffer.data.resize(byte_length);
        total += byte_length;
        if (total > max_buffer_bytes) fail("the buffers are larger than 4 GiB");
        document.model.buffers.push_back(std::move(buffer));
    }
}

void list_images(const json& root, Document& document)
{
    for (const json& image : elements(root, "images")) {
        tinygltf::Image entry;
        entry.name = image.value("name", std::string());
        entry.uri = image.value("uri", std::string());
        entry.bufferView = image.value("bufferView", -1);
        document.model.images.push_back(std::move(entry));
    }
}

// A channel without a target node moves something that only an extension knows.
void list_animations(const json& root, Document& document)
{
    for (const json& source : elements(root, "animations")) {
        tinygltf::Animation animation;
        animation.name = source.value("name", std::string());
        for (const json& s : source.at("samplers")) {
            tinygltf::AnimationSampler sampler;
            sampler.input = s.at("input").get<int>();
            sampler.output = s.at("output").get<int>();
            sampler.interpolation = s.value("interpolation", std::string("LINEAR"));
            animation.samplers.push_back(std::move(sampler));
        }
        for (const json& c : source.at("channels")) {
            tinygltf::AnimationChannel channel;
            channel.sampler = c.at("sampler").get<int>();
            channel.target_node = c.at("target").value("node", -1);
            channel.target_path = c.at("target").at("path").get<std::string>();
            animation.channels.push_back(std::move(channel));
        }
        document.model.animations.push_back(std::move(animation));
    }
}

void list_skins(const json& root, Document& document)
{
    for (const json& source : elements(root, "skins")) {
        tinygltf::Skin skin;
        skin.name = source.value("name", std::string());
        skin.joints = source.at("joints").get<std::vector<int>>();
        skin.inverseBindMatrices = source.value("inverseBindMatrices", -1);
        skin.skeleton = source.value("skeleton", -1);
        document.model.skins.push_back(std::move(skin));
    }
}

}  // namespace

void warn(Warnings& warnings, const std::string& line)
{
    constexpr std::size_t most = 100;
    if (warnings.size() > most || std::find(warnings.begin(), warnings.end(), line) != warnings.end()) return;
    warnings.push_back(warnings.size() < most ? line : "there are more warnings, which are left out");
}

float to_float(double value, const std::string& what)
{
    if (!(std::abs(value) <= std::numeric_limits<float>::max())) fail(what + " is too large a number");
    return static_cast<float>(value);
}

std::vector<std::uint8_t> read_uri(const Document& document, const std::string& uri, const std::string& what)
{
    try {
        if (uri.starts_with("data:")) {
            const std::size_t comma = uri.find(',');
            if (comma == std::string::npos || !uri.substr(0, comma).ends_with(";base64")) {
                fail("its data: uri is not base64");
            }
            return decode_base64(std::string_view(uri).substr(comma + 1));
        }
        const std::string name = decode_percent(uri);
        if (name.empty()) fail("its uri is empty");
        if (name.find('\0') != std::string::npos) fail("its uri holds a null character");
        const std::filesystem::path path = name;
        // A scheme is letters before a colon; one letter would be a drive, which is an absolute path.
        if (path.is_absolute() || uri.find(':') < uri.find('/')) fail("'" + name + "' is not a relative path");
        try {
            return read_file(document.folder / path);
        } catch (const std::runtime_error& e) {
            fail("cannot read '" + name + "': " + e.what());
        }
    } catch (const std::runtime_error& e) {
        fail(what + ": " + e.what());
    }
}

Document read_document(const std::filesystem::path& file, Warnings& warnings)
{
    Document document;
    document.folder = file.parent_path();
    const Container container = split_container(read_file(file));
    json root = parse_json(container.json_text);
    check_version(root);
    check_gltf(root);
    check_extensions(root, warnings);
    check_compression(root, container.has_binary);

    // tinygltf gets what it is good at, the typed structs; not what it would read or decode unchecked.
    json slim = root;
    for (const char* key : {"buffers", "images", "animations", "skins", "extras"}) slim.erase(key);
    const std::string text = slim.dump();
    tinygltf::TinyGLTF reader;
    reader.SetStoreOriginalJSONForExtrasAndExtensions(true);
    std::string error, warning;
    if (!reader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                    static_cast<unsigned int>(text.size()), "") ||
        !error.empty()) {
        fail(error.empty() ? "not a valid glTF file" : error);
    }
    read_buffers(root, container, document);
    list_images(root, document);
    list_animations(root, document);
    list_skins(root, document);
    return document;
}

}  // namespace conebook::gltf
