#include "11_emissives/emitter_parts.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "reference/scene_tracer.hpp"

namespace conebook {

namespace {

// A small part of an emitting triangle.
struct Piece {
    std::uint64_t order;  // near in this is near in space, and looks the same way
    glm::vec3 position;   // grid space
    glm::vec3 normal;     // unit
    glm::vec3 radiance;   // mean, W/(sr m^2)
    double area;          // voxel sides squared
    double power;         // luminance times area
};

double luminance(const glm::vec3& color) { return glm::dot(glm::dvec3(0.2126, 0.7152, 0.0722), glm::dvec3(color)); }

bool has_texture(const Material& m)
{
    return m.unlit || m.emission_texture.present() || m.alpha_mode == AlphaMode::mask;
}

// The direction that the normal is nearest to, and below it the bits of the coordinates in turn (Morton 1966).
std::uint64_t order_of(const glm::vec3& position, const glm::vec3& normal)
{
    const glm::vec3 n = glm::abs(normal);
    const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
    std::uint64_t code = std::uint64_t(2 * axis + (normal[axis] > 0.0f ? 1 : 0)) << 60;
    for (int a = 0; a < 3; ++a) {
        const auto steps = std::uint64_t(std::clamp(position[a] * 1024.0f, 0.0f, 1048575.0f));
        for (int bit = 0; bit < 20; ++bit) code |= ((steps >> bit) & 1u) << (3 * bit + a);
    }
    return code;
}

// As shaders/common/frame.glsl (Duff et al. 2017, listing 3).
glm::mat3 frame_around(const glm::vec3& n)
{
    const float s = n.z >= 0.0f ? 1.0f : -1.0f, a = -1.0f / (s + n.z), b = n.x * n.y * a;
    return {glm::vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x), glm::vec3(b, s + n.y * n.y * a, -n.y), n};
}

class PieceMaker {
public:
    PieceMaker(const Scene& scene, const shared::GridData& grid, double even_size, double textured_size)
        : scene_(scene), grid_(grid), even_size_(even_size), textured_size_(textured_size)
    {
    }

    void add(const Draw& draw, std::uint32_t triangle)
    {
        const Material& material = scene_.materials[std::size_t(draw.material)];
        split(draw, triangle, material, has_texture(material) ? textured_size_ : even_size_, {0, 0}, {1, 0}, {0, 1});
    }
    std::vector<Piece> pieces;

private:
    glm::dvec3 position(const Draw& draw, std::uint32_t triangle, glm::dvec2 b) const
    {
        const TrianglePoint p = triangle_point(scene_, draw, triangle, float(b.x), float(b.y));
        return (glm::dvec3(p.mix(&Vertex::position)) - glm::dvec3(grid_.origin)) / double(grid_.origin.w);
    }

    // Halve the longest side until the piece is small enough. Corners are barycentrics.
    void split(const Draw& draw, std::uint32_t triangle, const Material& material, double size, glm::dvec2 a,
               glm::dvec2 b, glm::dvec2 c)
    {
        const glm::dvec3 p = position(draw, triangle, a), q = position(draw, triangle, b), r = position(draw, triangle, c);
        const double ab = glm::distance(p, q), bc = glm::distance(q, r), ca = glm::distance(r, p);
        if (std::max({ab, bc, ca}) > size) {
            if (ab >= bc && ab >= ca) return halve(draw, triangle, material, size, a, b, c);
            if (bc >= ca) return halve(draw, triangle, material, size, b, c, a);
            return halve(draw, triangle, material, size, c, a, b);
        }
        const glm::dvec3 cross = glm::cross(q - p, r - p);
        const double length = glm::length(cross);
        if (!(length > 0.0)) return;
        const glm::vec3 radiance = mean_radiance(draw, triangle, material, a, b, c);
        const double power = 0.5 * length * luminance(radiance);
        if (!(power > 0.0)) return;
        const glm::vec3 middle((p + q + r) / 3.0), normal(cross / length);
        pieces.push_back({order_of(middle, normal), middle, normal, radiance, 0.5 * length, power});
        if (material.double_sided)
            pieces.push_back({order_of(middle, -normal), middle, -normal, radiance, 0.5 * length, power});
    }

