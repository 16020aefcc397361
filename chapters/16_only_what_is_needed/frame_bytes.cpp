#include "16_only_what_is_needed/frame_bytes.hpp"

#include <cmath>

namespace conebook {

namespace {

double cells_of(glm::ivec3 size) { return double(size.x) * double(size.y) * double(size.z); }

// All levels of a pyramid over so many cells.
double with_levels(double cells, int levels) { return cells * (1.0 - std::pow(0.125, levels)) / (1.0 - 0.125); }

// Of chapter 07's formats, with the coverage that r11g11b10f keeps apart.
double bytes_of_texel(LightFormat format)
{
    constexpr double kBytes[] = {8.0, 4.0, 5.0};
    return kBytes[int(format)];
}

}  // namespace

SceneSize size_of(const GpuScene& scene, const SceneTraits& traits)
{
    SceneSize size;
    size.bounds = scene.bounds();
    size.triangles = scene.triangle_count();
    for (const MaterialUse& use : scene.material_uses()) {
        size.box_sides_m += use.box_sides_m;
        size.seen_areas_m2 += use.seen_areas_m2;
    }
    for (const gl::Resource& resource : scene.resources()) size.bytes += resource.bytes;
    constexpr int kAnySize = 1024;  // texels; the number of maps does not depend on it
    for (const Light& light : scene.lights())
        size.shadow_maps += shadow_matrices(light, scene.bounds(), nullptr, kAnySize).size();
    size.emitters_apart = traits.shines;
    return size;
}

// snippet: expected_faces
double expected_faces(const SceneSize& scene, double voxel_size_m)
{
    // A flat surface that is much larger than a voxel meets about as many as its shadows on the three planes have squares;
    // what it meets with its edges is not counted here, for the next triangle meets the same voxels.
    return scene.seen_areas_m2 / (voxel_size_m * voxel_size_m);
}
// end snippet

double expected_bytes(const SceneSize& scene, const FrameSettings& settings, const LightPlan& plan, glm::ivec2 size)
{
    double bytes = double(scene.bytes);
    if (plan.shadow_maps.used) {
        const double side = settings.scene.shadow_maps.shadow_map_size;
        bytes += double(scene.shadow_maps) * side * side * 4.0;
    }
    const shared::GridData grid = make_grid(scene.bounds, settings.scene.voxels.grid);
    const glm::ivec3 grid_size(grid.size);
    const double v = grid.origin.w, cells = cells_of(grid_size), faces = expected_faces(scene, v);
    if (plan.voxels.used) {
        // Of all triangles together, the voxels that one meets on the average over where the grid begins: the volume of
        // triangle + voxel (Minkowski sum), over the voxel's.
        const double fragments = double(scene.triangles) + scene.box_sides_m / v + scene.seen_areas_m2 / (v * v);
        constexpr double kOccupancy = 4.0, kFaceIndex = 4.0, kBlockCounts = 16.0 / 64.0;
        constexpr double kFace = 104.0 + 64.0 + 4.0 + 4.0 + 16.0 + 4.0;  // sums, means, two lists, radiance, visibility
        bytes += kOccupancy * with_levels(cells, grid.size.w) + (kFaceIndex + kBlockCounts) * cells;
        bytes += 8.0 * fragments + kFace * faces;
    }
    if (plan.pyramid.used) {
        const double texels = with_levels(double(shared::kFaceCount) * cells, grid.size.w);
        bytes += bytes_of_texel(settings.scene.voxels.pyramid.format) * texels + 4.0 * cells_of(grid_size + 1);
        if (scene.emitters_apart || plan.makes_everything) bytes += bytes_of_texel(LightFormat::rgba16f) * texels;
    }
    if (plan.further_bounces.used) {
        const double from_emitters = scene.emitters_apart || plan.makes_everything ? 16.0 : 0.0;
        bytes += faces * (4.0 * settings.scene.bounces.links + from_emitters + 4.0 + 2.0 * 8.0 + 16.0);
    }
    if (plan.visibility_volume.used) bytes += 4.0 * double(shared::kFaceCount) * cells;

    // A pixel's g-buffer, and what passes write; a point's.
    const double pixels = double(size.x) * double(size.y);
    const bool shares = settings.camera.cones.interleave == Interleave::on;
    const double points =
        pixels /
        (shares ? double(settings.camera.diffuse.gather_scale) * double(settings.camera.diffuse.gather_scale) : 1.0);
    bytes += 44.0 * pixels;
    if (settings.camera.accumulation.accumulate) bytes += 2.0 * 16.0 * pixels;
    if (plan.direct_light.used) bytes += 16.0 * pixels;
    if (plan.diffuse_cones.used) bytes += (shares ? 16.0 : 0.0) * pixels + 16.0 * (shares ? 4.0 : 2.0) * points;
    if (plan.diffuse_cones.used && (scene.emitters_apart || plan.makes_everything))
        bytes += 16.0 * pixels + 16.0 * 6.0 * points;
    if (plan.specular_cones.used) bytes += 2.0 * 16.0 * pixels;
    return bytes;
}

}  // namespace conebook
