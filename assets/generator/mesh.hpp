// Triangle meshes of the project's own scenes: a list of shapes that can be appended to one mesh.
// Metres, y up, right-handed. Front faces are counter-clockwise seen from outside (glTF 2.0, section 3.7.2.1).
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace conebook::generator {

struct Mesh {
    std::vector<glm::vec3> positions;  // m, multiples of 2^-20 m
    std::vector<glm::vec3> normals;    // unit within 1e-6
    std::vector<glm::vec2> uvs;        // glTF: (0,0) is the top left texel
    std::vector<std::uint32_t> indices;

    // Of a mesh that a skin moves, for each vertex: numbers of four of its joints, and their weights, sum 1.
    std::vector<glm::u8vec4> joints;
    std::vector<glm::vec4> joint_weights;

    // What a morph target with weight 1 adds to each vertex.
    struct Target {
        std::vector<glm::vec3> positions, normals;
    };
    std::vector<Target> targets;

    // Every coordinate is rounded to a multiple of 2^-20. The last bit of sin and cos differs between maths libraries;
    // after rounding the files are the same everywhere, and seams of closed surfaces meet exactly.
    std::uint32_t vertex(const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec2& uv);
    // The morph target that makes vertex i of this mesh vertex i of `other`.
    void add_target(const Mesh& other);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
};

// The multiple of 2^-20 next to a value.
float snapped(double value);

// Rigid placement of a shape: rotation about y, then translation.
struct Place {
    glm::dvec3 position{0.0};  // m
    double turn = 0.0;         // degrees about +y
    glm::dvec3 point(const glm::dvec3& local) const;
    glm::dvec3 direction(const glm::dvec3& local) const;
};

// Parallelogram corner, corner+u, corner+u+v, corner+v whose front faces the side that `outward` points to.
// Texture coordinates run from 0 to uv_repeat along u, and downwards from uv_repeat to 0 along v.
void add_quad(Mesh& mesh, glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v, glm::dvec3 outward,
              glm::dvec2 uv_repeat = glm::dvec2(1.0));

enum Face : unsigned { face_nx = 1, face_px = 2, face_ny = 4, face_py = 8, face_nz = 16, face_pz = 32 };

// Solid box with outward faces; `place.position` is the middle of its bottom. Faces in `leave_out` are not made.
void add_box(Mesh& mesh, const Place& place, glm::dvec3 size, unsigned leave_out = 0);

// The inside of a box from `low` to `high`: faces towards the room. Faces in `leave_out` are not made.
void add_room(Mesh& mesh, glm::dvec3 low, glm::dvec3 high, unsigned leave_out = 0);

// One side of that room.
void add_room_face(Mesh& mesh, glm::dvec3 low, glm::dvec3 high, Face face, glm::dvec2 uv_repeat = glm::dvec2(1.0));

// Sphere around `center` (m), closed, smooth normals, poles on the y axis.
void add_sphere(Mesh& mesh, glm::dvec3 center, double radius, int segments = 32, int rings = 16);

// Torus around the y axis of `place`; radius of the ring and of the tube (m).
void add_torus(Mesh& mesh, const Place& place, double ring_radius, double tube_radius, int ring_segments = 48,
               int tube_segments = 20);

// Upright cylinder without caps from y0 to y1 (m) around (x, z).
void add_cylinder(Mesh& mesh, double x, double z, double y0, double y1, double radius, int segments = 24);

// Hanging sheet width x height (m), z = amplitude sin(2 pi waves x / width), its upper edge centred on place.position.
// One layer of triangles that faces +z: the material is to be double-sided.
void add_curtain(Mesh& mesh, const Place& place, double width, double height, double amplitude, double waves,
                 int segments = 64);

// The line of points (z, y) drawn out along x from x0 to x1: one quad per segment, its front on the right of the line
// as seen from +x (y up, z to the left), so that a counter-clockwise outline encloses a solid.
void add_extrusion_x(Mesh& mesh, const std::vector<glm::dvec2>& line_zy, double x0, double x1);

}  // namespace conebook::generator
