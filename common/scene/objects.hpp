// Objects that are put into a scene besides what its file holds: shapes made by formula, or whole files, each as one
// node with a place, a material and a choice of whether it may move. As text:
//
//     sphere:at=0,0.5,0:scale=0.4:color=0.8,0.1,0.1:roughness=0.3:dynamic+assets/figure.glb:turn=0,90,0
//
// Objects are joined by +, the words of one by :, numbers of one word by commas; no word has a blank, so that a shell
// takes the whole as it is.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace conebook {

constexpr std::size_t kMostObjects = 64;

// Of one colour everywhere.
struct ObjectMaterial {
    glm::vec3 color{0.8f};     // base colour, linear, 0 .. 1
    float metallic = 0.0f;     // 0 .. 1
    float roughness = 1.0f;    // 0 .. 1
    float specular = 1.0f;     // 0 .. 1: KHR_materials_specular; 0 is pure Lambert
    glm::vec3 emission{0.0f};  // radiance, W/(sr m^2)
    bool operator==(const ObjectMaterial&) const = default;
};

struct Object {
    std::string source;                      // name of a shape (shapes.hpp), or of a .glb or .gltf file
    glm::dvec3 at{0.0};                      // m, world space: where its origin is
    glm::dvec3 turn_degrees{0.0};            // about x, then y, then z, of the world
    glm::dvec3 scale{1.0};                   // above 0
    std::optional<ObjectMaterial> material;  // none: the file's own, or that of ObjectMaterial{}
    bool dynamic = false;                    // see Node::dynamic
    Transform transform() const;
    bool operator==(const Object&) const = default;
};

// Throws std::runtime_error that says which object has which fault; whether files are there is not asked.
std::vector<Object> parse_objects(const std::string& text);
// What parse_objects reads as the same objects, bit for bit; "" for none.
std::string text_of(const std::vector<Object>& objects);
// The grammar in one line.
std::string objects_help();

// What of a scene other objects have changed.
struct ObjectChanges {
    bool others = false;                 // objects came or went: vertices, indices, draws and materials are others
    std::vector<std::size_t> moved;      // nodes
    std::vector<std::size_t> materials;  // of Scene::materials
    std::vector<std::size_t> switched;   // nodes that have become dynamic, or static
    std::vector<std::string> notes;      // of files that were read: what was read differently
    bool any() const { return others || !moved.empty() || !materials.empty() || !switched.empty(); }
};

// The objects of a scene, behind all that its file holds. The scene's origin and lights stay as they are, and so does
// its box. A file gives its triangles at rest, its materials and textures; its lights,
// cameras and animations are left out.
class PlacedObjects {
public:
    // Of a scene as its file has it. Only this may change how many nodes, draws, vertices, materials and images it has.
    explicit PlacedObjects(const Scene& scene);

    // From the objects that are there to these, with as little change as that takes; the scene is then the same, bit for
    // bit, as one to which these objects are the first to come. Throws std::runtime_error, and changes nothing, for a
    // file that cannot be read and for more than kMostObjects.
    ObjectChanges set(Scene& scene, const std::vector<Object>& objects);

    const std::vector<Object>& objects() const { return objects_; }
    std::size_t node_of(std::size_t object) const { return file_.nodes + object; }
    std::size_t file_images() const { return file_.images; }
private:
    struct Sizes {
        std::size_t nodes, vertices, indices, draws, materials, images, modelled;
    };
    // What an object shows, in its own space, and as placed where `materials` and `images` begin at 0.
    struct Model {
        std::vector<ModelledVertex> modelled;
        std::vector<Vertex> vertices;
        std::vector<std::uint32_t> indices;
        std::vector<Draw> draws;
        std::vector<Material> materials;  // empty: of a shape
        std::vector<Image> images;
    };
    const Model& model(const std::string& source, std::vector<std::string>& notes);
    void append(Scene& scene, const Object& object, std::size_t number) const;

    Sizes file_;
    std::vector<Object> objects_;
    std::map<std::string, Model> models_;  // of every source that was asked for
};

// Scene::bounds and the boxes of the objects, which may stand outside them.
Bounds bounds_with_objects(const Scene& scene);

}  // namespace conebook
