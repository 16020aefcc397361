// From scene-linear radiance to the 8 bits of a display: exposure, tone curve, sRGB, in this order and only here.
#pragma once

#include "app/options.hpp"
#include "gl/handles.hpp"
#include "gl/shaders.hpp"
#include "scene/scene.hpp"

namespace conebook {

enum class ToneCurve : int { reinhard, clamp };

struct DisplayParams {
    // Factor on radiance, 0..1e6. At 1, the curve below shows 1 W/(sr m^2) at 53 % of the white. Scenes in
    // photometric units need far less, dim ones more.
    float exposure = 1.0f;
    // Exposed luminance that is shown as white, 0.1..1e6; what is above burns out. 4 leaves two stops above 1: enough
    // for surfaces near a light without turning the rest grey.
    float white = 4.0f;
    // Reinhard, or none: values above 1 are cut off.
    ToneCurve tone_curve = ToneCurve::reinhard;
    // Off writes linear values, as many first programs do: the picture is too dark.
    bool srgb = true;
};

void add_parameters(ParameterTable& table, DisplayParams& params);

// Views with lengths in metres (depth) are scaled for .png so that twice the scene's longest side is white; 1 for all
// others. .exr keeps metres.
float data_scale(const View& view, const Bounds& bounds);

class ToneMapPass {
public:
    explicit ToneMapPass(gl::Shaders& shaders);

    // RGBA8, alpha 1, size of `linear` (RGBA float). radiance: exposed, Reinhard on the luminance (Reinhard et al.
    // 2002, eq. 4; the colour keeps its chromaticity), sRGB; color: sRGB; data: times data_scale, not encoded.
    // The result is valid until the next call.
    const gl::Texture& run(const gl::Texture& linear, Encoding encoding, const DisplayParams& params,
                           float data_scale = 1.0f);

    std::vector<gl::Resource> resources() const { return {display_.resource()}; }

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture display_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
