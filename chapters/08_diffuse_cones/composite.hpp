// The picture as the sum of its parts.
#pragma once

#include "02_g_buffer/g_buffer.hpp"
#include "app/parameters.hpp"

namespace conebook {

// Which parts of the light a view shows, 1 or 0 each.
struct LightParts {
    float direct = 0.0f, diffuse = 0.0f, specular = 0.0f, emission = 0.0f;
    bool ambient = false;
};
LightParts parts_of_view(const std::string& view);

struct CompositeParams {
    float bounce_strength = 1.0f;  // artistic factor on indirect light, 0 .. 10; 1 is right
    float ao_strength = 0.0f;      // artistic: indirect light times mix(1, ambient, this), 0 .. 1; 0 is right
    // The same on direct light, which is as wrong as it looks: what occludes nothing of a lamp darkens its light (Villegas
    // 2016, section 3.6.5). For comparison.
    bool ao_on_direct = false;
    bool operator==(const CompositeParams&) const = default;
};
void add_parameters(ParameterTable& table, CompositeParams& params);

class CompositePass {
public:
    explicit CompositePass(gl::Shaders& shaders);
    // RGBA32F, radiance, alpha 1 where there is a surface. A null input counts as black.
    const gl::Texture& run(const GBuffer& g_buffer, const gl::Texture* direct, const gl::Texture* gathered,
                           const gl::Texture* specular, const LightParts& parts, const CompositeParams& params,
                           float sky_radiance);

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture black_, color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
