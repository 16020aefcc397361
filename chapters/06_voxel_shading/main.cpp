// 06_voxel_shading: the lights reach the voxels, and every occupied face knows what it sends out.
//
// One thread for each occupied face, none for the empty ones:
//
//     L = Le + (rho / pi) * sum_lights V E_l max(n.l, 0)        W/(sr m^2)
//
// with the visibility V from shadow maps or from rays through the voxels themselves.
// Page: docs/06_voxel_shading.md
#include "01_first_light/first_light.hpp"
#include "06_voxel_shading/voxel_shading.hpp"
#include "app/app.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    VoxelGridParams grid_params;
    VoxelizerParams voxelizer_params;
    VoxelShadingParams shading_params;
    ShadowMapParams shadow_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(grid_params, voxelizer_params, shading_params, shadow_params,
                                              display_params);

    App app(argc, argv,
            {"06_voxel_shading",
             {{"final", Encoding::radiance, "radiance of the voxels: emission and direct light"},
              {"voxels", Encoding::radiance, "the same"},
              {"visibility", Encoding::data, "share of the lights' light that reaches the face"},
              {"base_color", Encoding::color, "mean albedo"},
              {"normal", Encoding::data, "mean normal, 0.5 n + 0.5"},
              {"emission", Encoding::radiance, "mean emitted radiance"}},
             parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    VoxelGrid grid(scene.bounds(), grid_params);
    ShadowMaps shadow_maps(app.shaders());
    ConservativeVoxelizer voxelizer(app.shaders());
    VoxelFaces faces(app.shaders(), voxelizer);
    VoxelShading shading(app.shaders());
    FaceViewPass face_view(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // snippet: frame
        // What the lights see, unless rays through the voxels are to tell.
        if (shading_params.voxel_shadows == VoxelShadows::map)
            app.pass("shadow maps", Scope::light, [&] { return shadow_maps.draw(scene, shadow_params); });

        // Triangles -> occupied voxels -> list of faces with their mean material.
        grid.fit(scene.bounds(), grid_params);
        app.pass("voxelize", Scope::scene, [&] { return voxelizer.run(scene, grid, voxelizer_params); });
        app.pass("average", Scope::scene, [&] { return faces.run(scene, grid, voxelizer); });

        // Material and lights -> radiance of every face.
        app.pass("voxel shading", Scope::light, [&] {
            return shading.run(scene, grid, voxelizer, faces, shadow_maps, shading_params);
        });
        // end snippet

        // Faces -> picture. Offsets within shared::VoxelFace are in vec4.
        constexpr int kFaceStride = int(sizeof(shared::VoxelFace) / sizeof(glm::vec4));
        FaceQuantity quantity{&shading.radiance(), 1, 0, 0, nullptr, &faces.faces(), kFaceStride, 2};
        if (app.shows("visibility")) quantity = {&shading.radiance(), 1, 0, 2, nullptr};
        if (app.shows("base_color")) quantity = {&faces.faces(), kFaceStride, 0, 0, nullptr};
        if (app.shows("normal")) quantity = {&faces.faces(), kFaceStride, 1, 1, nullptr};
        if (app.shows("emission")) quantity = {&faces.faces(), kFaceStride, 2, 0, nullptr};
        const gl::Buffer camera("camera", std::vector{app.camera()});
        const gl::Texture* linear = nullptr;
        app.pass("voxel view", [&] {
            linear = &face_view.run(grid, voxelizer.occupancy(), faces, quantity, camera, app.size());
        });
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params));
    });

    app.statistics().set_counts({{"occupied voxels", double(faces.voxel_count()), ""},
                                 {"occupied faces", double(faces.face_count()), ""}});
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxelizer.resources(), faces.resources(), shading.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {voxel_material_needs(scene), shadow_maps.needs(scene)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene())});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
