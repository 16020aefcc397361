#include "13_ground_truth/side_by_side.hpp"

#include <stdexcept>

#include "12_second_bounce/camera_light.hpp"
#include "gl/pixel_pass.hpp"

namespace conebook {

namespace {

const std::vector<std::string> kShowNames{"picture", "reference", "split", "difference"};  // in Show's order

}  // namespace

std::string show_name(Show show) { return kShowNames[std::size_t(show)]; }

void add_parameters(ParameterTable& table, ReferenceParams& params)
{
    table.add("show", params.show, kShowNames,
              "cones, path tracer, half and half, (I - R) / (I + R)");
    table.add("spp", params.spp, 1, 65536, "", "samples per pixel that a headless frame adds");
    table.add("difference_range", params.difference_range, 0.01, 1.0, "", "difference that is shown in full colour");
}

std::vector<View> reference_views()
{
    return joined(light_views(), {{"reference", Encoding::radiance, "all light, by the path tracer"}});
}

std::optional<Part> part_of(const View& view)
{
    if (view.name == "reference") return Part::final;
    for (const char* part : {"final", "direct", "indirect_diffuse", "indirect_specular", "emission"})
        if (view.name == part) return part_from_name(part);
    return std::nullopt;
}

Show what_to_show(const View& view, const ReferenceParams& params, bool strict)
{
    if (view.name == "reference") return Show::reference;
    if (part_of(view)) return params.show;
    if (strict && params.show != Show::picture)
        throw std::runtime_error("--view " + view.name + ": the path tracer makes light alone, so show=picture only");
    return Show::picture;
}

SideBySide::SideBySide(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "13_ground_truth/side_by_side.frag"}))
{
}

const gl::Texture& SideBySide::upload(const std::shared_ptr<const Refinement>& newest, glm::ivec2 size)
{
    const bool fits = reference_ && reference_.size_2d() == size;
    if (fits && newest == uploaded_) return reference_;
    if (!fits) reference_ = gl::texture_2d("reference", GL_RGBA32F, size);
    reference_.clear();
    uploaded_ = newest;
    if (!newest || newest->picture.width != size.x || newest->picture.height != size.y) return reference_;
    // Pictures have the top row first, textures the bottom row.
    for (int y = 0; y < size.y; ++y)
        glTextureSubImage2D(reference_.id(), 0, 0, size.y - 1 - y, size.x, 1, GL_RGBA, GL_FLOAT,
                            &newest->picture.at(0, y));
    return reference_;
}

SideBySideResult SideBySide::run(Show show, const gl::Texture* picture, const gl::Texture* reference,
                                 Encoding encoding, float range)
{
    if (show == Show::picture) return {picture, picture, encoding};
    if (show == Show::reference) return {reference, reference, encoding};
    const glm::ivec2 size = reference->size_2d();
    if (linear_.size_2d() != size) {
        linear_ = gl::texture_2d("side by side", GL_RGBA32F, size);
        colors_ = gl::texture_2d("side by side, colours", GL_RGBA32F, size);
        framebuffer_ = gl::Framebuffer("side by side", std::vector<const gl::Texture*>{&linear_, &colors_});
    }
    picture->bind(0);
    reference->bind(1);
    program_.use();
    program_.set("difference", show == Show::difference);
    program_.set("range", range);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, size);
    if (show == Show::split) return {&linear_, &linear_, encoding};
    return {&linear_, &colors_, Encoding::data};
}

}  // namespace conebook
