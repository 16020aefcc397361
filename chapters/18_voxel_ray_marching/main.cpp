// 18_voxel_ray_marching: triangles cut small, scattered into voxels, and rays through them, all of it in every frame.
//
//     L = Le + rho/pi E  (piece),    I = 1/n sum_rays L(first piece along normalize(n + w R)),    K = D + rho I
//
// No voxelizer, no pyramid, no cones: the road of Ropret 2013, with what is wrong in it put right.
// Page: docs/18_voxel_ray_marching.md
#include "01_first_light/first_light.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "08_diffuse_cones/composite.hpp"
#include "18_voxel_ray_marching/ray_marching.hpp"
#include "18_voxel_ray_marching/tapped_light.hpp"
#include "app/needs.hpp"
#include "gl/pose_pass.hpp"

using namespace conebook;

namespace {

struct Params {
    float time = 0.0f;  // s, 0 .. 1e5: the pose of everything that moves
    CubeParams cube;
    CutParams cut;
    PieceVoxelParams voxels;
    RayParams rays;
    ShadowMapParams shadow_maps;
    TapParams taps;
    CompositeParams composite;
    DisplayParams display;
};

ParameterTable parameter_table(Params& p)
{
    ParameterTable table = parameters_of(p.cube, p.cut, p.voxels, p.rays, p.shadow_maps, p.taps, p.display);
    table.add("bounce_strength", p.composite.bounce_strength, 0.0, 10.0, "", "a of K = D + rho I a; 1 is right");
    table.add("time", p.time, 0.0, 1e5, "s", "the pose of everything that moves");
    return table;
}

std::vector<View> views()
{
    return joined({{"final", Encoding::radiance, "direct and indirect light, and emission"},
                   {"direct", Encoding::radiance, "direct light alone"},
                   {"indirect_diffuse", Encoding::radiance, "light of one bounce, times the albedo"},
                   {"stream_out", Encoding::radiance, "the list of pieces, drawn as points"},
                   {"voxels", Encoding::radiance, "what the voxels hold"},
                   {"unblurred", Encoding::radiance, "what each point gathers, E / pi, before they share it"}},
                  surface_views());
}

}  // namespace

int main(int argc, char** argv)
try {
    Params params;
    App app(argc, argv, {"18_voxel_ray_marching", views(), parameter_table(params)});

    GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, params.display));
    const Bounds all_poses = scene.may_move() ? swept_bounds(app.scene()) : scene.bounds();
    PosePass poses(app.shaders(), app.scene());
    ShadowMaps shadow_maps(app.shaders());
    VoxelGrid grid(all_poses, params.cube.grid);
    StreamOut list(app.shaders());
    PieceVoxels voxels(app.shaders());
    GBuffer g_buffer(app.shaders(), app.size());
    GBufferViewPass g_buffer_view(app.shaders());
    TappedLight lighting(app.shaders());
    RayMarching rays(app.shaders());
    PieceViews piece_views(app.shaders());
    CompositePass composite(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // Where everything is now.
        if (scene.may_move())
            app.pass("pose", Scope::scene, [&] {
                const std::vector<NodePose> nodes = pose_nodes(app.scene(), double(params.time));
                poses.run(scene, nodes);
                scene.set_lights(posed_lights(app.scene(), nodes));
            });

        // (1) What the lights see.
        app.pass("shadow maps", Scope::light, [&] {
            shadow_maps.forget();
            shadow_maps.draw(scene, params.shadow_maps);
        });

        // snippet: frame
        // (2) Triangles -> list of pieces -> their light.
        fit_cube(grid, all_poses, app.scene().origin_ws, params.cube);
        app.pass("stream out", Scope::scene, [&] { list.cut(scene, grid, params.cut); });
        app.pass("light", Scope::light, [&] { list.light(scene, shadow_maps); });

        // (3) What the camera sees, and its direct light D.
        g_buffer.resize(app.size());
        app.pass("g-buffer", [&] { g_buffer.draw(scene, app.camera()); });
        const gl::Texture* direct = nullptr;
        app.pass("direct light", [&] { direct = &lighting.run(g_buffer, scene, shadow_maps, params.taps); });

        // (4) The list -> voxels.
        app.pass("scatter", Scope::light, [&] { voxels.run(list, grid, params.voxels); });

        // (5) Rays through them: I.
        const gl::Texture* gathered = nullptr;
        if (params.rays.bounces > 0)
            app.pass("rays", [&] { gathered = &rays.run(g_buffer, grid, voxels, params.rays); });
        // end snippet

        // (6) K = D + rho I a.
        const gl::Texture* linear = nullptr;
        app.pass("composite", [&] {
            linear = &composite.run(g_buffer, direct, gathered, nullptr, parts_of_view(app.view().name),
                                    params.composite, params.rays.sky);
        });

        // Another view, if one was asked for.
        const gl::Buffer camera("camera", std::vector{app.camera()});
        app.pass("view", [&] {
            if (const gl::Texture* attachment = g_buffer_view.run(g_buffer, app.view().name)) linear = attachment;
            if (app.shows("stream_out")) linear = &piece_views.points(list, camera, app.size());
            if (app.shows("voxels")) linear = &piece_views.cubes(voxels, camera, app.size());
            if (app.shows("unblurred") && gathered != nullptr) linear = &rays.unblurred(app.size());
        });
        app.show(*linear,
                 tone_map.run(*linear, app.view().encoding, params.display, data_scale(app.view(), scene.bounds())));
    });

    app.statistics().set_counts({{"triangles", double(scene.triangle_count()), ""},
                                 {"pieces", double(list.count()), ""},
                                 {"occupied voxels", double(voxels.occupied()), ""}});
    for (const auto& part : {scene.resources(), poses.resources(), shadow_maps.resources(), list.resources(),
                             voxels.resources(), g_buffer.resources(), lighting.resources(), rays.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs :
         {surface_needs(app.scene()), shadow_maps.needs(scene), ray_needs(params.rays, params.voxels)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene()), sky_need(params.rays.sky)});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
