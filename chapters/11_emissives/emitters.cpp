#include "11_emissives/emitters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>


namespace conebook {

namespace {

constexpr int kSets = 16;            // of aimed rays, as of cones
constexpr float kAllIsNear = 1e30f;  // voxels squared
// Rays are better while emitters are small, and still so at a fifth of all surfaces (disc of 22 %, 0.9 m above a plane:
// 1.042 of the closed form by cones alone, 1.011 with rays). In rooms that shine all over cones are exact, and faster.
constexpr float kLargeShare = 0.3f;

struct Emitter {
    std::uint32_t order;
    const shared::VoxelFace* face;
    double power;  // luminance times area
};

// Faces of one direction together, and among them by the bits of the coordinates in turn (Morton 1966), so that what is
// near in the order is near in space and looks the same way.
std::uint32_t order_of(GLuint entry)
{
    std::uint32_t code = 0;
    for (int bit = 0; bit < 9; ++bit)
        for (int axis = 0; axis < 3; ++axis) code |= ((entry >> (9 * axis + bit)) & 1u) << (3 * bit + axis);
    return (entry >> 27) << 27 | code;
}

double luminance(const glm::vec4& color) { return glm::dot(glm::dvec3(0.2126, 0.7152, 0.0722), glm::dvec3(color)); }

std::vector<Emitter> emitters_of(const std::vector<GLuint>& entries, const std::vector<shared::VoxelFace>& faces,
                                 std::size_t count)
{
    std::vector<Emitter> emitters;
    for (std::size_t i = 0; i < count; ++i) {
        const double power = luminance(faces[i].emission) * double(faces[i].albedo_area.a);
        if (power > 0.0) emitters.push_back({order_of(entries[i]), &faces[i], power});
    }
    std::sort(emitters.begin(), emitters.end(), [](const Emitter& a, const Emitter& b) { return a.order < b.order; });
    return emitters;
}

}  // namespace

void add_parameters(ParameterTable& table, EmitterParams& params)
{
    table.add("aimed_rays", params.aimed_rays, 0, 64, "", "rays aimed at emitters; 0: cones meet them by chance");
}

Emitters::Emitters(gl::Shaders& shaders, const Scene& scene, const VoxelGrid& grid, const EmitterParams& params)
    : params_(params),
      emitting_share_(emitting_share(scene)),
      apart_(params.aimed_rays > 0 && emitting_share_ > 0.0f && emitting_share_ < kLargeShare)
{
    if (apart_) pyramid_.emplace(shaders, grid, PyramidParams{});
}

bool Emitters::run(const VoxelGrid& grid, const VoxelFaces& faces, const VoxelShading& shading)
{
    if (!made_from_.differs(faces.revision())) return false;
    if (!apart_) return false;
    ++revision_;
    pyramid_->run(grid, faces, shading.radiance(), shading.revision(), LightPart::emitted);

    const auto means = faces.faces().read<shared::VoxelFace>();
    const std::vector<Emitter> emitters = emitters_of(faces.face_list().read<GLuint>(), means, faces.face_count());
    if (emitters.empty()) {
        parts_ = {};
        return true;
    }

    // snippet: parts
    // Parts of equal power along the order; the face in the middle of each stands for it with all its power.
    double power = 0.0, power_radiance = 0.0;
    for (const Emitter& emitter : emitters) {
        power += emitter.power;
        power_radiance += emitter.power * luminance(emitter.face->emission);
    }
    const int count = kSets * params_.aimed_rays;
    std::vector<shared::EmitterPart> parts(static_cast<std::size_t>(count));
    auto emitter = emitters.begin();
    double power_before = 0.0;
    for (int k = 0; k < count; ++k) {
        while (emitter + 1 != emitters.end() && power_before + emitter->power < (k + 0.5) / count * power)
            power_before += (emitter++)->power;
        const float area = float(power / count / luminance(emitter->face->emission));  // voxel sides squared
        // One after the other to the sets, so that each has parts of all emitters.
        parts[std::size_t(k % kSets * params_.aimed_rays + k / kSets)] = {
            glm::vec4(glm::vec3(emitter->face->position), area / std::numbers::pi_v<float>), emitter->face->normal,
            area * emitter->face->emission};
    }
    // end snippet
    parts_ = gl::Buffer("emitter parts", parts);

    // Of two ways to sample the same light each takes a share that goes with its density (Veach 1997, 9.2.2). Per solid
    // angle and without the cosines, of which neither knows both: n parts of an emitter of area A have the density
    // n t^2 / A at distance t, n cones n / pi; equal at t^2 = A / pi. Cones count half: they blur what they meet, aimed
    // rays do not (disc above a plane: within 4.1 % of the closed form, with the whole 7.6 %).
    const double area = power * power / power_radiance;  // power over its mean radiance: equivalent area
    near_radius2_voxels_ = float(0.5 * area / std::numbers::pi);
    return true;
}

std::string Emitters::shader_folder(const std::string& without) const { return apart_ ? "11_emissives" : without; }

void Emitters::bind_all(const gl::Program& program) const
{
    if (!apart_) return;
    pyramid_->bind_as_emission();
    program.set("near_radius2", kAllIsNear);
}

void Emitters::bind(const gl::Program& program, const ConeDirections& directions) const
{
    if (!apart_) return;
    pyramid_->bind_as_emission();
    if (parts_) parts_.bind(GL_SHADER_STORAGE_BUFFER, shared::kEmitterBinding);
    const bool shared = directions.sets() > 1;
    program.set("emitter_sets", shared ? kSets : 1);
    program.set("emitters_per_set", !parts_ ? 0 : shared ? params_.aimed_rays : kSets * params_.aimed_rays);
    program.set("near_radius2", parts_ ? near_radius2_voxels_ : kAllIsNear);
}

std::vector<gl::Resource> Emitters::resources() const
{
    if (!apart_) return {};
    std::vector<gl::Resource> all = pyramid_->resources();
    for (gl::Resource& resource : all) resource.name = "emission pyramid";
    all.push_back(parts_.resource());
    return all;
}

Need Emitters::need() const
{
    const std::string share = std::to_string(int(100.0f * emitting_share_ + 0.5f)) + " % of the scene's area shines";
    return {"rays aimed at emitters", apart_,
            emitting_share_ == 0.0f   ? "no material shines"
            : params_.aimed_rays == 0 ? "aimed_rays=0"
                                      : share};
}

float emitting_share(const Scene& scene)
{
    double emitting = 0.0, all = 0.0;
    for (const Draw& draw : scene.draws) {
        const Material& material = scene.materials[std::size_t(draw.material)];
        const bool shines = material.emission != glm::vec3(0.0f) || material.unlit;
        for (std::size_t i = draw.first_index; i < std::size_t(draw.first_index) + draw.index_count; i += 3) {
            const auto corner = [&](std::size_t k) {
                return glm::dvec3(scene.vertices[scene.indices[i + k]].position);
            };
            const double area = 0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
            all += area;
            emitting += shines ? area : 0.0;
        }
    }
    return all > 0.0 ? float(emitting / all) : 0.0f;
}

// snippet: power
glm::dvec3 emitted_power_w(const VoxelFaces& faces, const VoxelGrid& grid)
{
    const double face_area_m2 = double(grid.voxel_size_m()) * double(grid.voxel_size_m());
    const auto all = faces.faces().read<shared::VoxelFace>();
    glm::dvec3 power(0.0);
    for (std::size_t i = 0; i < faces.face_count(); ++i)
        power += std::numbers::pi * glm::dvec3(all[i].emission) * double(all[i].albedo_area.a) * face_area_m2;
    return power;
}
// end snippet

}  // namespace conebook
