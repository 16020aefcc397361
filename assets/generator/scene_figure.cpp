// A figure that walks on the spot, its skin moved by joints, and a ball that takes another shape: a morph target.
#include <cmath>
#include <string>

#include <glm/gtc/constants.hpp>

#include "scenes.hpp"

namespace conebook::generator {
namespace {

constexpr double pi = glm::pi<double>();

// A closed tube around the line from `a` down to `b` (m), rounded at both ends, as a body of revolution whose profile is
// |s|^4 + r^4 = 1: full, and without an edge. `weight(share of the way)` gives the weight of joint `second`, the rest is
// `first`'s.
template <class Weight>
void add_limb(Mesh& mesh, glm::dvec3 a, glm::dvec3 b, double radius, int first, int second, Weight weight)
{
    constexpr int segments = 16, rings = 16;
    const glm::dvec3 axis = 0.5 * (b - a), middle = 0.5 * (a + b), down = glm::normalize(axis);
    const glm::dvec3 side = glm::normalize(glm::cross(down, glm::dvec3(0.0, 0.0, 1.0))), front = glm::cross(side, down);
    const double half = glm::length(axis) + radius;
    const auto start = static_cast<std::uint32_t>(mesh.positions.size());
    const auto root = [](double v) { return std::copysign(std::sqrt(std::abs(v)), v); };
    for (int ring = 0; ring <= rings; ++ring) {
        const double theta = pi * ring / rings;
        // Both coordinates of the profile, and its gradient (s^3 / half, r^3 / radius).
        const double s = root(std::cos(theta)), r = ring % rings == 0 ? 0.0 : root(std::sin(theta));
        const double along = s * s * s / half, across = r * r * r / radius;
        for (int segment = 0; segment <= segments; ++segment) {
            const double u = double(segment) / segments, phi = 2.0 * pi * (segment % segments) / segments;
            const glm::dvec3 out = std::cos(phi) * side + std::sin(phi) * front;
            const glm::dvec3 normal = glm::normalize(-along * down + across * out);
            mesh.vertex(middle - half * s * down + radius * r * out, normal, {u, double(ring) / rings});
            const float share = snapped(weight(0.5 - 0.5 * s * half / glm::length(axis)));
            mesh.joints.push_back({first, second, 0, 0});
            mesh.joint_weights.push_back({1.0f - share, share, 0.0f, 0.0f});
        }
    }
    for (int ring = 0; ring < rings; ++ring) {
        for (int segment = 0; segment < segments; ++segment) {
            const auto i = start + static_cast<std::uint32_t>(ring * (segments + 1) + segment),
                       below = i + segments + 1;
            mesh.triangle(i, below, below + 1);
            mesh.triangle(i, below + 1, i + 1);
        }
    }
}

// From 0 to 1 around the middle of the way: where elbow and knee are.
double bend(double way)
{
    const double t = glm::clamp((way - 0.35) / 0.3, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

std::vector<double> row(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

// Turns about the x axis by these degrees, one after the other in `period_s`, and as at first at the end.
Track swing(int object, std::vector<double> degrees, double period_s)
{
    Track track{object, Path::rotation, Interpolation::linear, {}, {}};
    degrees.push_back(degrees[0]);
    for (std::size_t i = 0; i < degrees.size(); ++i) {
        track.times_s.push_back(period_s * double(i) / double(degrees.size() - 1));
        track.values.push_back(row(glm::angleAxis(glm::radians(degrees[i]), glm::dvec3(1.0, 0.0, 0.0))));
    }
    return track;
}

}  // namespace

Asset figure()
{
    Asset asset;
    asset.name = "figure";
    Mesh white, red, blue;
    const glm::dvec3 low(-1.2, 0.0, -1.2), high(1.2, 2.2, 1.2);
    add_room(white, low, high, face_nx | face_px | face_pz);
    add_room_face(red, low, high, face_nx);
    add_room_face(blue, low, high, face_px);
    asset.add("wall_white", white, lambert("white", glm::dvec3(0.7)));
    asset.add("wall_red", red, lambert("red", {0.6, 0.08, 0.06}));
    asset.add("wall_blue", blue, lambert("blue", {0.08, 0.15, 0.6}));

    // Joints stand at rest where their limbs begin; the figure looks along +z.
    constexpr double period_s = 2.0, stand_x = -0.25;
    struct Limb {
        const char* name;
        glm::dvec3 from, knee, to;  // m
        double radius;
        double swing_degrees, bend_degrees;  // of the upper joint to both sides, of the lower one
    };
    const int hips = asset.add_joint("hips", -1, {stand_x, 0.9, 0.0});
    asset.joints.push_back(hips);
    Mesh body;
    const auto one = [](double) { return 0.0; };
    add_limb(body, {stand_x, 1.38, 0.0}, {stand_x, 0.9, 0.0}, 0.17, 0, 0, one);
    add_limb(body, {stand_x, 1.72, 0.0}, {stand_x, 1.66, 0.0}, 0.12, 0, 0, one);
    const Limb limbs[] = {
        {"leg_left", {0.1, 0.85, 0.0}, {0.1, 0.46, 0.0}, {0.1, 0.07, 0.0}, 0.075, -30.0, 45.0},
        {"leg_right", {-0.1, 0.85, 0.0}, {-0.1, 0.46, 0.0}, {-0.1, 0.07, 0.0}, 0.075, 30.0, 45.0},
        {"arm_left", {0.23, 1.4, 0.0}, {0.25, 1.13, 0.0}, {0.27, 0.86, 0.0}, 0.055, 30.0, -50.0},
        {"arm_right", {-0.23, 1.4, 0.0}, {-0.25, 1.13, 0.0}, {-0.27, 0.86, 0.0}, 0.055, -30.0, -50.0},
    };
    for (const Limb& limb : limbs) {
        const glm::dvec3 stand(stand_x, 0.0, 0.0), hips_at(stand_x, 0.9, 0.0);
        const int upper = asset.add_joint(limb.name, hips, stand + limb.from - hips_at);
        const int lower = asset.add_joint(limb.name + std::string("_lower"), upper, limb.knee - limb.from);
        const int first = int(asset.joints.size());
        asset.joints.insert(asset.joints.end(), {upper, lower});
        add_limb(body, stand + limb.from, stand + limb.to, limb.radius, first, first + 1, bend);
        const double s = limb.swing_degrees, b = limb.bend_degrees;
        asset.tracks.push_back(swing(upper, {0.0, s, 0.0, -s}, period_s));
        asset.tracks.push_back(
            swing(lower, {0.2 * b, 0.3 * b, s < 0.0 ? b : 0.2 * b, s < 0.0 ? 0.2 * b : b}, period_s));
    }
    asset.add("figure", body, lambert("figure", {0.75, 0.5, 0.2}));
    asset.objects.back().skinned = true;
    asset.tracks.push_back(
        {hips,
         Path::translation,
         Interpolation::linear,
         {0.0, 0.25 * period_s, 0.5 * period_s, 0.75 * period_s, period_s},
         {{stand_x, 0.9, 0.0}, {stand_x, 0.94, 0.0}, {stand_x, 0.9, 0.0}, {stand_x, 0.94, 0.0}, {stand_x, 0.9, 0.0}}});

    // A ball that becomes flat and wide and again a ball: weight 0 to 1.
    Mesh ball, flat;
    const glm::dvec3 at(0.55, 0.3, 0.35), size(1.4, 0.4, 1.4);
    add_sphere(ball, glm::dvec3(0.0), 0.28, 24, 12);
    add_sphere(flat, glm::dvec3(0.0), 0.28, 24, 12);
    for (std::size_t i = 0; i < flat.positions.size(); ++i) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(flat.normals[i]) / size);
        for (int axis = 0; axis < 3; ++axis) {
            flat.positions[i][axis] = snapped(double(flat.positions[i][axis]) * size[axis]);
            flat.normals[i][axis] = snapped(normal[axis]);
        }
    }
    ball.add_target(flat);
    const int morphing = asset.add("ball", ball, lambert("ball", {0.15, 0.55, 0.2}));
    asset.objects.back().translation = at;
    asset.tracks.push_back({morphing,
                            Path::weights,
                            Interpolation::cubic_spline,
                            {0.0, 0.5 * period_s, period_s},
                            {{0.0}, {0.0}, {0.0}, {0.0}, {1.0}, {0.0}, {0.0}, {0.0}, {0.0}}});

    Light light;
    light.name = "point";
    light.position = {0.4, 1.95, 0.7};
    light.intensity = 4.0;
    asset.lights.push_back(light);
    Camera camera;
    camera.name = "front";
    camera.eye = {0.25, 1.1, 4.3};
    camera.target = {0.0, 1.09, 0.0};
    camera.y_fov_degrees = 39.5;
    asset.cameras.push_back(camera);
    return asset;
}

}  // namespace conebook::generator
