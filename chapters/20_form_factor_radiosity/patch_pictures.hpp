// What the patches have as pictures: values drawn over the g-buffer, mirrors followed, item buffers unfolded.
#pragma once

#include "02_g_buffer/g_buffer.hpp"
#include "20_form_factor_radiosity/radiosity.hpp"
#include "app/options.hpp"
#include "image/image.hpp"

namespace conebook {

// Draws values at the corners of patches over the surfaces of the g-buffer; the rasterizer interpolates.
class PatchValuePass {
public:
    explicit PatchValuePass(gl::Shaders& shaders);
    // RGBA32F: scale times the value of the patch that a pixel sees; 0 where there is none. `values_of` names their
    // revision: equal ones are not sent again.
    const gl::Texture& run(const GBuffer& g_buffer, const Patches& patches, const CornerValues& values, float scale,
                           const std::pair<const void*, Revision>& values_of);
    std::vector<gl::Resource> resources() const { return {vertices_.resource(), values_.resource()}; }

private:
    gl::Program program_;
    gl::VertexArray vertex_array_;
    gl::Buffer vertices_;
    MadeFrom<const void*, Revision> vertices_from_;
    gl::Texture values_;
    gl::Framebuffer framebuffer_;
};

struct PixelParams {
    // Samples along each side of a pixel of a picture of light, 1 .. 4: what is behind an edge counts with its share.
    int pixel_samples = 2;
    // Rays of a sample into lobes that are too rough for a mirror, 1 .. 64.
    int lobe_rays = 4;
};
void add_parameters(ParameterTable& table, PixelParams& params);

// Indirect specular light at each pixel, from its middle: one ray from a mirror, some from rougher lobes. They find
// emission, direct and indirect light of the surface at their end, over further mirrors. Alpha 1 where there is a
// lobe.
ImageF specular_picture(const Radiosity& radiosity, const RadiosityParams& params, int lobe_rays,
                        const std::vector<Light>& lights, const Camera& camera, glm::ivec2 size);

// A picture of `side` by `side` samples a pixel, brought to its pixels.
class BoxFilterPass {
public:
    explicit BoxFilterPass(gl::Shaders& shaders);
    const gl::Texture& run(const gl::Texture& samples, int side);

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

// A picture on the GPU, of its own size.
class UploadedPicture {
public:
    const gl::Texture& set(const ImageF& picture);

private:
    gl::Texture texture_;
};

// What belongs to one patch, or to the patch at one place of the picture.
struct PatchPickParams {
    float pick_x = 0.5f, pick_y = 0.5f;  // place in the picture: 0 left, 1 right; 0 top, 1 bottom
};
void add_parameters(ParameterTable& table, PatchPickParams& params);
// kNoPatch where the picture has no surface.
std::uint32_t picked_patch(const Patches& patches, const PatchPickParams& params, const Camera& camera,
                           glm::ivec2 size);

// patches, radiosity, form_factors, hemicube.
std::vector<View> patch_views();
// The first three of them as one value a patch; nothing when the name is none of them. form_factors: F_ij / A_j
// over the largest of them, the picked patch itself blue.
std::optional<CornerValues> patch_view_values(const std::string& view, const Radiosity& radiosity,
                                              std::uint32_t picked);
// The item buffer of a patch, each texel in the colour of the patch that it sees; the sides folded down round the
// top.
ImageF hemicube_picture(Radiosity& radiosity, const RadiosityParams& params, std::uint32_t patch, glm::ivec2 size);

}  // namespace conebook
