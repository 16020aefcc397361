// The courtyard with two aisles: sun in the middle, indirect light in the aisles, cloth, lattice, tiled floor.
#include <algorithm>
#include <string>

#include "scenes.hpp"

namespace conebook::generator {
namespace {

constexpr double half_length = 4.0;       // m, along x
constexpr double inner_wall_z = 3.0, outer_wall_z = 3.2;
constexpr double beam_inner_z = 1.0, beam_outer_z = 1.4, column_z = 1.2;
constexpr double beam_y = 2.3, ceiling_y = 2.45, roof_y = 2.6;
constexpr int columns_per_row = 5;
constexpr double column_spacing = 1.7, first_column_x = -3.4;

// Integer hash (Wang 2007): grain of the stone, the same on every machine.
unsigned hash(unsigned x) {
    x = (x ^ 61u) ^ (x >> 16);
    x *= 9u;
    x ^= x >> 4;
    x *= 0x27d4eb2du;
    return x ^ (x >> 15);
}

constexpr int floor_texels = 96;            // one texture is 2 x 2 tiles
constexpr double floor_texture_side = 1.6;  // m

// Height of the floor in texels: tiles with a rounded edge and joints between them.
double floor_height(int x, int y) {
    constexpr int tile = floor_texels / 2;
    const int u = ((x % tile) + tile) % tile, v = ((y % tile) + tile) % tile;
    const int edge = std::min(std::min(u, tile - 1 - u), std::min(v, tile - 1 - v));
    return 0.6 * std::min(edge, 3);
}

Picture floor_color() {
    return make_picture(floor_texels, floor_texels, 3, [](int x, int y) {
        constexpr int tile = floor_texels / 2;
        const bool warm = (x / tile + y / tile) % 2 == 0;
        const int grain = int(hash(unsigned(x + floor_texels * y)) % 17u) - 8;
        const bool joint = floor_height(x, y) < 0.5;
        const glm::ivec3 stone = warm ? glm::ivec3(205, 180, 150) : glm::ivec3(170, 165, 160);
        return glm::ivec4((joint ? glm::ivec3(110, 105, 100) : stone) + grain, 255);
    });
}

// Tangent-space normals from central differences; +y of the tangent frame is up in the picture (glTF 2.0, 3.9.3).
Picture floor_normals() {
    return make_picture(floor_texels, floor_texels, 3, [](int x, int y) {
        const double dx = 0.5 * (floor_height(x + 1, y) - floor_height(x - 1, y));
        const double dy = 0.5 * (floor_height(x, y - 1) - floor_height(x, y + 1));
        const glm::dvec3 n = glm::normalize(glm::dvec3(-dx, -dy, 1.0));
        return glm::ivec4(glm::ivec3(glm::round((n * 0.5 + 0.5) * 255.0)), 255);
    });
}

// Diagonal bars of a wooden lattice; alpha 0 between them.
Picture lattice() {
    return make_picture(64, 64, 4, [](int x, int y) {
        const bool falling = (x + y) % 32 < 9, rising = (x - y + 64) % 32 < 9;
        const int shade = int(hash(unsigned(x + 64 * y)) % 21u);
        return glm::ivec4(150 + shade, 105 + shade, 60 + shade, falling || rising ? 255 : 0);
    });
}

// Aisle at z > 0 (mirror = 1) or z < 0 (mirror = -1): wall, roof and beam as one solid, its end at +x closed.
void add_aisle(Mesh& stone, double mirror) {
    // Open at the floor, which closes it.
    std::vector<glm::dvec2> section = {{inner_wall_z, 0.0},    {inner_wall_z, ceiling_y}, {beam_outer_z, ceiling_y},
                                       {beam_outer_z, beam_y}, {beam_inner_z, beam_y},    {beam_inner_z, roof_y},
                                       {outer_wall_z, roof_y}, {outer_wall_z, 0.0}};
    if (mirror < 0.0) {
        std::reverse(section.begin(), section.end());
        for (glm::dvec2& point : section) {
            point.x = -point.x;
        }
    }
    add_extrusion_x(stone, section, -half_length, half_length);
    const auto cap = [&](double z0, double z1, double y0, double y1) {
        add_quad(stone, {half_length, y0, mirror * z0}, {0.0, 0.0, mirror * (z1 - z0)}, {0.0, y1 - y0, 0.0},
                 {1.0, 0.0, 0.0});
    };
    cap(inner_wall_z, outer_wall_z, 0.0, ceiling_y);
    cap(beam_outer_z, outer_wall_z, ceiling_y, roof_y);
    cap(beam_inner_z, beam_outer_z, beam_y, roof_y);
}

void add_column(Mesh& mesh, double x, double z) {
    constexpr double foot = 0.12, side = 0.38, radius = 0.14;
    add_box(mesh, {{x, 0.0, z}, 0.0}, {side, foot, side}, face_ny);
    add_cylinder(mesh, x, z, foot, beam_y - foot, radius);
    add_box(mesh, {{x, beam_y - foot, z}, 0.0}, {side, foot, side}, face_py);
}

}  // namespace

Asset colonnade() {
    Asset asset;
    asset.name = "colonnade";
    asset.textures = {floor_color(), floor_normals(), lattice()};

    Mesh floor, back, stone, columns;
    const double length = 2.0 * half_length, width = 2.0 * inner_wall_z;
    add_quad(floor, {-half_length, 0.0, inner_wall_z}, {length, 0.0, 0.0}, {0.0, 0.0, -width}, {0.0, 1.0, 0.0},
             glm::dvec2(length, width) / floor_texture_side);
    Material tiles = lambert("floor", glm::dvec3(1.0));
    tiles.base_color_texture = 0;
    tiles.normal_texture = 1;
    asset.add("floor", floor, tiles);
    add_box(back, {{-half_length - 0.1, 0.0, 0.0}, 0.0}, {0.2, 2.8, 2.0 * outer_wall_z}, face_ny);
    asset.add("back_wall", back, lambert("back_wall", {0.62, 0.55, 0.45}));
    add_aisle(stone, 1.0);
    add_aisle(stone, -1.0);
    asset.add("stone", stone, lambert("stone", {0.6, 0.57, 0.52}));
    for (int i = 0; i < columns_per_row; ++i) {
        for (double z : {-column_z, column_z}) {
            add_column(columns, first_column_x + column_spacing * i, z);
        }
    }
    asset.add("columns", columns, lambert("columns", {0.7, 0.68, 0.64}));

    struct Cloth {
        const char* name;
        glm::dvec3 rho;
        int bay;        // between column bay and bay + 1
        double row_z;   // m
    };
    const Cloth cloths[] = {{"curtain_red", {0.65, 0.05, 0.04}, 1, -column_z},
                            {"curtain_green", {0.06, 0.5, 0.08}, 2, -column_z},
                            {"curtain_blue", {0.05, 0.1, 0.6}, 1, column_z}};
    const auto bay_x = [](int bay) { return first_column_x + column_spacing * (bay + 0.5); };
    for (const Cloth& cloth : cloths) {
        Mesh sheet;
        add_curtain(sheet, {{bay_x(cloth.bay), beam_y, cloth.row_z}, 0.0}, 1.3, 1.9, 0.06, 5.0, 80);
        Material fabric = lambert(cloth.name, cloth.rho);
        fabric.double_sided = true;
        asset.add(cloth.name, sheet, fabric);
    }
    Mesh screen;
    add_quad(screen, {bay_x(3) - 0.65, 0.0, -column_z}, {1.3, 0.0, 0.0}, {0.0, beam_y, 0.0}, {0.0, 0.0, 1.0},
             {2.0, 3.0});
    Material wood = lambert("lattice", glm::dvec3(1.0));
    wood.base_color_texture = 2;
    wood.alpha_mask = true;
    wood.double_sided = true;
    asset.add("lattice", screen, wood);

    Light sun;
    sun.name = "sun";
    sun.kind = LightKind::directional;
    sun.position = {0.0, 6.0, 0.0};
    sun.direction = {-0.35, -1.0, -0.5};
    sun.color = {1.0, 0.93, 0.8};
    sun.intensity = 8.0;
    asset.lights.push_back(sun);

    Camera aisle, middle;
    aisle.name = "aisle";
    aisle.eye = {3.7, 1.5, -2.3};
    aisle.target = {-2.0, 1.15, -1.7};
    aisle.y_fov_degrees = 60.0;
    middle.name = "middle";
    middle.eye = {3.9, 1.6, 0.55};
    middle.target = {-2.0, 1.2, -0.5};
    middle.y_fov_degrees = 65.0;
    asset.cameras = {aisle, middle};
    return asset;
}

}  // namespace conebook::generator
