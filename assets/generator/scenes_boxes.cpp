// Scenes with known answers: Cornell boxes, white furnace, thin walls, the plane under three lights.
#include <cmath>

#include "scenes.hpp"

namespace conebook::generator {
namespace {

// Linear RGB reflectances of the Cornell box as widely used: the measured spectra (Cornell University, 1998) as RGB.
const glm::dvec3 cornell_white(0.725, 0.71, 0.68), cornell_red(0.63, 0.065, 0.05), cornell_green(0.14, 0.45, 0.091);

// Walls of the room 2 x 2 x 2 m (x, z in -1..1, y in 0..2), open towards +z, red on the left.
Asset cornell_room(const char* name) {
    Asset asset;
    asset.name = name;
    const glm::dvec3 low(-1.0, 0.0, -1.0), high(1.0, 2.0, 1.0);
    Mesh white, red, green;
    add_room(white, low, high, face_nx | face_px | face_pz);
    add_room_face(red, low, high, face_nx);
    add_room_face(green, low, high, face_px);
    asset.add("wall_white", white, lambert("white", cornell_white));
    asset.add("wall_red", red, lambert("red", cornell_red));
    asset.add("wall_green", green, lambert("green", cornell_green));

    // The open side fills a square picture: 2 atan(1 m / 2.8 m) = 39.3 degrees, the original's angle.
    Camera camera;
    camera.name = "front";
    camera.eye = {0.0, 1.0, 3.8};
    camera.target = {0.0, 1.0, 0.0};
    camera.y_fov_degrees = 2.0 * glm::degrees(std::atan(1.0 / 2.8));
    asset.cameras.push_back(camera);
    return asset;
}

// Places and sizes of the original blocks, scaled by 2 m / 559.2 mm and turned to a camera that looks along -z.
void add_cornell_blocks(Asset& asset) {
    Mesh tall, small;
    add_box(tall, {{-0.318, 0.0, -0.256}, 17.2}, {0.59, 1.18, 0.59}, face_ny);
    add_box(small, {{0.337, 0.0, 0.396}, -16.7}, {0.59, 0.59, 0.59}, face_ny);
    asset.add("tall_block", tall, lambert("tall_block", cornell_white));
    asset.add("short_block", small, lambert("short_block", cornell_white));
}

Light point_light(glm::dvec3 position, double intensity) {
    Light light;
    light.name = "point";
    light.position = position;
    light.intensity = intensity;
    return light;
}

// Box 4 x 2 x 2 m cut into two rooms by a wall in the plane x = 0 of the given thickness; 0: one double-sided quad.
Asset two_rooms(const char* name, double thickness) {
    Asset asset;
    asset.name = name;
    Mesh room, divider;
    add_room(room, {-2.0, 0.0, -1.0}, {2.0, 2.0, 1.0});
    asset.add("wall", room, lambert("wall", glm::dvec3(0.7)));
    Material paper = lambert("divider", {0.7, 0.6, 0.4});
    if (thickness > 0.0) {
        add_box(divider, {{0.0, 0.0, 0.0}, 0.0}, {thickness, 2.0, 2.0}, face_ny | face_py | face_nz | face_pz);
    } else {
        add_quad(divider, {0.0, 0.0, -1.0}, {0.0, 0.0, 2.0}, {0.0, 2.0, 0.0}, {1.0, 0.0, 0.0});
        paper.double_sided = true;
    }
    asset.add("divider", divider, paper);
    asset.lights.push_back(point_light({-1.0, 1.4, 0.0}, 3.0));

    Camera dark;
    dark.name = "dark_room";
    dark.eye = {1.85, 1.1, 0.75};
    dark.target = {0.0, 0.9, -0.2};
    dark.y_fov_degrees = 60.0;
    Camera lit = dark;
    lit.name = "lit_room";
    lit.eye.x = -dark.eye.x;
    asset.cameras = {dark, lit};
    return asset;
}

}  // namespace

Asset cornell_box() {
    Asset asset = cornell_room("cornell_box");
    add_cornell_blocks(asset);
    asset.lights.push_back(point_light({0.0, 1.8, 0.0}, 4.0));
    return asset;
}

Asset cornell_area() {
    Asset asset = cornell_room("cornell_area");
    add_cornell_blocks(asset);
    Mesh lamp;
    add_quad(lamp, {-0.25, 1.99, -0.2}, {0.5, 0.0, 0.0}, {0.0, 0.0, 0.4}, {0.0, -1.0, 0.0});
    asset.add("lamp", lamp, lambert("lamp", glm::dvec3(0.0), {16.0, 13.6, 10.4}));
    return asset;
}

Asset cornell_empty() {
    Asset asset = cornell_room("cornell_empty");
    asset.lights.push_back(point_light({0.0, 1.8, 0.0}, 4.0));
    return asset;
}

Asset white_furnace() {
    Asset asset;
    asset.name = "white_furnace";
    Mesh room;
    add_room(room, glm::dvec3(-1.0), glm::dvec3(1.0));
    asset.add("wall", room, lambert("furnace", glm::dvec3(0.5), glm::dvec3(0.5)));
    Camera camera;
    camera.name = "inside";
    camera.eye = {0.3, 0.1, 0.7};
    camera.target = {-0.2, -0.1, -1.0};
    camera.y_fov_degrees = 70.0;
    asset.cameras.push_back(camera);
    return asset;
}

Asset thin_wall() { return two_rooms("thin_wall", 0.0); }

Asset thin_wall_solid() { return two_rooms("thin_wall_solid", 4.0 / 64.0); }

Asset lights() {
    Asset asset;
    asset.name = "lights";
    Mesh plane, block, ball;
    add_quad(plane, {-2.0, 0.0, 2.0}, {4.0, 0.0, 0.0}, {0.0, 0.0, -4.0}, {0.0, 1.0, 0.0});
    add_box(block, {{-0.55, 0.0, 0.45}, 30.0}, {0.4, 0.6, 0.4}, face_ny);
    add_sphere(ball, {0.5, 0.3, 0.3}, 0.3, 48, 24);
    asset.add("plane", plane, lambert("plane", glm::dvec3(0.5)));
    asset.add("block", block, lambert("block", {0.2, 0.35, 0.6}));
    Material gloss;
    gloss.name = "ball";
    gloss.base_color = {0.6, 0.15, 0.1};
    gloss.roughness = 0.3;
    asset.add("ball", ball, gloss);

    Light point = point_light({-1.2, 1.0, -0.6}, 2.0);
    point.color = {1.0, 0.8, 0.6};
    Light spot;
    spot.name = "spot";
    spot.kind = LightKind::spot;
    spot.position = {1.3, 1.8, -0.7};
    spot.direction = {-0.15, -1.0, 0.2};
    spot.color = {0.6, 0.8, 1.0};
    spot.intensity = 8.0;
    spot.inner_degrees = 18.0;
    spot.outer_degrees = 26.0;
    Light sun;
    sun.name = "directional";
    sun.kind = LightKind::directional;
    sun.direction = {0.6, -1.0, -0.45};
    sun.intensity = 1.0;
    sun.position = {-2.0, 3.0, 1.5};
    asset.lights = {point, spot, sun};

    Camera oblique;
    oblique.name = "oblique";
    oblique.eye = {0.0, 3.0, 3.4};
    oblique.target = {0.0, 0.1, 0.1};
    oblique.y_fov_degrees = 50.0;
    Camera above;
    above.name = "above";
    above.eye = {0.0, 5.0, 0.0};
    above.target = {0.0, 0.0, 0.0};
    above.y_fov_degrees = 2.0 * glm::degrees(std::atan(2.0 / 5.0));
    asset.cameras = {oblique, above};
    return asset;
}

}  // namespace conebook::generator
