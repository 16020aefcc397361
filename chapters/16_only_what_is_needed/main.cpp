// 16_only_what_is_needed: storage that follows the surface.
//
// Every occupied face walks a few rays once and keeps the faces where they end, its links. Light then goes round along them:
//
//     R(k) = R(0) + rho / n * sum_links (R + Le),     R(0) = (rho / pi) E_direct
//
// Page: docs/12_second_bounce.md
#include "01_first_light/first_light.hpp"
#include "12_second_bounce/camera_light.hpp"
#include "16_only_what_is_needed/brick_storage.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    SceneLightParams scene_params;
    CameraLightParams camera_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(scene_params, camera_params, display_params);
    add_storage_parameter(parameters, scene_params);

    App app(argc, argv, {"16_only_what_is_needed", light_views(), parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    BrickStorage bricks(app.shaders(), scene_params);
    SceneLight scene_light(app.shaders(), app.scene(), scene, scene_params, bricks.storages());
    CameraLight camera_light(app.shaders(), scene_light, app.size(), camera_params);
    ToneMapPass tone_map(app.shaders());
    const SceneTraits traits = traits_of(app.scene());
    const auto make_plan = [&] {
        return plan_light(traits, scene_params.voxels.shading, scene_params.bounces, camera_params.shadows);
    };

    app.each_frame([&] {
        // Which passes this takes.
        const LightPlan plan = make_plan();

        // What has changed of: shadow maps -> voxels -> their direct light -> all bounces -> six pyramids.
        scene_light.run(app, scene, camera_params.cones, plan);

        // What the camera sees, and what of it the lights reach.
        camera_light.see(app, scene);

        // What other surfaces send: diffuse and specular cones through the pyramids.
        camera_light.gather(app, plan);

        // Their sum; the mean of many frames while nothing changes.
        const gl::Texture& linear = camera_light.sum(app);

        // Exposure, tone curve, sRGB.
        app.show(linear, tone_map.run(linear, app.view().encoding, display_params,
                                      data_scale(app.view(), scene.bounds())));
    });

    app.statistics().set_counts(scene_light.counts());
    for (const auto& part : {scene.resources(), bricks.resources(), scene_light.resources(), camera_light.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs :
         {scene_light.needs(app.scene(), scene), camera_light.needs(app.scene()), make_plan().decisions()})
        app.statistics().add_needs(needs);
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