    void halve(const Draw& draw, std::uint32_t triangle, const Material& material, double size, glm::dvec2 a,
               glm::dvec2 b, glm::dvec2 c)
    {
        const glm::dvec2 middle = 0.5 * (a + b);
        split(draw, triangle, material, size, a, middle, c);
        split(draw, triangle, material, size, middle, b, c);
    }

    glm::vec3 mean_radiance(const Draw& draw, std::uint32_t triangle, const Material& material, glm::dvec2 a,
                            glm::dvec2 b, glm::dvec2 c) const
    {
        if (!has_texture(material)) return material.emission;
        constexpr int kSteps = 3;  // 6 points
        glm::dvec3 sum(0.0);
        int count = 0;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; i + j < kSteps; ++j, ++count) {
                const double u = (i + 1.0 / 3.0) / kSteps, v = (j + 1.0 / 3.0) / kSteps;
                const glm::dvec2 at = (1.0 - u - v) * a + u * b + v * c;
                const TrianglePoint p = triangle_point(scene_, draw, triangle, float(at.x), float(at.y));
                if (covers(scene_, material, p)) sum += glm::dvec3(emitted_radiance(scene_, material, p));
            }
        return glm::vec3(sum / double(count));
    }

    const Scene& scene_;
    const shared::GridData& grid_;
    double even_size_, textured_size_;  // of pieces, voxels
};

double triangle_area(const Scene& scene, const Draw& draw, std::uint32_t triangle)
{
    const TrianglePoint p = triangle_point(scene, draw, triangle, 0.0f, 0.0f);
    const glm::dvec3 a(p.v0->position), b(p.v1->position), c(p.v2->position);
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}

// f(draw, triangle, area in m^2, material) for every triangle.
template <typename Function>
void for_each_triangle(const Scene& scene, Function f)
{
    for (const Draw& draw : scene.draws)
        for (std::uint32_t t = 0; t < draw.index_count / 3; ++t)
            f(draw, t, triangle_area(scene, draw, t), scene.materials[std::size_t(draw.material)]);
}

std::vector<shared::EmitterTriangle> exact_triangles(const Scene& scene, const shared::GridData& grid)
{
    std::vector<shared::EmitterTriangle> triangles;
    bool exact = true;
    for_each_triangle(scene, [&](const Draw& draw, std::uint32_t t, double area, const Material& m) {
        if (!m.shines() || area == 0.0 || !exact) return;
        exact = !has_texture(m) && triangles.size() + (m.double_sided ? 2 : 1) <= EmitterParts::kMostTriangles;
        const TrianglePoint p = triangle_point(scene, draw, t, 0.0f, 0.0f);
        const auto corner = [&](const Vertex* v, float radiance) {
            return glm::vec4((v->position - glm::vec3(grid.origin)) / grid.origin.w, radiance);
        };
        triangles.push_back({corner(p.v0, m.emission.r), corner(p.v1, m.emission.g), corner(p.v2, m.emission.b)});
        if (m.double_sided)
            triangles.push_back({corner(p.v1, m.emission.r), corner(p.v0, m.emission.g), corner(p.v2, m.emission.b)});
    });
    if (!exact) triangles.clear();
    return triangles;
}

