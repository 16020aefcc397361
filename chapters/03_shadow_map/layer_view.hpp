// One of the shadow maps as a picture.
#pragma once

#include "03_shadow_map/shadow_maps.hpp"

namespace conebook {

struct LayerViewParams {
    int layer = 0;  // of all maps, 0 .. 65535; those of a point light are +x -x +y -y +z -z
};
void add_parameters(ParameterTable& table, LayerViewParams& params);

class LayerViewPass {
public:
    explicit LayerViewPass(gl::Shaders& shaders);
    // RGBA16F: distance as grey, 1 at the map's near plane .. 0 at its far one and where nothing is.
    const gl::Texture& run(const ShadowMaps& maps, const LayerViewParams& params, glm::ivec2 size);

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
