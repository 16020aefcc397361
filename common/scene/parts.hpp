// What the loader's files hand to each other. Private to common/scene.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "image/resample.hpp"
#include "scene/document.hpp"
#include "scene/scene.hpp"

namespace conebook::gltf {

// ---- accessors.cpp: random access to the elements of an accessor, sparse or not (glTF 2.0, 3.6.2) ----
class AccessorReader {
public:
    // Checks every range before anything is read. `what` names the use in errors.
    AccessorReader(const Document& document, int accessor, const std::string& what);

    std::size_t count() const { return count_; }
    int components() const { return components_; }  // 1..4 (matrices are refused)
    bool is_float() const { return component_type_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }
    bool is_unsigned_integer() const;
    // Element i with its integers normalised where the accessor says so; missing components are 0.
    glm::dvec4 element(std::size_t i) const;
    // Element i of an accessor of unsigned integer scalars.
    std::uint32_t unsigned_element(std::size_t i) const;
    // The value with which a strip would be restarted; glTF 2.0 forbids it as an index.
    std::uint32_t largest_unsigned() const;

private:
    const std::uint8_t* address(std::size_t i) const;

    std::size_t count_ = 0, stride_ = 0, element_bytes_ = 0;
    int components_ = 0, component_type_ = 0;
    bool normalized_ = false;
    const std::uint8_t* data_ = nullptr;  // null: zeros, except where sparse
    std::vector<std::uint32_t> sparse_indices_;
    const std::uint8_t* sparse_values_ = nullptr;
};

// The bytes of a bufferView. Throws when it does not lie inside its buffer.
struct Bytes {
    const std::uint8_t* data = nullptr;
    std::size_t size = 0;
};
Bytes view_bytes(const Document& document, int buffer_view, const std::string& what);

// ---- materials.cpp ----
struct MaterialReading {
    std::array<int, 2> uv_sets{0, 1};  // the file's TEXCOORD_n that become Vertex::uv0 and uv1
    bool blend = false;                // alphaMode BLEND: settled when textures and vertices are known
};
struct ImageSource {
    int image = 0;                          // of the file
    Encoding encoding = Encoding::linear;   // sRGB where any material takes colour from it
};
struct Materials {
    std::vector<Material> materials;
    std::vector<MaterialReading> readings;  // as many
    std::vector<ImageSource> images;        // of each Scene::images entry
};
Materials read_materials(const Document& document, Warnings& warnings);

// ---- images.cpp: decode PNG and JPEG, two at a time ----
std::vector<Image> read_images(const Document& document, const std::vector<ImageSource>& sources, Warnings& warnings);

// ---- primitives.cpp: one glTF primitive as a triangle list in mesh space, with only the vertices that it uses ----
struct LocalMesh {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    int material = 0;
};
// Empty when the primitive has no triangle (points, lines). `material` indexes `materials`.
LocalMesh read_primitive(const Document& document, int mesh, std::size_t primitive, int material,
                         const Materials& materials, Warnings& warnings);

// ---- geometry.cpp ----
// Give every triangle its own three vertices and its face normal (glTF 2.0, 3.7.2.1: "flat normals").
void make_flat_normals(LocalMesh& mesh);
// Normalise; a normal that is not finite or zero becomes the area-weighted mean of the faces around it.
// Counts those whose length is off 1 by over 2 % (quantised normals are within 1 %), and those that were replaced.
struct NormalRepair {
    std::size_t off_length = 0, replaced = 0;
};
NormalRepair repair_normals(std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices);
// Tangents along dP/du of the texture's transformed UV, averaged per vertex; a vertex at a mirrored seam is doubled.
void make_tangents(LocalMesh& mesh, const TextureSlot& texture);
// Where no normal map asks for more: any unit vector perpendicular to the normal (Duff et al. 2017, JCGT 6(1)).
glm::vec3 perpendicular(glm::vec3 normal);

// ---- nodes.cpp ----
struct Instance {
    int node = 0;
    glm::dmat4 world_from_node{1.0};
};
// The nodes of the default scene in depth-first order (of scene 0, or of all root nodes, when the file names none).
std::vector<Instance> walk_nodes(const Document& document);

// ---- camera.cpp ----
std::vector<Camera> read_cameras(const Document& document, const std::vector<Instance>& nodes, glm::dvec3 origin_ws,
                                 Warnings& warnings);
std::vector<Light> read_lights(const Document& document, const std::vector<Instance>& nodes, glm::dvec3 origin_ws,
                               Warnings& warnings);
// See scene.hpp, Scene::has_default_light.
Light default_light(const Scene& scene);

}  // namespace conebook::gltf
