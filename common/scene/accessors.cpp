#include <algorithm>
#include <cstring>

#include "scene/parts.hpp"

namespace conebook::gltf {
namespace {

std::size_t component_bytes(int type, const std::string& what)
{
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
    }
    fail(what + " has the component type " + std::to_string(type) + ", which glTF does not know");
}

int component_count(int type, const std::string& what)
{
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        case TINYGLTF_TYPE_MAT4:
            return 16;
    }
    fail(what + " is a matrix of 2 or 3 rows, which nothing in glTF needs");
}

template <class T>
T load(const std::uint8_t* bytes)
{
    T value;  // memcpy: nothing in a damaged file is aligned for sure
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

std::uint32_t load_unsigned(const std::uint8_t* bytes, std::size_t size)
{
    if (size == 1) return *bytes;
    return size == 2 ? load<std::uint16_t>(bytes) : load<std::uint32_t>(bytes);
}

// Conversion of normalised integers: glTF 2.0, 3.6.2.2 and 3.11.
double load_component(const std::uint8_t* bytes, int type, bool normalized)
{
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const double value = load<std::int8_t>(bytes);
            return normalized ? std::max(value / 127.0, -1.0) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return *bytes / (normalized ? 255.0 : 1.0);
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const double value = load<std::int16_t>(bytes);
            return normalized ? std::max(value / 32767.0, -1.0) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(bytes) / (normalized ? 65535.0 : 1.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<std::uint32_t>(bytes);
        default:
            return load<float>(bytes);
    }
}

// `count` elements of `element_bytes`, `stride` apart, must end inside the view. All sums fit 64 bits: every number
// comes from an int.
const std::uint8_t* checked_range(Bytes view, std::uint64_t offset, std::uint64_t stride, std::uint64_t count,
                                  std::uint64_t element_bytes, const std::string& what)
{
    const std::uint64_t end = count == 0 ? offset : offset + stride * (count - 1) + element_bytes;
    if (end > view.size) {
        fail(what + " claims " + std::to_string(count) + " elements up to byte " + std::to_string(end) +
             " of a bufferView of " + std::to_string(view.size) + " bytes");
    }
    return view.data + offset;
}

}  // namespace

Bytes view_bytes(const Document& document, int buffer_view, const std::string& what)
{
    const auto& view = document.model.bufferViews.at(static_cast<std::size_t>(buffer_view));
    const auto& data = document.model.buffers.at(static_cast<std::size_t>(view.buffer)).data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
        fail(what + " lies outside its buffer");
    }
    return {data.data() + view.byteOffset, view.byteLength};
}

AccessorReader::AccessorReader(const Document& document, int accessor, const std::string& what)
{
    const auto& source = document.model.accessors.at(static_cast<std::size_t>(accessor));
    const std::string name = what + " (accessors[" + std::to_string(accessor) + "])";
    count_ = source.count;
    components_ = component_count(source.type, name);
    component_type_ = source.componentType;
    normalized_ = source.normalized;
    element_bytes_ = component_bytes(component_type_, name) * static_cast<std::size_t>(components_);
    stride_ = element_bytes_;
    if (source.bufferView >= 0) {
        const auto& view = document.model.bufferViews.at(static_cast<std::size_t>(source.bufferView));
        if (view.byteStride != 0) stride_ = view.byteStride;
        if (stride_ < element_bytes_) fail(name + " has a byteStride below the size of its elements");
        data_ = checked_range(view_bytes(document, source.bufferView, name), source.byteOffset, stride_, count_,
                              element_bytes_, name);
    } else if (!source.sparse.isSparse) {
        fail(name + " has no data: neither a bufferView nor sparse values");
    } else if (count_ > max_elements_without_data) {
        fail(name + " has no bufferView and claims " + std::to_string(count_) + " elements; at most " +
             std::to_string(max_elements_without_data) + " are read as zeros");
    }
    if (!source.sparse.isSparse) return;

    const auto sparse_count = static_cast<std::size_t>(source.sparse.count);
    if (sparse_count > count_) fail(name + " has more sparse elements than elements");
    const int index_type = source.sparse.indices.componentType;
    const std::size_t index_bytes = component_bytes(index_type, name);
    if (index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        fail(name + " has sparse indices that are not unsigned integers");
    }
    const std::uint8_t* indices = checked_range(view_bytes(document, source.sparse.indices.bufferView, name),
                                                static_cast<std::uint64_t>(source.sparse.indices.byteOffset),
                                                index_bytes, sparse_count, index_bytes, name + ", sparse indices,");
    sparse_values_ = checked_range(view_bytes(document, source.sparse.values.bufferView, name),
                                   static_cast<std::uint64_t>(source.sparse.values.byteOffset), element_bytes_,
                                   sparse_count, element_bytes_, name + ", sparse values,");
    sparse_indices_.resize(sparse_count);
    for (std::size_t i = 0; i < sparse_count; ++i) {
        sparse_indices_[i] = load_unsigned(indices + i * index_bytes, index_bytes);
        if (sparse_indices_[i] >= count_) fail(name + " has a sparse index out of range");
        if (i > 0 && sparse_indices_[i] <= sparse_indices_[i - 1])
            fail(name + " has sparse indices that do not increase");
    }
}

bool AccessorReader::is_unsigned_integer() const
{
    return component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

const std::uint8_t* AccessorReader::address(std::size_t i) const
{
    const auto found = std::lower_bound(sparse_indices_.begin(), sparse_indices_.end(), i);
    if (found != sparse_indices_.end() && *found == i) {
        return sparse_values_ + static_cast<std::size_t>(found - sparse_indices_.begin()) * element_bytes_;
    }
    return data_ ? data_ + i * stride_ : nullptr;
}

glm::dvec4 AccessorReader::element(std::size_t i) const
{
    glm::dvec4 result(0.0);
    const std::uint8_t* bytes = address(i);
    if (!bytes) return result;
    const std::size_t step = element_bytes_ / static_cast<std::size_t>(components_);
    for (int c = 0; c < components_; ++c, bytes += step) {
        result[c] = load_component(bytes, component_type_, normalized_);
    }
    return result;
}

void AccessorReader::element(std::size_t i, float* out) const
{
    const std::uint8_t* bytes = address(i);
    const std::size_t step = element_bytes_ / static_cast<std::size_t>(components_);
    for (int c = 0; c < components_; ++c) {
        out[c] = bytes ? static_cast<float>(
                             load_component(bytes + static_cast<std::size_t>(c) * step, component_type_, normalized_))
                       : 0.0f;
    }
}

std::uint32_t AccessorReader::unsigned_element(std::size_t i) const
{
    const std::uint8_t* bytes = address(i);
    return bytes ? load_unsigned(bytes, element_bytes_) : 0;
}

std::uint32_t AccessorReader::largest_unsigned() const
{
    if (element_bytes_ == 1) return 0xff;
    return element_bytes_ == 2 ? 0xffff : 0xffffffff;
}

}  // namespace conebook::gltf
