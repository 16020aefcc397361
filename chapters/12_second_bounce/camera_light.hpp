// What depends on the camera, chapters 02 and 08 to 11 in order: g-buffer -> direct light -> cones -> their sum.
#pragma once

#include "02_g_buffer/g_buffer_view.hpp"
#include "08_diffuse_cones/accumulation.hpp"
#include "11_emissives/emitter_light.hpp"
#include "12_second_bounce/scene_light.hpp"

namespace conebook {

struct CameraLightParams {
    ConeParams cones;
    DiffuseConeParams diffuse;
    SpecularConeParams specular;
    SoftShadowParams shadows;
    CompositeParams composite;
    AccumulationParams accumulation;
};
void add_parameters(ParameterTable& table, CameraLightParams& params);

// final, the parts that add up to it, and what the voxels hold; the names that CameraLight knows.
std::vector<View> light_views();

class CameraLight {
public:
    // `light` and `params` must outlive this.
    CameraLight(gl::Shaders& shaders, const SceneLight& light, glm::ivec2 size, const CameraLightParams& params);

    // The surfaces under the pixels, and the light that comes to them straight from the lights.
    void see(App& app, const GpuScene& scene, const LightPlan& plan = {});
    // What other surfaces send, by many narrow cones for the diffuse lobe and few for the specular one, if any surface has one.
    void gather(App& app, const LightPlan& plan);
    // RGBA32F: the sum, or another of the views; the mean of frames while nothing changes. Valid until the next call.
    const gl::Texture& sum(App& app);

    // RGBA32F: another of the views of light, of this frame alone. Valid until the next call.
    const gl::Texture& composite(const std::string& view);

    const GBuffer& g_buffer() const { return g_buffer_; }
    const ConeDirections& directions() const { return directions_; }
    const DiffuseCones& diffuse_cones() const { return diffuse_cones_; }
    const SpecularCones& specular_cones() const { return specular_cones_; }

    std::vector<gl::Resource> resources() const;
    std::vector<Need> needs(const Scene& source) const;

private:
    const SceneLight& light_;
    const CameraLightParams& params_;
    GBuffer g_buffer_;
    SoftShadowLighting direct_lighting_;
    ConeDirections directions_;
    DiffuseCones diffuse_cones_;
    EmitterLight emitter_light_;
    SpecularCones specular_cones_;
    CompositePass composite_;
    Accumulation accumulation_;
    PyramidViewPass pyramid_view_;
    GBufferViewPass g_buffer_view_;
    int sample_ = 0;
    const gl::Texture *direct_ = nullptr, *gathered_ = nullptr, *specular_ = nullptr;  // of this frame
};

}  // namespace conebook
