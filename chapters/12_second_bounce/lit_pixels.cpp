#include "12_second_bounce/lit_pixels.hpp"

#include "app/needs.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, LitPixelParams& params)
{
    add_parameters(table, params.cones);
    add_parameters(table, params.diffuse);
    add_parameters(table, params.specular);
    add_parameters(table, params.shadows);
    add_parameters(table, params.composite);
}

std::vector<View> light_views()
{
    return joined({{"final", Encoding::radiance, "all light"},
                   {"direct", Encoding::radiance, "direct light alone"},
                   {"indirect_diffuse", Encoding::radiance, "indirect light through the diffuse lobe"},
                   {"indirect_specular", Encoding::radiance, "indirect light through the specular lobe"},
                   {"ambient_occlusion", Encoding::data, "share of the hemisphere that is open"},
                   {"voxels", Encoding::radiance, "radiance of the voxels after the last bounce"}},
                  surface_views());
}

LitPixels::LitPixels(gl::Shaders& shaders, const VoxelGrid& grid, Emitters& emitters, glm::ivec2 size,
                     const LitPixelParams& params)
    : params_(params),
      emitters_(emitters),
      cones_(params.cones),
      g_buffer_(shaders, size),
      direct_lighting_(shaders, grid, ShadowMethod(params.shadows.shadows)),
      diffuse_cones_(shaders, grid, params.diffuse, emitters.are_apart()),
      specular_cones_(shaders, emitters.are_apart()),
      composite_(shaders),
      pyramid_view_(shaders),
      g_buffer_view_(shaders)
{
}

const gl::Texture& LitPixels::run(App& app, const GpuScene& scene, const LitVoxels& voxels,
                                  const ShadowMaps& shadow_maps, bool indirect)
{
    // What the camera sees.
    g_buffer_.resize(app.size());
    app.pass("g-buffer", [&] { g_buffer_.draw(scene, app.camera()); });

    // Light straight from the lights.
    app.pass("direct light", [&] {
        direct_ = &direct_lighting_.run(g_buffer_, scene, voxels, shadow_maps, params_.cones, params_.shadows, false);
    });

    // Light by way of other surfaces: many narrow cones for the diffuse lobe, one for the specular one.
    gathered_ = specular_ = nullptr;
    if (indirect) {
        app.pass("diffuse cones", [&] {
            gathered_ = &emitters_.gather(diffuse_cones_, g_buffer_, voxels.grid(), voxels.pyramid(), cones_,
                                          params_.cones);
        });
        if (has_specular_surfaces(app.scene()))
            app.pass("specular cones", [&] {
                specular_ = &specular_cones_.run(g_buffer_, voxels.grid(), voxels.pyramid(), params_.cones,
                                                 params_.specular, emitters_.all_light());
            });
    }

    // Sum, or one of the intermediate results.
    const gl::Texture* linear = nullptr;
    app.pass("composite", [&] {
        const gl::Buffer camera("camera", std::vector{app.camera()});
        if (app.shows("voxels"))
            linear = &pyramid_view_.run(voxels.grid(), voxels.voxelizer().occupancy(), voxels.pyramid(), 0,
                                        PyramidViewParams{}, false, camera, app.size(), emitters_.pyramid());
        else if (linear = g_buffer_view_.run(g_buffer_, app.view().name); linear == nullptr)
            linear = &composite(app.view().name);
    });
    return *linear;
}

const gl::Texture& LitPixels::composite(const std::string& view)
{
    return composite_.run(g_buffer_, direct_, gathered_, specular_, parts_of_view(view), params_.composite,
                          params_.cones.sky);
}

std::vector<gl::Resource> LitPixels::resources() const
{
    std::vector<gl::Resource> all = g_buffer_.resources();
    for (const auto& part : {direct_lighting_.resources(), diffuse_cones_.resources(), specular_cones_.resources()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<Need> LitPixels::needs(const Scene& scene, bool indirect) const
{
    std::vector<Need> all = direct_lighting_.needs();
    const std::string direct_alone = "bounces=0: direct light alone";
    all.push_back({"diffuse cones", indirect, indirect ? "for indirect light" : direct_alone});
    all.push_back(indirect ? specular_cone_need(scene) : Need{"specular cones", false, direct_alone});
    all.push_back(sky_need(params_.cones.sky));
    return all;
}

}  // namespace conebook
