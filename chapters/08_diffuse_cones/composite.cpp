#include "08_diffuse_cones/composite.hpp"

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, CompositeParams& params)
{
    table.add("bounce_strength", params.bounce_strength, 0.0, 10.0, "",
              "artistic factor on indirect light; 1 is right");
    table.add("ao_strength", params.ao_strength, 0.0, 1.0, "", "artistic occlusion of indirect light; 0 is right");
    table.add("ao_on_direct", params.ao_on_direct, "ao_strength counts for direct light, too; off is right");
}

LightParts parts_of_view(const std::string& view)
{
    if (view == "direct") return {1, 0, 0, 0, false};
    if (view == "indirect_diffuse") return {0, 1, 0, 0, false};
    if (view == "indirect_specular") return {0, 0, 1, 0, false};
    if (view == "emission") return {0, 0, 0, 1, false};
    if (view == "ambient_occlusion") return {0, 0, 0, 0, true};
    return {1, 1, 1, 1, false};
}

CompositePass::CompositePass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "08_diffuse_cones/composite.frag"})),
      black_(gl::texture_2d("black", GL_RGBA16F, {1, 1}))
{
    black_.clear();
}

const gl::Texture& CompositePass::run(const GBuffer& g_buffer, const gl::Texture* direct, const gl::Texture* gathered,
                                      const gl::Texture* specular, const LightParts& parts,
                                      const CompositeParams& params, float sky_radiance)
{
    gl::fit_to_pixels(color_, framebuffer_, "composite", GL_RGBA32F, g_buffer.size());
    g_buffer.bind();
    (direct != nullptr ? *direct : black_).bind(16);
    (gathered != nullptr ? *gathered : black_).bind(17);
    (specular != nullptr ? *specular : black_).bind(18);
    program_.set("parts", glm::vec4(direct != nullptr ? parts.direct : 0.0f, gathered != nullptr ? parts.diffuse : 0.0f,
                                    specular != nullptr ? parts.specular : 0.0f, parts.emission));
    program_.set("show_ambient", parts.ambient);
    program_.set("bounce_strength", params.bounce_strength);
    const float ao_strength = gathered != nullptr ? params.ao_strength : 0.0f;  // without cones nothing is known
    program_.set("ao_strength", ao_strength);
    program_.set("direct_ao_strength", params.ao_on_direct ? ao_strength : 0.0f);
    program_.set("sky_radiance", glm::vec3(sky_radiance));
    gl::draw_pixels(program_, framebuffer_, no_vertices_, g_buffer.size());
    return color_;
}

}  // namespace conebook
