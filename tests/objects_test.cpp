// Objects put into a scene: their text, their places, and that any way to a scene ends in the same buffers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

#include <glm/gtc/constants.hpp>

#include "gl/gpu_scene.hpp"
#include "program.hpp"
#include "random_objects.hpp"
#include "scene/objects.hpp"
#include "scene/pose.hpp"
#include "scene/shapes.hpp"
#include "temporary_folder.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

std::string fault_of(const std::function<void()>& work)
{
    try {
        work();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

std::string asset_file(const std::string& name)
{
    return (std::filesystem::path(std::getenv("CONEBOOK_ROOT")) / "assets" / (name + ".glb")).string();
}

TEST(ObjectText, SaysEverythingToTheLastBit)
{
    RandomEdits random(1);
    for (int i = 0; i < 300; ++i) {
        std::vector<Object> objects;
        for (std::size_t n = random.below(5); n > 0; --n) objects.push_back(random.object({"a/b_c.glb", "../d.gltf"}));
        const std::string text = text_of(objects);
        ASSERT_EQ(parse_objects(text), objects) << text;
        // No character that a shell would take for its own.
        ASSERT_EQ(text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_:,.=+-/"), std::string::npos) << text;
    }
}

TEST(ObjectText, IsReadAsItIsMeant)
{
    const auto objects = parse_objects(
        "sphere:at=0,0.5,-1:scale=0.4:color=0.8,0.1,0.2:roughness=0.3:dynamic+cube:turn=0,90,0:"
        "emission=5:static+x/y.glb:scale=1,2,3");
    ASSERT_EQ(objects.size(), 3u);
    EXPECT_EQ(objects[0].at, glm::dvec3(0.0, 0.5, -1.0));
    EXPECT_EQ(objects[0].scale, glm::dvec3(0.4));
    EXPECT_EQ(objects[0].material->color, glm::vec3(0.8f, 0.1f, 0.2f));
    EXPECT_EQ(objects[0].material->roughness, 0.3f);
    EXPECT_EQ(objects[0].material->specular, 1.0f);
    EXPECT_TRUE(objects[0].dynamic);
    EXPECT_EQ(objects[1].material->emission, glm::vec3(5.0f));
    EXPECT_FALSE(objects[1].dynamic);
    EXPECT_FALSE(objects[2].material);
    // First about x, then about y: y -> z -> x.
    const glm::dvec4 turned =
        parse_objects("cone:turn=90,90,0")[0].transform().matrix() * glm::dvec4(0.0, 1.0, 0.0, 0.0);
    EXPECT_LT(glm::distance(glm::dvec3(turned), glm::dvec3(1.0, 0.0, 0.0)), 1e-15);
    EXPECT_TRUE(parse_objects("").empty());
}

TEST(ObjectText, FaultsAreNamed)
{
    for (const auto& [text, fault] : std::initializer_list<std::pair<const char*, const char*>>{
             {"ball", "object 1 'ball': is none of icosahedron, cube,"},
             {"cube+", "object 2 '': is none of"},
             {"cube:at=1,2", "object 1 'cube': at=1,2 needs 3 numbers"},
             {"cube:at=1,2,x", "at=1,2,x has 'x', which is not a number"},
             {"cube:at=1,2,nan", "'nan', which is not a number"},
             {"cube:at=1,2,", "has '', which is not a number"},
             {"cube:scale=0", "scale=0 is out of range 1e-06"},
             {"cube:scale=1,2", "scale=1,2 needs 1 number or 3"},
             {"sphere:color=2,0,0", "is out of range 0 .. 1"},
             {"sphere:roughness=-1", "is out of range 0 .. 1"},
             {"sphere:emission=-1", "is out of range 0 .. 65504"},
             {"sphere:size=1", "'size=1' is none of at=, turn="},
             {"sphere:at", "'at' is none of at=, turn="},
             {"sphere:dynamic=1", "'dynamic=1' is none of"},
             {"sphere at=1,2,3", "object 1 'sphere at=1,2,3': is none of"}}) {
        const std::string said = fault_of([&] { parse_objects(text); });
        EXPECT_NE(said.find(fault), std::string::npos) << text << " said " << said;
        EXPECT_EQ(said.find('\n'), std::string::npos);
    }
    std::string many = "cube";
    for (std::size_t i = 0; i < kMostObjects; ++i) many += "+cube";
    EXPECT_EQ(fault_of([&] { parse_objects(many); }), "more than 64 objects");
}

// A sphere of radius 1/2, scaled, turned and moved: an ellipsoid whose points are known.
TEST(Objects, StandWhereTheySay)
{
    Scene scene = load_scene(asset_file("cornell_empty"));
    PlacedObjects placed(scene);
    Object object;
    object.source = "sphere";
    object.at = {0.3, 0.7, -0.2};
    object.scale = {0.4, 0.8, 0.2};
    object.turn_degrees = {0.0, 0.0, 90.0};  // its y is -x of the world
    placed.set(scene, {object});
    const Node& node = scene.nodes.at(placed.node_of(0));
    for (std::uint32_t v = node.vertices.first; v < node.vertices.end(); ++v) {
        const glm::dvec3 p = glm::dvec3(scene.vertices[v].position) + scene.origin_ws - object.at;
        const glm::dvec3 on_sphere(p.y / 0.4, -p.x / 0.8, p.z / 0.2), n(scene.vertices[v].normal);
        ASSERT_NEAR(glm::length(on_sphere), 0.5, 1e-5);
        const glm::dvec3 gradient(p.x / 0.64, p.y / 0.16, p.z / 0.04);
        ASSERT_NEAR(glm::dot(glm::normalize(gradient), n), 1.0, 1e-5);
    }
    EXPECT_NEAR(node.bounds.extent().x, 0.8, 1e-6);
    EXPECT_NEAR(node.bounds.extent().y, 0.4, 1e-6);
}

TEST(Objects, AreFilesWithTheirTextures)
{
    Scene scene = load_scene(asset_file("cornell_empty"));
    const Scene file = load_scene(asset_file("glossy_room"));
    const std::size_t images = scene.images.size(), materials = scene.materials.size(),
                      triangles = scene.triangle_count();
    PlacedObjects placed(scene);
    placed.set(scene, parse_objects("cube+" + asset_file("glossy_room") + ":at=1,0,0:scale=0.5"));
    EXPECT_EQ(scene.images.size(), images + file.images.size());
    EXPECT_EQ(scene.materials.size(), materials + 1 + file.materials.size());
    EXPECT_EQ(scene.triangle_count(), triangles + 12 + file.triangle_count());
    const Node& node = scene.nodes.at(placed.node_of(1));
    for (std::uint32_t v = 0; v < node.vertices.count; ++v) {
        const glm::dvec3 p = glm::dvec3(scene.vertices[node.vertices.first + v].position) + scene.origin_ws;
        const glm::dvec3 there =
            (glm::dvec3(file.vertices[v].position) + file.origin_ws) * 0.5 + glm::dvec3(1.0, 0.0, 0.0);
        ASSERT_LT(glm::distance(p, there), 1e-6);
    }
    for (std::uint32_t d = 0; d < node.draws.count; ++d) {
        const Material& own = file.materials[std::size_t(file.draws[d].material)];
        const Material& here = scene.materials[std::size_t(scene.draws[node.draws.first + d].material)];
        EXPECT_EQ(here.name, own.name);
        if (!own.base_color_texture.present()) continue;
        EXPECT_EQ(scene.images[std::size_t(here.base_color_texture.image)].rgba,
                  file.images[std::size_t(own.base_color_texture.image)].rgba);
    }
}

TEST(Objects, ThatCannotBeReadChangeNothing)
{
    Scene scene = load_scene(asset_file("cornell_empty"));
    PlacedObjects placed(scene);
    placed.set(scene, parse_objects("cube:scale=0.3"));
    const std::size_t nodes = scene.nodes.size(), vertices = scene.vertices.size();
    const TemporaryFolder folder;
    const std::string broken = (folder / "broken.glb").string();
    std::ofstream(broken) << "glTF no more";
    for (const std::string& file : {std::string("no/such.glb"), broken}) {
        const std::string said = fault_of([&] { placed.set(scene, parse_objects("sphere+" + file)); });
        EXPECT_EQ(said.rfind(file + ": ", 0), 0u) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos);
    }
    EXPECT_EQ(scene.nodes.size(), nodes);
    EXPECT_EQ(scene.vertices.size(), vertices);
    EXPECT_EQ(text_of(placed.objects()), "cube:scale=0.3");
}

// Everything of a GpuScene that passes read, word by word.
std::vector<std::vector<GLuint>> contents(const GpuScene& scene)
{
    std::vector<std::vector<GLuint>> all;
    const auto read = [&](GLenum target, GLuint index) {
        GLint buffer = 0, bytes = 0;
        GLint64 start = 0, size = 0;
        glGetIntegeri_v(target == GL_UNIFORM_BUFFER ? GL_UNIFORM_BUFFER_BINDING : GL_SHADER_STORAGE_BUFFER_BINDING,
                        index, &buffer);
        glGetNamedBufferParameteriv(GLuint(buffer), GL_BUFFER_SIZE, &bytes);
        if (target == GL_UNIFORM_BUFFER) {
            glGetInteger64i_v(GL_UNIFORM_BUFFER_START, index, &start);
            glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, index, &size);
        } else {
            size = bytes;
        }
        std::vector<GLuint> words(std::size_t(size) / sizeof(GLuint));
        glGetNamedBufferSubData(GLuint(buffer), GLintptr(start), GLsizeiptr(size), words.data());
        all.push_back(std::move(words));
    };
    scene.bind_triangles();
    for (const GLuint binding : {shared::kVertexBinding, shared::kIndexBinding, shared::kTriangleMaterialBinding})
        read(GL_SHADER_STORAGE_BUFFER, binding);
    scene.for_each_material([&](std::size_t) {
        read(GL_UNIFORM_BUFFER, shared::kMaterialBlock);
        std::vector<GLuint> textures;  // their texels, by way of a sum: sizes and what is in them
        for (GLuint unit = 0; unit <= GLuint(shared::kCoverageUnit); ++unit) {
            GLint texture = 0, width = 0, height = 0, format = 0;
            glActiveTexture(GL_TEXTURE0 + unit);
            glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture);
            glGetTextureLevelParameteriv(GLuint(texture), 0, GL_TEXTURE_WIDTH, &width);
            glGetTextureLevelParameteriv(GLuint(texture), 0, GL_TEXTURE_HEIGHT, &height);
            glGetTextureLevelParameteriv(GLuint(texture), 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
            std::vector<GLuint> texels(std::size_t(width) * std::size_t(height));
            glGetTextureImage(GLuint(texture), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(4 * texels.size()), texels.data());
            textures.insert(textures.end(), {GLuint(width), GLuint(height), GLuint(format)});
            textures.insert(textures.end(), texels.begin(), texels.end());
        }
        all.push_back(std::move(textures));
    });
    std::vector<GLuint> rest = {GLuint(scene.triangle_count()), GLuint(scene.may_move()), GLuint(scene.has_emission())};
    for (const MaterialUse& use : scene.material_uses()) {
        rest.insert(rest.end(), {GLuint(use.triangles), GLuint(use.vertex_alpha)});
        for (const double number : {use.box_sides_m, use.seen_areas_m2}) {
            GLuint halves[2];
            std::memcpy(halves, &number, sizeof halves);
            rest.insert(rest.end(), halves, halves + 2);
        }
    }
    for (const Triangle& triangle : scene.triangles())
        for (const glm::vec3& corner : triangle.corners) {
            GLuint words[3];
            std::memcpy(words, &corner, sizeof words);
            rest.insert(rest.end(), words, words + 3);
        }
    all.push_back(std::move(rest));
    return all;
}

// What a program does with the changes.
void follow(GpuScene& gpu_scene, const Scene& scene, const PlacedObjects& placed, const ObjectChanges& changes)
{
    if (changes.others) gpu_scene.set_triangles(scene, placed.file_images());
    for (const std::size_t node : changes.moved) gpu_scene.move(scene, node);
    for (const std::size_t material : changes.materials) gpu_scene.set_material(scene, material);
    gpu_scene.find_dynamic(scene);
}

TEST(Objects, AnyWayToASceneEndsInTheSameBuffers)
{
    test_gl();
    // The scene has textures of its own; so have two files, of which one is then in the place of the other.
    const std::vector<std::string> files = {asset_file("emissive_shapes"), asset_file("colonnade")};
    Scene scene = load_scene(asset_file("glossy_room"));
    PlacedObjects placed(scene);
    GpuScene gpu_scene(scene);
    RandomEdits random(7);
    std::vector<Object> objects;
    int moves = 0, others = 0;
    for (int i = 1; i <= 200; ++i) {
        random.edit(objects, files);
        const ObjectChanges changes = placed.set(scene, objects);
        follow(gpu_scene, scene, placed, changes);
        moves += !changes.others && changes.moved.size() == 1;
        others += changes.others;
        if (i % 10 != 0) continue;
        Scene fresh = load_scene(asset_file("glossy_room"));
        PlacedObjects placed_afresh(fresh);
        placed_afresh.set(fresh, objects);
        ASSERT_EQ(contents(gpu_scene), contents(GpuScene(fresh))) << "after " << i << " edits: " << text_of(objects);
    }
    EXPECT_GT(moves, 40);
    EXPECT_GT(others, 20);
    const ObjectChanges none = placed.set(scene, objects);
    EXPECT_FALSE(none.any());
    follow(gpu_scene, scene, placed, placed.set(scene, {}));
    EXPECT_EQ(contents(gpu_scene), contents(GpuScene(load_scene(asset_file("glossy_room")))));
}

TEST(Objects, MoveWithoutTheirBuffersMadeAgain)
{
    test_gl();
    Scene scene = load_scene(asset_file("cornell_box"));
    PlacedObjects placed(scene);
    std::vector<Object> objects = parse_objects("torus:scale=0.5+sphere:scale=0.3:dynamic");
    placed.set(scene, objects);
    GpuScene gpu_scene(scene);
    const auto vertices = gpu_scene.vertices().read<Vertex>();
    const GLuint buffer = gpu_scene.vertices().id();
    objects[1].at.x = 0.25;
    const ObjectChanges changes = placed.set(scene, objects);
    EXPECT_FALSE(changes.others);
    ASSERT_EQ(changes.moved, std::vector<std::size_t>{placed.node_of(1)});
    follow(gpu_scene, scene, placed, changes);
    EXPECT_EQ(gpu_scene.vertices().id(), buffer);
    const Range own = scene.nodes[placed.node_of(1)].vertices;
    const auto moved = gpu_scene.vertices().read<Vertex>();
    for (std::size_t v = 0; v < vertices.size(); ++v)
        ASSERT_EQ(std::memcmp(&vertices[v], &moved[v], sizeof(Vertex)) == 0, v < own.first) << v;
}

// Objects are not in a pose, and a pose leaves them alone.
TEST(Objects, StayWhereTheyAreWhileTheSceneMoves)
{
    Scene scene = load_scene(asset_file("spinning_shapes"));
    PlacedObjects placed(scene);
    placed.set(scene, parse_objects("cone:at=0,1,0:dynamic"));
    const Node& node = scene.nodes[placed.node_of(0)];
    const Pose later = pose(scene, 1.3);
    for (std::uint32_t v = node.vertices.first; v < node.vertices.end(); ++v)
        ASSERT_EQ(later.vertices[v].position, scene.vertices[v].position);
}

}  // namespace
}  // namespace conebook
