#include "12_second_bounce/camera_light.hpp"

#include "app/needs.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, CameraLightParams& params)
{
    add_parameters(table, params.cones);
    add_parameters(table, params.diffuse);
    add_parameters(table, params.specular);
    add_parameters(table, params.shadows);
    add_parameters(table, params.composite);
    add_parameters(table, params.accumulation);
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

CameraLight::CameraLight(gl::Shaders& shaders, const SceneLight& light, glm::ivec2 size,
                         const CameraLightParams& params)
    : light_(light),
      params_(params),
      g_buffer_(shaders, size),
      direct_lighting_(shaders),
      diffuse_cones_(shaders),
      emitter_light_(shaders),
      specular_cones_(shaders),
      composite_(shaders),
      accumulation_(shaders),
      pyramid_view_(shaders),
      g_buffer_view_(shaders)
{
}

void CameraLight::see(App& app, const GpuScene& scene, const LightPlan& plan)
{
    direct_ = nullptr;
    sample_ = app.sample(params_.accumulation.accumulate, light_.revision());
    g_buffer_.resize(app.size());
    app.pass("g-buffer", [&] { g_buffer_.draw(scene, app.camera()); });
    if (plan.makes_everything && params_.shadows.shadows != ShadowMethod::volume)
        app.pass("visibility volume", [&] {
            direct_lighting_.fill_volume(light_.voxels().grid(), light_.voxels().faces(), light_.voxels().shading());
        });
    if (plan.direct_light.used)
        app.pass("direct light", [&] {
            direct_ = &direct_lighting_.run(g_buffer_, scene, light_.volumes(), light_.voxels().faces(),
                                            light_.voxels().shading(), light_.shadow_maps(), params_.cones,
                                            params_.shadows, false);
        });
}

void CameraLight::gather(App& app, const LightPlan& plan)
{
    gathered_ = specular_ = nullptr;
    if (plan.diffuse_cones.used) {
        directions_.update(params_.cones, sample_);
        app.pass("diffuse cones", [&] {
            gathered_ = &diffuse_cones_.run(g_buffer_, light_.volumes(), directions_, params_.cones, params_.diffuse,
                                            sample_);
        });
        app.pass("emitters' light", [&] {
            gathered_ = &emitter_light_.run(g_buffer_, light_.volumes(), light_.emitters(), diffuse_cones_, *gathered_,
                                            params_.cones, sample_);
            return light_.emitters().are_apart();
        });
    }
    if (plan.specular_cones.used)
        app.pass("specular cones", [&] {
            light_.emitters().bind_emission();
            specular_ = &specular_cones_.run(g_buffer_, light_.volumes(), params_.cones, params_.specular, sample_,
                                             light_.emitters().specular_folder());
        });
    if (!plan.shows_indirect) gathered_ = specular_ = nullptr;
}

const gl::Texture& CameraLight::sum(App& app)
{
    const gl::Texture* linear = nullptr;
    app.pass("composite", [&] {
        const gl::Buffer camera("camera", std::vector{app.camera()});
        const LitVoxels& voxels = light_.voxels();
        if (app.shows("voxels"))
            linear = &pyramid_view_.run(voxels.grid(), voxels.voxelizer().occupancy(), voxels.pyramid(), 0,
                                        PyramidViewParams{}, false, camera, app.size(), light_.emitters().pyramid());
        else if (linear = g_buffer_view_.run(g_buffer_, app.view().name); linear == nullptr)
            linear = &composite(app.view().name);
        if (params_.accumulation.accumulate && app.view().encoding == Encoding::radiance)
            linear = &accumulation_.add(*linear, sample_);
    });
    return *linear;
}

const gl::Texture& CameraLight::composite(const std::string& view)
{
    return composite_.run(g_buffer_, direct_, gathered_, specular_, parts_of_view(view), params_.composite,
                          params_.cones.sky);
}

std::vector<gl::Resource> CameraLight::resources() const
{
    std::vector<gl::Resource> all = g_buffer_.resources();
    for (const auto& part : {direct_lighting_.resources(), diffuse_cones_.resources(), emitter_light_.resources(),
                             specular_cones_.resources(), accumulation_.resources()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<Need> CameraLight::needs(const Scene& source) const
{
    std::vector<Need> all = surface_needs(source);
    all.push_back(sky_need(params_.cones.sky));
    return all;
}

}  // namespace conebook
