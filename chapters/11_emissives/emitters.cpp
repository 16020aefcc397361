#include "11_emissives/emitters.hpp"

#include <numbers>

namespace conebook {

namespace {

// Rays are better while emitters are small, and still so at a fifth of all surfaces (disc of 22 %, 0.9 m above a plane:
// 1.042 of the closed form by cones alone, 1.011 with rays). In rooms that shine all over cones are exact, and faster.
constexpr double kLargeShare = 0.3;

}  // namespace

void add_parameters(ParameterTable& table, EmitterParams& params)
{
    table.add("aimed_rays", params.aimed_rays, 0, 64, "", "rays aimed at emitters; 0: cones meet them by chance");
}

bool Emitters::run(const GpuScene& gpu_scene, const VoxelGrid& grid, const VoxelFaces& faces,
                   const VoxelShading& shading, const EmitterParams& params, VoxelStorage storage, bool of_nothing)
{
    if (!made_from_.differs(faces.revision(), params, storage, of_nothing)) return false;
    ++revision_;
    if (parts_made_from_.differs(grid.revision(), gpu_scene.geometry_revision(), params, of_nothing)) {
        params_ = params;
        emitters_ = make_emitter_parts(scene_, grid.data(), kSets * params.aimed_rays, kSets);
        apart_ = params.aimed_rays > 0 && (shine() || of_nothing) && emitters_.emitting_share < kLargeShare;
        if (apart_ && !shine()) emitters_.parts.assign(std::size_t(kSets * params.aimed_rays), shared::EmitterPart{});
        triangles_ = apart_ ? gl::Buffer("emitter triangles", emitters_.triangles) : gl::Buffer();
        parts_ = apart_ ? gl::Buffer("emitter parts", emitters_.parts) : gl::Buffer();
    }
    PyramidParams pyramid;
    pyramid.storage = storage;
    if (apart_) pyramid_.run(grid, faces, shading.radiance(), shading.revision(), pyramid, LightPart::emitted);
    return apart_ || shine();
}

void Emitters::bind_emission() const
{
    if (apart_) pyramid_.bind_as_emission();
}

void Emitters::bind(const gl::Program& program) const
{
    parts_.bind(GL_SHADER_STORAGE_BUFFER, shared::kEmitterBinding);
    triangles_.bind(GL_SHADER_STORAGE_BUFFER, shared::kEmitterTriangleBinding);
    program.set("emitter_triangle_count", int(emitters_.triangles.size()));
    program.set("aimed_part_count", kSets * params_.aimed_rays);
    program.set("emitter_part_count", int(emitters_.parts.size()));
    program.set("emitter_sets", kSets);
}

std::vector<gl::Resource> Emitters::resources() const
{
    if (!apart_) return {};
    std::vector<gl::Resource> all = pyramid_.resources();
    for (gl::Resource& resource : all) resource.name = "emission pyramid";
    all.push_back(parts_.resource());
    all.push_back(triangles_.resource());
    return all;
}

Need Emitters::need() const
{
    const std::string share =
        std::to_string(int(100.0 * emitters_.emitting_share + 0.5)) + " % of the scene's area shines";
    return {"rays aimed at emitters", apart_,
            !shine()                  ? "no material shines"
            : params_.aimed_rays == 0 ? "aimed_rays=0"
                                      : share};
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
