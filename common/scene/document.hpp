// A glTF file in memory: everything that is not yet geometry. Private to common/scene.
//
// tinygltf turns the JSON into typed structs. What it does not do is done around it: gltf_check.cpp checks type and
// range of every property before tinygltf sees it, and document.cpp reads the files, so that no buffer or image is
// touched whose size has not been checked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <tiny_gltf.h>
#include <nlohmann/json_fwd.hpp>

namespace conebook::gltf {

// Limits that no sane scene reaches; they keep a small malicious file from taking the machine's memory.
constexpr std::uint64_t max_file_bytes = 0x7fffffff;           // one file: the JSON, a .bin or an image
constexpr std::uint64_t max_buffer_bytes = 4ull << 30;         // all buffers together
constexpr std::uint64_t max_elements_without_data = 1u << 16;  // of a sparse accessor that has no bufferView
constexpr std::uint64_t max_triangles = 100'000'000;           // after instancing
constexpr std::uint64_t max_vertices = 50'000'000;             // after instancing
constexpr std::uint64_t max_image_pixels = 1u << 26;           // one image: 64 Mpx
constexpr std::uint64_t max_total_pixels = 1u << 29;           // all images: 2 GiB as RGBA
constexpr int max_image_side = 16384;                          // wider ones are shrunk: see images.cpp
constexpr std::uint64_t max_animation_values = 1u << 26;       // floats of all animations: 256 MiB
constexpr std::uint64_t max_morph_deltas = 1u << 24;           // vertices of all morph targets: 600 MiB
constexpr int max_json_depth = 64;

// m, the longest side of the scene's bounding box. In between, light does not depend on the scale (tested). Below, areas
// of triangles and products of edges leave the range of floats in the voxelizers and in Embree; above, in Embree.
constexpr double min_extent = 1e-6;
constexpr double max_extent = 1e9;

struct Document {
    tinygltf::Model model;         // model.buffers[i].data is filled; model.images hold only uri or bufferView
    std::filesystem::path folder;  // uris are relative to it
};

using Warnings = std::vector<std::string>;

// Throws std::runtime_error(fault); load_scene puts the file's name before it.
[[noreturn]] inline void fail(const std::string& fault) { throw std::runtime_error(fault); }

// Add a line unless it is there already. After a hundred lines the rest is summed up in one.
void warn(Warnings& warnings, const std::string& line);

// A double of the file as float. Throws when it does not fit.
float to_float(double value, const std::string& what);

// Read the file, check it, read its buffers. Adds to `warnings` every optional extension that is ignored.
Document read_document(const std::filesystem::path& file, Warnings& warnings);

// The bytes behind a glTF uri: base64 in a data: uri, or a file relative to the glTF file. No other schemes.
std::vector<std::uint8_t> read_uri(const Document& document, const std::string& uri, const std::string& what);

// Check the type, range and references of every property that the loader reads, and turn integers written as 3.0
// into integers. `root` must be an object. Throws with a path such as "accessors[3].count".
void check_gltf(nlohmann::json& root);

}  // namespace conebook::gltf
