#include "03_shadow_map/layer_view.hpp"

#include <algorithm>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, LayerViewParams& params)
{
    table.add("layer", params.layer, 0, 65535, "", "the shadow map that view shadow_map shows");
}

LayerViewPass::LayerViewPass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "03_shadow_map/layer_view.frag"}))
{
}

const gl::Texture& LayerViewPass::run(const ShadowMaps& maps, const LayerViewParams& params, glm::ivec2 size)
{
    gl::fit_to_pixels(color_, framebuffer_, "shadow map view", GL_RGBA16F, size);
    maps.depth().bind(GLuint(shared::kShadowMapUnit));
    const int layer = std::clamp(params.layer, 0, std::max(maps.layers() - 1, 0));
    const shared::ShadowLayer shown =
        maps.layers() > 0 ? maps.layer(layer) : shared::ShadowLayer{glm::mat4(1.0f), glm::ivec4(0, 0, 0, 1)};
    program_.set("place", glm::ivec3(shown.place));
    program_.set("side", shown.place.w);
    program_.set("scene_from_clip", glm::inverse(shown.clip_from_scene));
    program_.set("picture_size", glm::vec2(size));
    gl::draw_pixels(program_, framebuffer_, no_vertices_, size);
    return color_;
}

}  // namespace conebook
