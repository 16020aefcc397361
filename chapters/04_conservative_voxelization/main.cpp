// 04_conservative_voxelization: triangles become voxels, and none of them slips through the grid.
//
// A voxel is occupied when it overlaps a triangle. Looking along the triangle's dominant axis, the rasterizer or a
// thread finds the columns of the grid that the triangle may touch; an exact test decides for the one to three voxels
// of each:
//
//     overlap  <=>  no axis a of the 13 separates:  max_i a.p_i < -r(a)  or  min_i a.p_i > r(a),  r(a) = |a|_1 / 2
//
// Page: docs/04_conservative_voxelization.md
#include "01_first_light/first_light.hpp"
#include "04_conservative_voxelization/conservative_voxelizer.hpp"
#include "app/app.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    VoxelGridParams grid_params;
    VoxelizerParams voxelizer_params;
    voxelizer_params.count_fragments = true;
    VoxelViewParams view_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(grid_params, voxelizer_params);
    parameters.add("conservative", voxelizer_params.conservative, "off: plain rasterization, which leaves holes");
    add_parameters(parameters, view_params);
    add_parameters(parameters, display_params);

    App app(
        argc, argv,
        {"04_conservative_voxelization",
         {{"final", Encoding::color, "occupied voxels as cubes (level=, shaded=)"},
          {"voxels", Encoding::color, "the same"},
          {"fragments", Encoding::color, "how many triangles share a voxel: 1 dark blue, 2, 4, 8, 16 and more red"}},
         parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    VoxelGrid grid(scene.bounds(), grid_params);
    ConservativeVoxelizer voxelizer(app.shaders());
    VoxelViewPass voxel_view(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // Triangles -> occupied voxels, at all levels.
        grid.fit(scene.bounds(), grid_params);
        app.pass("voxelize", Scope::scene, [&] { return voxelizer.run(scene, grid, voxelizer_params); });

        // Occupied voxels -> picture.
        VoxelViewParams shown = view_params;
        if (app.shows("fragments")) shown = {0, shown.shaded, &voxelizer.fragment_counts()};
        const gl::Buffer camera("camera", std::vector{app.camera()});
        const gl::Texture* linear = nullptr;
        app.pass("voxel view",
                 [&] { linear = &voxel_view.run(grid, voxelizer.occupancy(), shown, camera, app.size()); });
        const gl::Texture& display = tone_map.run(*linear, app.view().encoding, display_params);
        app.show(*linear, display);
    });

    // Count what was made.
    const auto counted = voxelizer.statistics_buffer().read_at<shared::VoxelStatistics>(0);
    double occupied = 0.0, most = 0.0;
    for (const GLuint fragments : gl::read_uints(voxelizer.fragment_counts())) {
        occupied += fragments != 0u ? 1.0 : 0.0;
        most = std::max(most, double(fragments));
    }
    const glm::ivec3 size = grid.size();
    const double fragments = double(voxelizer.fragments().count());
    app.statistics().set_counts({{"grid x", double(size.x), "voxels"},
                                 {"grid y", double(size.y), "voxels"},
                                 {"grid z", double(size.z), "voxels"},
                                 {"voxel size", grid.voxel_size_m(), "m"},
                                 {"occupied voxels", occupied, ""},
                                 {"fragments", fragments, ""},
                                 {"fragments per occupied voxel", fragments / std::max(occupied, 1.0), ""},
                                 {"most fragments in a voxel", most, ""},
                                 {"triangles without area", double(counted.degenerate), ""}});
    for (const auto& part : {scene.resources(), voxelizer.resources()}) app.statistics().add_resources(part);
    app.statistics().add_needs({{"materials and lights", false, "occupancy is a question of triangles alone"}});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
