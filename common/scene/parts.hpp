// What the loader's files hand to each other. Private to common/scene.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "image/resample.hpp"
#include "scene/document.hpp"
#include "scene/pose.hpp"

namespace conebook::gltf {

// ---- accessors.cpp: random access to the elements of an accessor, sparse or not (glTF 2.0, 3.6.2) ----
class AccessorReader {
public:
    // Checks every range before anything is read. `what` names the use in errors.
    AccessorReader(const Document& document, int accessor, const std::string& what);

    std::size_t count() const { return count_; }
    int components() const { return components_; }  // 1..4, or 16: of matrices, only MAT4 is read
    bool is_float() const { return component_type_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }
    bool is_unsigned_integer() const;
    // Element i, of 4 components at most, with its integers normalised where the accessor says so; missing ones are 0.
    glm::dvec4 element(std::size_t i) const;
    // All components of element i, so normalised.
    void element(std::size_t i, float* out) const;
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
    int image = 0;                         // of the file
    Encoding encoding = Encoding::linear;  // sRGB where any material takes colour from it
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
    bool flat_normals = false;             // see Draw
    std::vector<std::uint32_t> source;     // of each vertex: its index in the file
    std::vector<glm::uvec4> joints;        // of each vertex; empty without JOINTS_0 and WEIGHTS_0
    std::vector<glm::vec4> joint_weights;  // sum 1
    std::vector<std::vector<MorphDelta>> targets;  // of each morph target, each vertex
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
// Index into the file's scenes, which may be empty: the default one, or the first.
std::size_t shown_scene(const Document& document);
// The nodes of that scene in depth-first order (all root nodes and what is below them when the file has no scene). What
// they place, their skins, cameras and lights are not known yet.
std::vector<Node> read_nodes(const Document& document);

// ---- animations.cpp ----
// Both leave out, with a warning, what is not sound or refers to nodes outside the scene.
std::vector<Animation> read_animations(const Document& document, const std::vector<Node>& nodes, Warnings& warnings);
// Sets Node::skin.
std::vector<Skin> read_skins(const Document& document, std::vector<Node>& nodes, Warnings& warnings);
// Sets Node::dynamic.
void mark_dynamic(Scene& scene);

// ---- place.cpp ----
// A vertex as the mesh has it, with its morph targets applied, by a matrix (world from mesh): positions by the matrix,
// normals by its inverse transpose, tangents by the matrix. Position relative to `origin_ws`. A vertex that is flattened
// to nothing keeps a normal of length 0.
Vertex placed(Vertex vertex, const glm::dmat4& world_from_mesh, glm::dvec3 origin_ws);
// A unit tangent perpendicular to the vertex's normal, now that this is known.
void finish_tangent(Vertex& vertex);
glm::dmat4 blended(const std::vector<glm::dmat4>& joint_matrices, glm::uvec4 joints, glm::vec4 weights);
bool is_mirroring(const glm::dmat4& matrix);
// The matrices of a node's vertices, world from mesh: one a joint where it has a skin, else one.
std::vector<glm::dmat4> world_from_mesh(const Scene& scene, const std::vector<NodePose>& poses, std::size_t node);

// ---- camera.cpp ----
// Set Node::camera and Node::light.
std::vector<Camera> read_cameras(const Document& document, std::vector<Node>& nodes, glm::dvec3 origin_ws,
                                 Warnings& warnings);
std::vector<Light> read_lights(const Document& document, std::vector<Node>& nodes, glm::dvec3 origin_ws,
                               Warnings& warnings);
// Position and direction of a node that carries them; false, and nothing changed, on a node without extent.
bool place(Camera& camera, const glm::dmat4& world_from_node, glm::dvec3 origin_ws);
bool place(Light& light, const glm::dmat4& world_from_node, glm::dvec3 origin_ws);
// See scene.hpp, Scene::has_default_light.
Light default_light(const Scene& scene);

}  // namespace conebook::gltf
