#include "scene/objects.hpp"

#include <algorithm>
#include <stdexcept>

#include "scene/parts.hpp"
#include "scene/pose.hpp"
#include "scene/shapes.hpp"

namespace conebook {

namespace {

Material material_of(const ObjectMaterial& from, const std::string& name)
{
    Material material;
    material.name = name;
    material.base_color = glm::vec4(from.color, 1.0f);
    material.metallic = from.metallic;
    material.roughness = from.roughness;
    material.specular = from.specular;
    material.emission = from.emission;
    return material;
}

void move_images(Material& material, int first_image)
{
    for (TextureSlot* slot :
         {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
          &material.emission_texture, &material.specular_texture, &material.specular_color_texture})
        if (slot->present()) slot->image += first_image;
}

// Whether the second can be had from the first one without other vertices or materials.
bool has_same_parts(const Object& a, const Object& b)
{
    const bool one_material = shape_from_name(a.source).has_value();
    return a.source == b.source && (one_material || a.material.has_value() == b.material.has_value());
}

bool has_same_place(const Object& a, const Object& b)
{
    return a.at == b.at && a.turn_degrees == b.turn_degrees && a.scale == b.scale;
}

void include(Bounds& bounds, const Bounds& other)
{
    bounds.min = glm::min(bounds.min, other.min);
    bounds.max = glm::max(bounds.max, other.max);
}

// Moves the node of an object there.
void place(Scene& scene, const Object& object, std::size_t index)
{
    Node& node = scene.nodes[index];
    node.local = object.transform();
    node.world_from_node = node.local.matrix();
    const std::vector<Vertex> vertices = posed_vertices(scene, rest_pose(scene), index);
    std::copy(vertices.begin(), vertices.end(), scene.vertices.begin() + node.vertices.first);
    node.bounds = {vertices[0].position, vertices[0].position};
    for (const Vertex& vertex : vertices) include(node.bounds, {vertex.position, vertex.position});
}

}  // namespace

Transform Object::transform() const
{
    const auto about = [&](int axis) {
        glm::dvec3 direction(0.0);
        direction[axis] = 1.0;
        return glm::angleAxis(glm::radians(turn_degrees[axis]), direction);
    };
    return {at, about(2) * about(1) * about(0), scale};
}

PlacedObjects::PlacedObjects(const Scene& scene)
    : file_{scene.nodes.size(),     scene.vertices.size(), scene.indices.size(), scene.draws.size(),
            scene.materials.size(), scene.images.size(),   scene.modelled.size()}
{
}

const PlacedObjects::Model& PlacedObjects::model(const std::string& source, std::vector<std::string>& notes)
{
    const auto known = models_.find(source);
    if (known != models_.end()) return known->second;
    Model model;
    if (const std::optional<Shape> shape = shape_from_name(source)) {
        ShapeMesh mesh = make_shape(*shape);
        model.vertices = std::move(mesh.vertices);
        model.indices = std::move(mesh.indices);
        Draw draw;
        draw.index_count = std::uint32_t(model.indices.size());
        draw.vertices = {0, std::uint32_t(model.vertices.size())};
        draw.name = source;
        model.draws.push_back(std::move(draw));
    } else {
        Scene file = load_scene(source);
        for (const std::string& warning : file.warnings) notes.push_back(source + ": " + warning);
        for (Vertex& vertex : file.vertices) vertex.position += glm::vec3(file.origin_ws);
        model.vertices = std::move(file.vertices);
        model.indices = std::move(file.indices);
        model.draws = std::move(file.draws);
        model.materials = std::move(file.materials);
        model.images = std::move(file.images);
    }
    for (const Vertex& vertex : model.vertices)
        model.modelled.push_back({vertex.position, vertex.normal, vertex.tangent});
    return models_.emplace(source, std::move(model)).first->second;
}

// Behind all that the scene holds.
void PlacedObjects::append(Scene& scene, const Object& object, std::size_t number) const
{
    const Model& model = models_.at(object.source);
    const auto first_vertex = std::uint32_t(scene.vertices.size()), first_index = std::uint32_t(scene.indices.size());
    const auto first_material = int(scene.materials.size());
    Node node;
    node.name = object.source;
    node.file_index = -1;
    node.object = int(number);
    node.dynamic = object.dynamic;
    node.vertices = {first_vertex, std::uint32_t(model.vertices.size())};
    node.indices = {first_index, std::uint32_t(model.indices.size())};
    node.draws = {std::uint32_t(scene.draws.size()), std::uint32_t(model.draws.size())};
    node.modelled = {std::uint32_t(scene.modelled.size()), std::uint32_t(model.modelled.size())};
    scene.vertices.insert(scene.vertices.end(), model.vertices.begin(), model.vertices.end());
    scene.modelled.insert(scene.modelled.end(), model.modelled.begin(), model.modelled.end());
    for (const std::uint32_t index : model.indices) scene.indices.push_back(first_vertex + index);
    const bool own_materials = !object.material && !model.materials.empty();
    for (Draw draw : model.draws) {
        draw.first_index += first_index;
        draw.vertices.first += first_vertex;
        draw.material = first_material + (own_materials ? draw.material : 0);
        scene.draws.push_back(std::move(draw));
    }
    if (own_materials) {
        for (Material material : model.materials) {
            move_images(material, int(scene.images.size()));
            scene.materials.push_back(std::move(material));
        }
        scene.images.insert(scene.images.end(), model.images.begin(), model.images.end());
    } else {
        scene.materials.push_back(material_of(object.material.value_or(ObjectMaterial{}), object.source));
    }
    scene.nodes.push_back(std::move(node));
    place(scene, object, scene.nodes.size() - 1);
}

ObjectChanges PlacedObjects::set(Scene& scene, const std::vector<Object>& objects)
{
    ObjectChanges changes;
    if (objects.size() > kMostObjects)
        throw std::runtime_error("more than " + std::to_string(kMostObjects) + " objects");
    for (const Object& object : objects) model(object.source, changes.notes);

    changes.others = objects.size() != objects_.size() ||
                     !std::equal(objects.begin(), objects.end(), objects_.begin(), has_same_parts);
    if (changes.others) {
        scene.nodes.resize(file_.nodes);
        scene.vertices.resize(file_.vertices);
        scene.indices.resize(file_.indices);
        scene.draws.resize(file_.draws);
        scene.materials.resize(file_.materials);
        scene.images.resize(file_.images);
        scene.modelled.resize(file_.modelled);
        for (std::size_t i = 0; i < objects.size(); ++i) append(scene, objects[i], i);
    } else {
        for (std::size_t i = 0; i < objects.size(); ++i) {
            const std::size_t node = node_of(i);
            if (!has_same_place(objects[i], objects_[i])) {
                place(scene, objects[i], node);
                changes.moved.push_back(node);
            }
            if (objects[i].material != objects_[i].material) {
                const auto material = std::size_t(scene.draws[scene.nodes[node].draws.first].material);
                scene.materials[material] =
                    material_of(objects[i].material.value_or(ObjectMaterial{}), objects[i].source);
                changes.materials.push_back(material);
            }
            if (objects[i].dynamic != objects_[i].dynamic) {
                scene.nodes[node].dynamic = objects[i].dynamic;
                changes.switched.push_back(node);
            }
        }
    }
    objects_ = objects;
    return changes;
}

Bounds bounds_with_objects(const Scene& scene)
{
    Bounds bounds = scene.bounds;
    for (const Node& node : scene.nodes)
        if (node.object >= 0) include(bounds, node.bounds);
    return bounds;
}

}  // namespace conebook
