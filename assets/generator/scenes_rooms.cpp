// Rooms for reflections, emitters and materials.
#include <cmath>
#include <string>

#include "scenes.hpp"

namespace conebook::generator {
namespace {

Material surface(std::string name, glm::dvec3 base_color, double metallic, double roughness) {
    Material material;
    material.name = std::move(name);
    material.base_color = base_color;
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

Mesh sphere(glm::dvec3 center, double radius) {
    Mesh mesh;
    add_sphere(mesh, center, radius);
    return mesh;
}

Mesh room_face(glm::dvec3 low, glm::dvec3 high, Face face) {
    Mesh mesh;
    add_room_face(mesh, low, high, face);
    return mesh;
}

}  // namespace

Asset glossy_room() {
    Asset asset;
    asset.name = "glossy_room";
    const glm::dvec3 low(-1.0, 0.0, -1.5), high(1.0, 2.0, 1.5);
    const double roughness[4] = {0.05, 0.2, 0.5, 0.8};
    for (int i = 0; i < 4; ++i) {
        Mesh stripe;
        add_quad(stripe, {-1.0 + 0.5 * i, 0.0, 1.5}, {0.5, 0.0, 0.0}, {0.0, 0.0, -3.0}, {0.0, 1.0, 0.0}, {1.0, 6.0});
        const std::string name = "floor_" + std::to_string(i);
        asset.add(name, stripe, surface(name, glm::dvec3(0.9), 1.0, roughness[i]));
    }
    Mesh ceiling_and_front;
    add_room(ceiling_and_front, low, high, face_nx | face_px | face_ny | face_nz);
    asset.add("wall_white", ceiling_and_front, lambert("white", glm::dvec3(0.7)));
    asset.add("wall_red", room_face(low, high, face_nx), lambert("red", {0.6, 0.1, 0.08}));
    asset.add("wall_blue", room_face(low, high, face_px), lambert("blue", {0.1, 0.2, 0.6}));
    // The back wall is a picture of large tiles: how far the floor blurs them shows its roughness.
    asset.textures.push_back(make_picture(64, 64, 3, [](int x, int y) {
        const bool light = ((x / 8) + (y / 8)) % 2 == 0;
        return light ? glm::ivec4(235, 225, 190, 255) : glm::ivec4(90, 130, 80, 255);
    }));
    Material tiles = lambert("tiles", glm::dvec3(0.8));
    tiles.base_color_texture = 0;
    asset.add("wall_tiles", room_face(low, high, face_nz), tiles);

    asset.add("ball_yellow", sphere({-0.75, 0.2, -0.5}, 0.2), lambert("yellow", {0.8, 0.6, 0.05}));
    asset.add("ball_green", sphere({0.25, 0.3, -0.7}, 0.2), lambert("green", {0.1, 0.6, 0.15}));
    asset.add("ball_red", sphere({0.75, 0.2, -0.4}, 0.2), lambert("ball_red", {0.7, 0.08, 0.08}));
    Mesh block;
    add_box(block, {{-0.25, 0.0, -0.6}, 25.0}, {0.3, 0.5, 0.3}, face_ny);
    asset.add("block", block, lambert("orange", {0.8, 0.3, 0.05}));

    Light light;
    light.name = "point";
    light.position = {0.0, 1.6, 0.3};
    light.intensity = 4.0;
    asset.lights.push_back(light);
    Camera along, steep;
    along.name = "along";
    along.eye = {0.0, 0.8, 1.4};
    along.target = {0.0, 0.35, -1.0};
    along.y_fov_degrees = 65.0;
    steep.name = "steep";
    steep.eye = {0.0, 1.75, 0.9};
    steep.target = {0.0, 0.0, -0.35};
    steep.y_fov_degrees = 65.0;
    asset.cameras = {along, steep};
    return asset;
}

Asset emissive_shapes() {
    Asset asset;
    asset.name = "emissive_shapes";
    Mesh room, quad, cube, torus, panel;
    add_room(room, {-1.0, 0.0, -1.0}, {1.0, 2.0, 1.0});
    asset.add("wall", room, lambert("wall", glm::dvec3(0.4)));
    // Emitters reflect nothing, so that the radiance they show is the one written here.
    const glm::dvec3 black(0.0);
    asset.add("sphere", sphere({-0.45, 0.3, -0.25}, 0.25), lambert("sphere", black, {0.15, 0.5, 0.2}));
    add_torus(torus, {{0.4, 0.5, -0.3}, 0.0}, 0.25, 0.07);
    asset.add("torus", torus, lambert("torus", black, {1.0, 3.0, 8.0}));
    add_quad(quad, {-0.6, 1.6, -0.5}, {0.3, 0.0, 0.0}, {0.0, 0.0, 0.2}, {0.0, -1.0, 0.0});
    asset.add("quad", quad, lambert("quad", black, {30.0, 22.0, 12.0}));
    add_box(cube, {{0.05, 0.35, 0.0}, 20.0}, glm::dvec3(0.06));
    asset.add("cube", cube, lambert("cube", black, {200.0, 60.0, 40.0}));
    // Texture-driven emission: diagonal bands of three colours and black.
    asset.textures.push_back(make_picture(64, 64, 3, [](int x, int y) {
        constexpr glm::ivec4 bands[4] = {{255, 60, 200, 255}, {0, 0, 0, 255}, {60, 230, 255, 255}, {255, 220, 60, 255}};
        return bands[((x + y) / 16) % 4];
    }));
    Material banner = lambert("panel", black, glm::dvec3(4.0));
    banner.emission_texture = 0;
    add_quad(panel, {-0.2, 1.0, -0.98}, {0.9, 0.0, 0.0}, {0.0, 0.6, 0.0}, {0.0, 0.0, 1.0});
    asset.add("panel", panel, banner);

    Camera camera;
    camera.name = "front";
    camera.eye = {0.0, 1.0, 0.97};
    camera.target = {0.0, 0.85, -0.5};
    camera.y_fov_degrees = 75.0;
    asset.cameras.push_back(camera);
    return asset;
}

Asset materials() {
    Asset asset;
    asset.name = "materials";
    const glm::dvec3 low(-1.6, 0.0, -1.0), high(1.6, 2.0, 1.6);
    asset.add("wall_back", room_face(low, high, face_nz), lambert("back", {0.6, 0.6, 0.65}));
    asset.add("wall_left", room_face(low, high, face_nx), lambert("left", {0.7, 0.25, 0.05}));
    asset.add("wall_right", room_face(low, high, face_px), lambert("right", {0.05, 0.3, 0.6}));
    // Floor: roughness from a texture (G; B is metallic), a checkerboard of 0.15 and 0.9.
    asset.textures.push_back(make_picture(32, 32, 3, [](int x, int y) {
        return glm::ivec4(0, (x / 16 + y / 16) % 2 == 0 ? 38 : 230, 0, 255);
    }));
    Mesh floor;
    add_room_face(floor, low, high, face_ny, {4.0, 3.25});
    Material checker = surface("floor", glm::dvec3(0.35), 1.0, 1.0);
    checker.metallic_roughness_texture = 0;
    asset.add("floor", floor, checker);

    // Roughness 0..1 from left to right, metallic 0, 0.5, 1 from the lowest row up; all spheres share one mesh.
    const int ball = int(asset.meshes.size());
    asset.meshes.push_back(sphere(glm::dvec3(0.0), 0.2));
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 6; ++column) {
            const std::string name = "sphere_" + std::to_string(row) + "_" + std::to_string(column);
            asset.materials.push_back(surface(name, {0.9, 0.65, 0.3}, 0.5 * row, 0.2 * column));
            Object object;
            object.name = name;
            object.mesh = ball;
            object.material = int(asset.materials.size()) - 1;
            object.translation = {-1.25 + 0.5 * column, 0.3 + 0.5 * row, 0.3 - 0.3 * row};
            asset.objects.push_back(object);
        }
    }

    Light point, spot, sun;
    point.name = "point";
    point.position = {-0.9, 1.8, 1.2};
    point.intensity = 3.0;
    spot.name = "spot";
    spot.kind = LightKind::spot;
    spot.position = {1.1, 1.9, 1.3};
    spot.direction = {-0.5, -1.0, -1.0};
    spot.color = {1.0, 0.85, 0.6};
    spot.intensity = 6.0;
    spot.inner_degrees = 15.0;
    spot.outer_degrees = 30.0;
    sun.name = "directional";
    sun.kind = LightKind::directional;
    sun.position = {1.0, 3.0, 2.0};
    sun.direction = {-0.3, -1.0, -0.8};
    sun.color = {0.8, 0.9, 1.0};
    sun.intensity = 1.0;
    asset.lights = {point, spot, sun};
    Camera camera;
    camera.name = "front";
    camera.eye = {0.0, 1.05, 3.3};
    camera.target = {0.0, 0.85, 0.0};
    camera.y_fov_degrees = 56.0;
    asset.cameras.push_back(camera);
    return asset;
}

}  // namespace conebook::generator
