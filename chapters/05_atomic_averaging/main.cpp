// 05_atomic_averaging: a thousand fragments in one voxel, and one right answer whatever their order.
//
// Each face of a voxel keeps 64-bit fixed point sums over its fragments; a fragment is the part of a triangle inside
// the voxel and weighs as much as its area A:
//
//     mean albedo = sum_i A_i rho_i / sum_i A_i      (the same for emission, normal and position)
//
// Page: docs/05_atomic_averaging.md
#include "01_first_light/first_light.hpp"
#include "05_atomic_averaging/naive_average.hpp"
#include "app/app.hpp"

using namespace conebook;

namespace {

// What a view shows of a face: offsets are those of shared::VoxelFace.
FaceQuantity quantity_of(const std::string& view, const VoxelFaces& faces)
{
    const int stride = int(sizeof(shared::VoxelFace) / sizeof(glm::vec4));
    if (view == "normal") return {&faces.faces(), stride, 1, 1, nullptr};
    if (view == "emission") return {&faces.faces(), stride, 2, 0, nullptr};
    if (view == "area") return {&faces.faces(), stride, 0, 2, nullptr};
    return {&faces.faces(), stride, 0, 0, nullptr};
}

}  // namespace

int main(int argc, char** argv)
try {
    VoxelGridParams grid_params;
    VoxelizerParams voxelizer_params;
    DisplayParams display_params;
    Averaging averaging = Averaging::sums;
    bool count_changes = false;
    ParameterTable parameters = parameters_of(grid_params, voxelizer_params, display_params);
    parameters.add("averaging", averaging, {"sums", "compare_and_swap", "compare_and_swap_truncating", "racing_store"},
                   "how final and base_color are averaged; all later chapters use the sums");
    parameters.add("count_changes", count_changes, "with --frames: count what differs from the first frame (slow)");

    App app(argc, argv,
            {"05_atomic_averaging",
             {{"final", Encoding::color, "mean albedo of the voxels' faces"},
              {"voxels", Encoding::color, "the same"},
              {"base_color", Encoding::color, "the same"},
              {"normal", Encoding::data, "mean normal, 0.5 n + 0.5"},
              {"emission", Encoding::radiance, "mean emitted radiance"},
              {"area", Encoding::data, "area inside the voxel, in voxel sides squared"},
              {"error", Encoding::data, "with averaging=: four times the difference from the sums"}},
             parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    VoxelGrid grid(scene.bounds(), grid_params);
    ConservativeVoxelizer voxelizer(app.shaders());
    VoxelFaces faces(app.shaders(), voxelizer);
    NaiveAverage naive_average(app.shaders());
    const NaiveAverage* naive = nullptr;  // what is shown instead of the sums
    FaceViewPass face_view(app.shaders());
    ToneMapPass tone_map(app.shaders());
    ChangeCounter changes;

    app.each_frame([&] {
        // Triangles -> occupied voxels.
        grid.fit(scene.bounds(), grid_params);
        app.pass("voxelize", Scope::scene, [&] { return voxelizer.run(scene, grid, voxelizer_params); });

        // Occupied voxels -> list of faces -> sums over fragments -> means.
        app.pass("average", Scope::scene, [&] { return faces.run(scene, grid, voxelizer); });
        naive = averaging != Averaging::sums ? &naive_average : nullptr;
        if (naive != nullptr)
            app.pass("naive average", [&] { naive_average.run(scene, grid, voxelizer, Averaging(averaging)); });

        if (count_changes) changes.look(faces, naive);

        // Faces -> picture.
        const gl::Buffer camera("camera", std::vector{app.camera()});
        FaceQuantity quantity = quantity_of(app.view().name, faces);
        const bool shows_albedo = app.shows("final") || app.shows("voxels") || app.shows("base_color");
        if (naive != nullptr && shows_albedo) quantity = {nullptr, 1, 0, 3, &naive->color()};
        if (app.shows("error")) {
            quantity.show = 4;
            quantity.packed = naive != nullptr ? &naive->color() : nullptr;
        }
        const gl::Texture* linear = nullptr;
        app.pass("voxel view",
                 [&] { linear = &face_view.run(grid, voxelizer.occupancy(), faces, quantity, camera, app.size()); });
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params));
    });

    const shared::VoxelStatistics counted = faces.counted();
    std::vector<Count> counts = {{"occupied voxels", double(counted.voxels), ""},
                                 {"occupied faces", double(counted.faces), ""},
                                 {"fragments", double(voxelizer.fragments().count()), ""},
                                 {"triangles without area", double(counted.degenerate), ""}};
    if (naive != nullptr) counts.push_back({"RMS error of the naive mean", rms_error(*naive, faces), ""});
    if (count_changes) counts.push_back({"values that changed between frames", changes.most_changed(), ""});
    app.statistics().set_counts(counts);
    for (const auto& part : {scene.resources(), voxelizer.resources(), faces.resources()})
        app.statistics().add_resources(part);
    app.statistics().add_needs(voxel_material_needs(scene));
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
