// 04_conservative_voxelization: triangles become voxels, and none of them slips through the grid.
//
// A voxel is occupied when it overlaps a triangle. The rasterizer, looking along the triangle's dominant axis, finds the
// columns of the grid that the triangle may touch; an exact test decides for the one to three voxels of each column:
//
//     overlap  <=>  no axis a of the 13 separates:  max_i a.p_i < -r(a)  or  min_i a.p_i > r(a),  r(a) = |a|_1 / 2
//
// Page: docs/04_conservative_voxelization.md
#include "01_first_light/tone_map.hpp"
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

    App app(argc, argv,
            {"04_conservative_voxelization",
             {{"final", Encoding::color, "occupied voxels as cubes (level=, shaded=)"},
              {"voxels", Encoding::color, "the same"},
              {"fragments", Encoding::color, "how many triangles share a voxel: 1 dark blue, 2, 4, 8, 16 and more red"}},
             parameters});

    const GpuScene scene(app.scene());
    const VoxelGrid grid(scene.bounds(), grid_params);
    ConservativeVoxelizer voxelizer(app.shaders(), grid, voxelizer_params);
    VoxelViewPass voxel_view(app.shaders());
    ToneMapPass tone_map(app.shaders());

    while (app.next_frame()) {
        // Triangles -> occupied voxels, at all levels.
        app.pass("voxelize", Scope::scene, [&] { return voxelizer.run(scene, grid); });

        // Occupied voxels -> picture.
        if (app.shows("fragments")) view_params.level = 0;
        view_params.heat = app.shows("fragments") ? &voxelizer.fragment_counts() : nullptr;
        const gl::Buffer camera("camera", std::vector{app.camera()});
        const gl::Texture* linear = nullptr;
        app.pass("voxel view",
                 [&] { linear = &voxel_view.run(grid, voxelizer.occupancy(), view_params, camera, app.size()); });
        const gl::Texture& display = tone_map.run(*linear, app.view().encoding, display_params);
        app.show(*linear, display);
    }

    // Count what was made.
    const auto counted = voxelizer.statistics_buffer().read_at<shared::VoxelStatistics>(0);
    double occupied = 0.0, most = 0.0;
    for (const GLuint fragments : gl::read_uints(voxelizer.fragment_counts())) {
        occupied += fragments != 0u ? 1.0 : 0.0;
        most = std::max(most, double(fragments));
    }
    const glm::ivec3 size = grid.size();
    app.statistics().set_counts({{"grid x", double(size.x), "voxels"},
                                 {"grid y", double(size.y), "voxels"},
                                 {"grid z", double(size.z), "voxels"},
                                 {"voxel size", grid.voxel_size_m(), "m"},
                                 {"occupied voxels", occupied, ""},
                                 {"fragments", double(counted.fragments), ""},
                                 {"fragments per occupied voxel", counted.fragments / std::max(occupied, 1.0), ""},
                                 {"most fragments in a voxel", most, ""},
                                 {"triangles without area", double(counted.degenerate), ""}});
    for (const auto& part : {scene.resources(), voxelizer.resources()})
        app.statistics().add_resources(part);
    app.statistics().add_needs({{"materials and lights", false, "occupancy is a question of triangles alone"}});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
