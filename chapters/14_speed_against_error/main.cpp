// 14_speed_against_error: chapter 12's frame under the stopwatch, with every texture fetch of its cones counted.
//
// A setting is worth its time when no other one is both faster and nearer to the truth:
//
//     Pareto front = { s : there is no s' with t(s') <= t(s), e(s') <= e(s), and one of them smaller }
//
// t: ms a frame, e: error against the path tracer. ./run report measures both for many settings.
// Page: docs/14_speed_against_error.md
#include "01_first_light/tone_map.hpp"
#include "12_second_bounce/second_bounce.hpp"
#include "14_speed_against_error/fetch_counter.hpp"
#include "14_speed_against_error/part_pictures.hpp"
#include "app/needs.hpp"

using namespace conebook;

namespace {

struct MeasureParams {
    // Count the fetches of the last frame's cones, after it has been timed.
    bool count_fetches = false;
    // Write all parts of the light of the last frame, see part_pictures.hpp.
    bool write_parts = false;
};

void add_parameters(ParameterTable& table, MeasureParams& params)
{
    table.add("count_fetches", params.count_fetches, "count what the cones fetch, for --stats; not in any pass's time");
    table.add("write_parts", params.write_parts, "with --output X.exr: also X_final.exr, X_direct.exr, ...");
}

}  // namespace

int main(int argc, char** argv)
try {
    LitVoxelParams voxel_params;
    ShadowMapParams shadow_map_params;
    BounceParams bounce_params;
    EmitterParams emitter_params;
    LitPixelParams pixel_params;
    DisplayParams display_params;
    MeasureParams measure_params;
    ParameterTable parameters = parameters_of(voxel_params, bounce_params, emitter_params, pixel_params,
                                              shadow_map_params, display_params, measure_params);

    App app(argc, argv,
            {"14_speed_against_error",
             joined(light_views(),
                    {{"fetches", Encoding::data, "texture fetches of a pixel's cones; .exr: diffuse, specular, both"}}),
             parameters});

    const GpuScene scene(app.scene());
    ShadowMaps shadow_maps(app.shaders(), scene, shadow_map_params);
    LitVoxels voxels(app.shaders(), scene, voxel_params);
    Emitters emitters(app.shaders(), app.scene(), voxels.grid(), voxels.voxelizer(), emitter_params);
    SecondBounce second_bounce(app.shaders(), emitters.are_apart());
    LitPixels pixels(app.shaders(), voxels.grid(), emitters, app.size(), pixel_params);
    FetchCounter fetch_counter(app.shaders(), emitters.are_apart());
    ToneMapPass tone_map(app.shaders());
    FetchCounts fetches;
    const bool indirect = bounce_params.bounces != 0;
    const bool asks_maps = ask_shadow_maps(pixel_params.shadows, voxel_params.shading);

    while (app.next_frame()) {
        // Chapter 12's frame: light, voxels, bounces, pixels.
        if (asks_maps) app.pass("shadow maps", [&] { shadow_maps.draw(scene); });
        voxels.run(app, scene, shadow_maps, emitters.part_of_voxels());
        if (voxels.are_new())
            app.pass("emitters", [&] { emitters.run(voxels.grid(), voxels.faces(), voxels.shading()); });
        app.pass("further bounces",
                 [&] { second_bounce.run(voxels, emitters, pixels.cones(), pixel_params.cones, bounce_params); });
        const gl::Texture& linear = pixels.run(app, scene, voxels, shadow_maps, indirect);

        // The same cones once more, to count: outside of every pass, so that no time holds it.
        const bool last = app.frame() + 1 == app.options().frames;
        if (app.shows("fetches") || (measure_params.count_fetches && last && indirect)) {
            fetch_counter.run(pixels.g_buffer(), voxels.grid(), voxels.pyramid(), emitters, pixels.cones(),
                              has_specular_surfaces(app.scene()) ? &pixels.specular_cones() : nullptr, pixel_params);
            fetches = fetch_counter.counts(pixels.g_buffer());
        }
        if (app.shows("fetches"))
            app.show(fetch_counter.show(pixels.g_buffer()), fetch_counter.heat_map(pixels.g_buffer(), fetches.largest));
        else
            app.show(linear,
                     tone_map.run(linear, app.view().encoding, display_params, data_scale(app.view(), scene.bounds())));
    }
    if (measure_params.write_parts && !app.options().output.empty()) {
        write_part_pictures(app.options().output, pixels);
        pixels.composite(app.view().name);  // where the parts were is what finish() writes
    }

    std::vector<Count> counts = voxels.counts();
    counts.push_back({"gatherings from voxel to voxel", double(second_bounce.gatherings()), ""});
    if (measure_params.count_fetches || app.shows("fetches")) {
        counts.push_back({"fetches per pixel, diffuse", fetches.diffuse, ""});
        counts.push_back({"fetches per pixel, specular", fetches.specular, ""});
        counts.push_back({"fetches per pixel", fetches.diffuse + fetches.specular, ""});
        counts.push_back({"fetches of the worst pixel", fetches.largest, ""});
    }
    for (const auto& needs : {surface_needs(app.scene()), voxel_material_needs(scene), shadow_maps.needs(scene),
                              pixels.needs(app.scene(), indirect)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene()), emitters.need()});
    app.statistics().set_counts(counts);
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxels.resources(), emitters.resources(),
                             second_bounce.resources(), pixels.resources()})
        app.statistics().add_resources(part);
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
