// Scenes that move: a door that opens, a lamp that walks, shapes that spin between the columns.
#include <cmath>
#include <string>
#include <utility>

#include <glm/gtc/constants.hpp>

#include "scenes.hpp"

namespace conebook::generator {
namespace {

std::vector<double> row(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
std::vector<double> row(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

glm::dquat turned(double degrees, const glm::dvec3& axis) { return glm::angleAxis(glm::radians(degrees), axis); }

const glm::dvec3 x_axis(1.0, 0.0, 0.0), y_axis(0.0, 1.0, 0.0), z_axis(0.0, 0.0, 1.0);

// Curve through key after key that rests at each of them.
Track resting_at(int object, const std::vector<double>& times_s, const std::vector<glm::dquat>& rotations)
{
    Track track{object, Path::rotation, Interpolation::cubic_spline, times_s, {}};
    for (const glm::dquat& rotation : rotations) {
        const std::vector<double> still(4, 0.0);
        track.values.insert(track.values.end(), {still, row(rotation), still});
    }
    return track;
}

// Turns about an axis in equal parts, `steps` to the whole turn, one after the other in `period_s`.
Track spin(int object, const glm::dvec3& axis, int steps, double period_s, Interpolation interpolation)
{
    Track track{object, Path::rotation, interpolation, {}, {}};
    for (int i = 0; i <= steps; ++i) {
        track.times_s.push_back(period_s * i / steps);
        track.values.push_back(row(turned(360.0 * i / steps, axis)));
    }
    return track;
}

Light point_light(const glm::dvec3& position, double intensity)
{
    Light light;
    light.name = "point";
    light.position = position;
    light.intensity = intensity;
    return light;
}

Camera camera_at(const char* name, const glm::dvec3& eye, const glm::dvec3& target, double y_fov_degrees)
{
    Camera camera;
    camera.name = name;
    camera.eye = eye;
    camera.target = target;
    camera.y_fov_degrees = y_fov_degrees;
    return camera;
}

// Puts an object somewhere else, which carries it from now on.
void attach(Asset& asset, int object, int parent, const glm::dvec3& translation)
{
    Object& o = asset.objects.at(static_cast<std::size_t>(object));
    o.parent = parent;
    o.translation = translation;
}

}  // namespace

Asset door()
{
    Asset asset;
    asset.name = "door";
    const double half = 0.0625, side = 0.4,
                 top = 1.6;  // of the wall's thickness, of the doorway's width; its height, m
    Mesh room, wall;
    add_room(room, {-2.0, 0.0, -1.0}, {2.0, 2.0, 1.0});
    for (const double facing : {-1.0, 1.0}) {
        const double x = facing * half;
        const glm::dvec3 outward(facing, 0.0, 0.0);
        add_quad(wall, {x, 0.0, -1.0}, {0.0, 0.0, 1.0 - side}, {0.0, 2.0, 0.0}, outward);
        add_quad(wall, {x, 0.0, side}, {0.0, 0.0, 1.0 - side}, {0.0, 2.0, 0.0}, outward);
        add_quad(wall, {x, top, -side}, {0.0, 0.0, 2.0 * side}, {0.0, 2.0 - top, 0.0}, outward);
    }
    add_quad(wall, {-half, 0.0, -side}, {2.0 * half, 0.0, 0.0}, {0.0, top, 0.0}, z_axis);
    add_quad(wall, {-half, 0.0, side}, {2.0 * half, 0.0, 0.0}, {0.0, top, 0.0}, -z_axis);
    add_quad(wall, {-half, top, -side}, {2.0 * half, 0.0, 0.0}, {0.0, 0.0, 2.0 * side}, -y_axis);
    asset.add("room", room, lambert("room", glm::dvec3(0.7)));
    asset.add("wall", wall, lambert("wall", {0.7, 0.6, 0.4}));

    // The leaf lies on the dark side of the wall, 0.1 m wider than the doorway on each side, and turns about its edge.
    const double overlap = 0.1, width = 2.0 * (side + overlap), height = top + overlap, thickness = 0.05;
    Mesh leaf, ball;
    add_box(leaf, {{0.5 * thickness, 0.0, 0.5 * width}, 0.0}, {thickness, height, width}, face_ny);
    const int leaf_object = asset.add("door", leaf, lambert("door", {0.6, 0.3, 0.1}));
    asset.objects.back().translation = {half, 0.0, -side - overlap};
    const glm::dquat closed(1.0, 0.0, 0.0, 0.0), open = turned(100.0, y_axis);
    asset.tracks = {resting_at(leaf_object, {0.0, 1.0, 3.0, 4.0, 6.0}, {closed, closed, open, open, closed})};

    add_sphere(ball, {1.2, 0.25, 0.1}, 0.25);
    asset.add("ball", ball, lambert("ball", {0.15, 0.3, 0.7}));
    asset.lights.push_back(point_light({-1.0, 1.5, 0.1}, 4.0));
    asset.cameras = {camera_at("dark_room", {1.85, 1.15, 0.85}, {0.3, 0.75, -0.25}, 65.0),
                     camera_at("lit_room", {-1.85, 1.15, 0.75}, {0.0, 0.9, -0.1}, 60.0)};
    return asset;
}

Asset walking_lamp()
{
    Asset asset;
    asset.name = "walking_lamp";
    Mesh room, columns;
    add_room(room, {-2.0, 0.0, -1.5}, {2.0, 2.0, 1.5}, face_nx | face_px);
    asset.add("room", room, lambert("room", glm::dvec3(0.6)));
    Mesh left, right;
    add_room_face(left, {-2.0, 0.0, -1.5}, {2.0, 2.0, 1.5}, face_nx);
    add_room_face(right, {-2.0, 0.0, -1.5}, {2.0, 2.0, 1.5}, face_px);
    asset.add("wall_red", left, lambert("red", {0.6, 0.1, 0.08}));
    asset.add("wall_blue", right, lambert("blue", {0.1, 0.2, 0.6}));
    for (const double x : {-0.8, 0.0, 0.8}) {
        add_box(columns, {{x, 0.0, 0.0}, 0.0}, {0.25, 2.0, 0.25}, face_ny | face_py);
    }
    asset.add("columns", columns, lambert("columns", {0.7, 0.65, 0.55}));

    // Round the columns in 8 s. A key every second, the curve through them Catmull and Rom's (1974): the tangent at a key
    // is half the way from the one before it to the one after it, by their distance in time.
    constexpr int keys = 8;
    const auto place = [](int i) {
        const double angle = glm::two_pi<double>() * i / keys;
        return glm::dvec3(1.45 * std::sin(angle), 0.0, 0.85 * std::cos(angle));
    };
    const int walker = asset.add_joint("walker", -1, place(0));
    Track way{walker, Path::translation, Interpolation::cubic_spline, {}, {}};
    Track heading{walker, Path::rotation, Interpolation::linear, {}, {}};
    for (int i = 0; i <= keys; ++i) {
        const glm::dvec3 tangent = 0.5 * (place(i + 1) - place(i - 1));  // m/s
        way.times_s.push_back(i);
        way.values.insert(way.values.end(), {row(tangent), row(place(i)), row(tangent)});
        heading.times_s.push_back(i);
        heading.values.push_back(row(turned(glm::degrees(std::atan2(tangent.x, tangent.z)), y_axis)));
    }
    asset.objects.back().rotation = {heading.values[0][3], heading.values[0][0], heading.values[0][1],
                                     heading.values[0][2]};
    asset.tracks = {way, heading};

    Mesh body, shade, leg;
    add_box(body, {{0.0, 0.4, 0.0}, 0.0}, {0.18, 0.25, 0.12});
    add_cylinder(body, 0.0, 0.0, 0.65, 0.8, 0.02, 12);
    const Material cloth = lambert("body", {0.2, 0.5, 0.25});
    attach(asset, asset.add("body", body, cloth), walker, glm::dvec3(0.0));
    add_sphere(shade, glm::dvec3(0.0), 0.12, 24, 12);
    attach(asset, asset.add("shade", shade, lambert("shade", glm::dvec3(0.0), {60.0, 48.0, 30.0})), walker,
           {0.0, 0.9, 0.0});
    add_box(leg, {{0.0, -0.4, 0.0}, 0.0}, {0.05, 0.42, 0.05});
    for (const double foot : {-1.0, 1.0}) {
        const int object = asset.add(foot < 0.0 ? "leg_right" : "leg_left", leg, cloth);
        attach(asset, object, walker, {0.06 * foot, 0.42, 0.0});
        Track stride{object, Path::rotation, Interpolation::linear, {}, {}};
        for (int i = 0; i <= 2 * keys; ++i) {  // a step takes half a second
            stride.times_s.push_back(0.5 * i);
            stride.values.push_back(row(turned(foot * (i % 2 == 0 ? 25.0 : -25.0), x_axis)));
        }
        asset.objects.back().rotation = turned(foot * 25.0, x_axis);
        asset.tracks.push_back(stride);
    }
    Light beam;
    beam.name = "beam";
    beam.kind = LightKind::spot;
    beam.parent = walker;
    beam.position = {0.0, 0.72, 0.16};
    beam.direction = {0.0, -0.25, 1.0};
    beam.color = {1.0, 0.9, 0.7};
    beam.intensity = 6.0;
    beam.inner_degrees = 18.0;
    beam.outer_degrees = 28.0;
    asset.lights.push_back(beam);
    asset.cameras = {camera_at("corner", {1.9, 1.7, 1.42}, {-0.3, 0.6, -0.2}, 70.0),
                     camera_at("aisle", {-1.9, 1.2, 1.2}, {1.0, 0.5, 0.6}, 60.0)};
    return asset;
}

Asset spinning_shapes()
{
    Asset asset = colonnade();
    asset.name = "spinning_shapes";
    constexpr double period_s = 4.0;
    const auto metal = [](const char* name, const glm::dvec3& color, double roughness) {
        Material material;
        material.name = name;
        material.base_color = color;
        material.metallic = 1.0;
        material.roughness = roughness;
        return material;
    };
    const auto put = [&](const char* name, Mesh mesh, const Material& material, const glm::dvec3& at) {
        const int object = asset.add(name, std::move(mesh), material);
        asset.objects.back().translation = at;
        return object;
    };
    Mesh torus, cube, ball, lamp;
    add_torus(torus, {glm::dvec3(0.0), 0.0}, 0.35, 0.1, 32, 12);
    const int ring = put("torus", torus, metal("gold", {0.9, 0.65, 0.3}, 0.25), {1.8, 0.9, 0.3});
    asset.tracks.push_back(spin(ring, x_axis, 4, period_s, Interpolation::linear));

    add_box(cube, {{0.0, -0.25, 0.0}, 0.0}, glm::dvec3(0.5));
    const int die = put("cube", cube, lambert("cube", {0.65, 0.1, 0.08}), {0.7, 0.5, -0.4});
    asset.tracks.push_back(spin(die, y_axis, 16, period_s, Interpolation::step));

    // Falls freely on the floor again and again: 1/2 g t^2 for a half of 2/3 s is 0.545 m, and a cubic with the right
    // tangents is that parabola.
    add_sphere(ball, glm::dvec3(0.0), 0.2, 24, 12);
    const glm::dvec3 floor(-0.4, 0.2, 0.45), speed(0.0, 0.5 * 9.81 * period_s / 6.0, 0.0);
    const int jumper = put("ball", ball, lambert("ball", {0.1, 0.45, 0.15}), floor);
    Track jumps{jumper, Path::translation, Interpolation::cubic_spline, {}, {}};
    for (int i = 0; i <= 6; ++i) {
        jumps.times_s.push_back(period_s * i / 6.0);
        jumps.values.insert(jumps.values.end(), {row(-speed), row(floor), row(speed)});
    }
    asset.tracks.push_back(jumps);

    // A light that breathes: its radiance stays, its area changes.
    add_sphere(lamp, glm::dvec3(0.0), 0.15, 24, 12);
    const int breathing = put("lamp", lamp, lambert("lamp", glm::dvec3(0.0), {40.0, 34.0, 24.0}), {0.2, 1.4, -2.2});
    asset.tracks.push_back({breathing,
                            Path::scale,
                            Interpolation::linear,
                            {0.0, 0.5 * period_s, period_s},
                            {{1.0, 1.0, 1.0}, {0.4, 0.4, 0.4}, {1.0, 1.0, 1.0}}});

    // Three that go round a fourth, which carries them.
    const int carousel = asset.add_joint("carousel", -1, {-2.2, 1.0, 0.0});
    for (int i = 0; i < 3; ++i) {
        Mesh seat;
        add_box(seat, {{0.0, -0.15, 0.0}, 0.0}, {0.2, 0.3, 0.3});
        const std::string name = "seat_" + std::to_string(i);
        const int object =
            asset.add(name, seat, lambert(name, {i == 0 ? 0.7 : 0.15, i == 1 ? 0.7 : 0.15, i == 2 ? 0.7 : 0.15}));
        const double angle = glm::two_pi<double>() * i / 3.0;
        attach(asset, object, carousel, 0.6 * glm::dvec3(std::sin(angle), 0.0, std::cos(angle)));
        asset.objects.back().rotation = glm::angleAxis(angle, y_axis);
    }
    asset.tracks.push_back(spin(carousel, y_axis, 4, period_s, Interpolation::linear));
    std::swap(asset.cameras.at(0), asset.cameras.at(1));
    return asset;
}

}  // namespace conebook::generator