// Of the directions of shared::kMaskBands bands of equal solid angle above a part, each in shared::kMaskSectors sectors: a
// bit for each in which something lies within the part's blur.
std::uint32_t near_mask(const SceneTracer& tracer, const shared::GridData& grid, const Piece& piece)
{
    const glm::mat3 frame = frame_around(piece.normal);
    const auto scene_position = [&](const glm::vec3& p) { return p * grid.origin.w + glm::vec3(grid.origin); };
    const glm::vec3 start = scene_position(piece.position) + tracer.surface_offset() * piece.normal;
    std::uint32_t mask = 0;
    for (int band = 0; band < shared::kMaskBands; ++band)
        for (int sector = 0; sector < shared::kMaskSectors; ++sector) {
            constexpr int kRays = 4;  // in each direction's cell
            int blocked = 0;
            for (int ray = 0; ray < kRays; ++ray) {
                const float z = (float(band) + (float(ray / 2) + 0.5f) / 2.0f) / float(shared::kMaskBands);
                const float phi = 2.0f * std::numbers::pi_v<float> *
                                  (float(sector) + (float(ray % 2) + 0.5f) / 2.0f) / float(shared::kMaskSectors);
                const float r = std::sqrt(1.0f - z * z), length = shared::kEmitterBlur / z * grid.origin.w;
                const glm::vec3 direction = frame * glm::vec3(r * std::cos(phi), r * std::sin(phi), z);
                blocked += tracer.occluded(start, start + length * direction) ? 1 : 0;
            }
            if (2 * blocked > kRays) mask |= 1u << (band * shared::kMaskSectors + sector);
        }
    return mask;
}

// The pieces in the middle of `count` runs of equal power, each with all the power of its run.
std::vector<shared::EmitterPart> equal_parts(const std::vector<Piece>& pieces, double power, int count,
                                             const SceneTracer& tracer, const shared::GridData& grid)
{
    std::vector<shared::EmitterPart> parts;
    // snippet: parts
    auto piece = pieces.begin();
    double power_before = 0.0;
    for (int k = 0; k < count; ++k) {
        while (piece + 1 != pieces.end() && power_before + piece->power < (k + 0.5) / count * power)
            power_before += (piece++)->power;
        const auto area = float(power / count / luminance(piece->radiance));  // voxel sides squared
        parts.push_back({glm::vec4(piece->position, area / std::numbers::pi_v<float>),
                         glm::vec4(piece->normal, std::bit_cast<float>(near_mask(tracer, grid, *piece))),
                         glm::vec4(area * piece->radiance, 0.0f)});
    }
    // end snippet
    return parts;
}

}  // namespace

EmitterParts make_emitter_parts(const Scene& scene, const shared::GridData& grid, int aimed, int sets)
{
    // Even emitters in some pieces a part; textured ones in pieces of a voxel, or larger ones where these were too many.
    constexpr double kMostPieces = 2e5;
    double even_area = 0.0, textured_area = 0.0, all_area = 0.0;
    for_each_triangle(scene, [&](const Draw&, std::uint32_t, double area_m2, const Material& m) {
        const double area = area_m2 / (double(grid.origin.w) * double(grid.origin.w));
        all_area += area;
        if (m.shines()) (has_texture(m) ? textured_area : even_area) += area;
    });
    EmitterParts result;
    if (even_area + textured_area == 0.0) return result;
    PieceMaker maker(scene, grid, std::sqrt(even_area / (4.0 * EmitterParts::kEvenParts)),
                     std::max(1.0, std::sqrt(textured_area / kMostPieces)));
    for_each_triangle(scene, [&](const Draw& draw, std::uint32_t t, double, const Material& m) {
        if (m.shines()) maker.add(draw, t);
    });
    std::vector<Piece>& pieces = maker.pieces;
    if (pieces.empty()) return result;
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.order < b.order; });
    double power = 0.0, power_radiance = 0.0;
    for (const Piece& piece : pieces) {
        power += piece.power;
        power_radiance += piece.power * luminance(piece.radiance);
    }
    result.emitting_share = power * power / power_radiance / all_area;
    if (aimed == 0) return result;
    result.triangles = exact_triangles(scene, grid);

    const SceneTracer tracer(scene);
    const std::vector<shared::EmitterPart> ordered = equal_parts(pieces, power, aimed, tracer, grid);
    result.parts.resize(ordered.size());
    for (std::size_t k = 0; k < ordered.size(); ++k)  // one after the other to the sets
        result.parts[k % std::size_t(sets) * (ordered.size() / std::size_t(sets)) + k / std::size_t(sets)] = ordered[k];
    if (result.triangles.empty())
        for (const shared::EmitterPart& part : equal_parts(pieces, power, EmitterParts::kEvenParts, tracer, grid))
            result.parts.push_back(part);
    return result;
}

}  // namespace conebook
