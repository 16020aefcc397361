// 17_sparse_voxel_octree: the same light on a sparse octree, which keeps nothing where nothing is.
//
// Nodes are flagged and allocated level by level; each has bricks of 3^3 samples whose outer ones are its neighbours'
// too, so that a look-up within one brick is the look-up in a dense lattice:
//
//     level: the least sample spacing that is >= the cone's diameter,     uvw = (corner + 1/2 + 2 p) / pool
//
// Page: docs/17_sparse_voxel_octree.md
#include <cstdio>

#include "01_first_light/first_light.hpp"
#include "02_g_buffer/direct_lighting.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "08_diffuse_cones/accumulation.hpp"
#include "08_diffuse_cones/composite.hpp"
#include "09_specular_cones/specular_cones.hpp"
#include "17_sparse_voxel_octree/tree_light.hpp"
#include "17_sparse_voxel_octree/tree_shadows.hpp"
#include "17_sparse_voxel_octree/tree_tools.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    TreeLightParams tree_params;
    ConeParams cone_params;
    DiffuseConeParams diffuse_params;
    SpecularConeParams specular_params;
    SoftShadowParams shadow_params;
    CompositeParams composite_params;
    AccumulationParams accumulation_params;
    TreeViewParams view_params;
    TreeToolParams tool_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(tree_params);
    add_tree_cone_parameters(parameters, cone_params);
    add_parameters(parameters, diffuse_params);
    add_parameters(parameters, specular_params);
    add_tree_shadow_parameters(parameters, shadow_params);
    add_parameters(parameters, composite_params);
    add_parameters(parameters, accumulation_params);
    add_parameters(parameters, view_params);
    add_parameters(parameters, tool_params);
    add_parameters(parameters, display_params);

    App app(argc, argv, {"17_sparse_voxel_octree", joined(tree_views(), surface_views()), parameters});

    GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    ShadowMaps shadow_maps(app.shaders());
    TreeLight light(app.shaders(), scene, tree_params);
    GBuffer g_buffer(app.shaders(), app.size());
    DirectLightingPass direct_lighting(app.shaders(), Shadows::maps);
    TreeShadowLighting soft_lighting(app.shaders());
    ConeDirections directions;
    DiffuseCones diffuse_cones(app.shaders(), "17_sparse_voxel_octree");
    SpecularCones specular_cones(app.shaders());
    CompositePass composite(app.shaders());
    Accumulation accumulation(app.shaders());
    GBufferViewPass g_buffer_view(app.shaders());
    TreeViewPass tree_view(app.shaders());
    TestCone test_cone(app.shaders());
    MadeFrom<float> lights_turned_by;
    ToneMapPass tone_map(app.shaders());
    const Need specular_need = specular_cone_need(app.scene());

    app.each_frame([&] {
        // Where the lights are.
        if (lights_turned_by.differs(tool_params.turn_lights) && (tool_params.turn_lights != 0.0f || app.frame() > 0))
            scene.set_lights(turned_lights(app.scene().lights, scene.bounds(), tool_params.turn_lights));

        // What the lights see, if pixels or voxels ask.
        if (tree_params.update == Update::always) shadow_maps.forget();
        if (asks_shadow_maps(tree_params, shadow_params))
            app.pass("shadow maps", Scope::light, [&] { return shadow_maps.draw(scene, tree_params.shadow_maps); });

        // Triangles -> voxels -> octree -> direct light -> bricks, and bounces through them.
        light.run(app, scene, shadow_maps, cone_params, app.shows("photons"));

        // What the camera sees.
        const int sample = app.sample(accumulation_params.accumulate, light.revision());
        g_buffer.resize(app.size());
        const shared::CameraData camera =
            tool_params.orthographic ? camera_data(without_perspective(app.scene_camera(), scene.bounds(), app.size()),
                                                   app.size(), scene.bounds())
                                     : app.camera();
        app.pass("g-buffer", [&] { g_buffer.draw(scene, camera); });

        // Light straight from the lights.
        const gl::Texture* direct = nullptr;
        app.pass("direct light", [&] {
            if (shadow_params.shadows == ShadowMethod::cone) {
                direct = &soft_lighting.run(g_buffer, scene, light, cone_params, shadow_params);
                return;
            }
            shadow_maps.bind(direct_lighting.program());
            direct = &direct_lighting.run(g_buffer, scene, LightingOutput::direct);
        });

        // Light by way of other surfaces: cones that descend the tree.
        const gl::Texture *gathered = nullptr, *specular = nullptr;
        const auto bind = [&](const gl::Program& program) { light.bind(program); };
        if (tree_params.bounces != 0)
            app.pass("diffuse cones", [&] {
                directions.update(cone_params, sample);
                gathered = &diffuse_cones.run(g_buffer, light.grid(), bind, {}, directions, cone_params, diffuse_params,
                                              sample);
            });
        if (tree_params.bounces != 0 && specular_need.used)
            app.pass("specular cones", [&] {
                specular = &specular_cones.run(g_buffer, light.grid(), bind, {}, cone_params, specular_params, sample,
                                               "17_sparse_voxel_octree");
            });

        // Sum, or one of the other views.
        const gl::Texture* linear = nullptr;
        app.pass("composite", [&] {
            const std::string& view = app.view().name;
            if (linear = tree_view.run(light, view, view_params, camera, app.size()); linear != nullptr) return;
            if (linear = g_buffer_view.run(g_buffer, view); linear != nullptr) return;
            linear = &composite.run(g_buffer, direct, gathered, specular, parts_of(view, tool_params.up_to),
                                    composite_params, cone_params.sky);
            if (accumulation_params.accumulate && app.view().encoding == Encoding::radiance)
                linear = &accumulation.add(*linear, sample);
            if (view == "test_cone") linear = &test_cone.run(*linear, g_buffer, light, cone_params, tool_params);
        });
        app.show(*linear, tone_map.run(*linear, encoding_of(app.view(), view_params), display_params,
                                       data_scale(app.view(), scene.bounds())));
    });

    // What was asked for about nodes, in words.
    if (const NodeReport node = find_node(light.tree(), view_params); is_chosen(view_params))
        std::puts(description(node).c_str());
    if (app.shows("test_cone")) std::puts(description(test_cone.nodes(), light.tree()).c_str());

    app.statistics().set_counts(light.counts());
    for (const auto& part : {scene.resources(), shadow_maps.resources(), light.resources(), g_buffer.resources(),
                             direct_lighting.resources(), soft_lighting.resources(), diffuse_cones.resources(),
                             specular_cones.resources(), accumulation.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {surface_needs(app.scene()), voxel_material_needs(scene), shadow_maps.needs(scene)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene()), sky_need(cone_params.sky), specular_need});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
