// Pictures of the radiosity: the scene with its light, the maps, and the lights as arrows.
#pragma once

#include "08_diffuse_cones/composite.hpp"
#include "19_vertex_radiosity/vertex_radiosity.hpp"

namespace conebook {

struct RadiosityViewParams {
    // Which light view the views ray_map and reduction show, 0 .. 65535; those of a point light are +x -x +y -y +z -z.
    int layer = 0;
};
void add_parameters(ParameterTable& table, RadiosityViewParams& params);

class RadiosityView {
public:
    explicit RadiosityView(gl::Shaders& shaders);

    // All RGBA32F, valid until the next call.

    // Radiance, W/(sr m^2), alpha 1 where there is a surface.
    const gl::Texture& draw(const VertexRadiosity& radiosity, const GpuScene& scene, const shared::CameraData& camera,
                            glm::ivec2 size, const LightParts& parts);
    // The same at a quarter of its brightness, with arrows over it: red where the lights of the scene are, green the
    // lights of step 2, blue those of step 3; the stronger, the longer.
    const gl::Texture& draw_lights(const VertexRadiosity& radiosity, const GpuScene& scene,
                                   const shared::CameraData& camera, glm::ivec2 size);
    // Irradiance of all patches, W/m^2.
    const gl::Texture& draw_map(const VertexRadiosity& radiosity, glm::ivec2 size);
    // What a light sees, a colour for each patch, brighter where it has more light; `reduced`: and the levels down to
    // the cells. Black when no light looks.
    const gl::Texture& draw_light_view(VertexRadiosity& radiosity, const GpuScene& scene,
                                       const RadiosityViewParams& params, bool reduced, glm::ivec2 size);

private:
    void begin(glm::ivec2 size);
    gl::Program scene_program_, arrow_program_, map_program_, level_program_;
    gl::VertexArray no_vertices_, arrows_;
    gl::Buffer camera_buffer_;
    gl::Texture color_, depth_;
    gl::Framebuffer target_;
};

}  // namespace conebook
