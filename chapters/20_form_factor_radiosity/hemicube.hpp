// Item buffers: what a patch sees, rasterized on the five faces of a hemicube (Cohen & Greenberg 1985, "The
// hemi-cube").
#pragma once

#include "20_form_factor_radiosity/form_factors.hpp"
#include "gl/handles.hpp"
#include "gl/shaders.hpp"

namespace conebook {

// Form factors of the texels of a hemicube: R x R on top, four sides of R x R/2, in the places of HemicubeLayout.
// exact: closed forms, which add up to 1 at every resolution.
std::vector<float> hemicube_weights(int resolution, TexelWeights weights);

// All five faces beside each other, 3 R wide and R high: the top, then the sides along +t, +b over -t, -b.
struct HemicubeLayout {
    int resolution;
    glm::ivec2 size() const { return {3 * resolution, resolution}; }
    int texels() const { return 3 * resolution * resolution; }
    glm::ivec2 corner(int face) const;
    glm::ivec2 face_size(int face) const { return {resolution, face == 0 ? resolution : resolution / 2}; }
};

// From where, and how the hemicube stands. One seen in a mirror is reflected, so its axes are left-handed.
struct HemicubeView {
    glm::vec3 eye;
    glm::mat3 axes;                          // columns t, b, n: unit, n the patch's normal
    glm::vec4 clip{0.0f, 0.0f, 0.0f, 1.0f};  // seen is what has dot(clip, (position, 1)) > 0
    float near;                              // m
};

// What a texel sees.
struct Item {
    std::uint32_t triangle_and_side = 0;  // 0: nothing; else (triangle + 1) | kItemBack
    std::uint32_t barycentrics = 0;       // u, v in 16 bits each
    static constexpr std::uint32_t kBack = 0x80000000u;
    bool seen() const { return triangle_and_side != 0; }
    bool front() const { return (triangle_and_side & kBack) == 0; }
    std::uint32_t triangle() const { return (triangle_and_side & ~kBack) - 1; }
    glm::vec2 uv() const;
};

// The view from a point of a patch. The cube is turned by a number of the patch, so that neighbours err differently.
HemicubeView hemicube_view(const Patches& patches, std::uint32_t patch, const SurfaceHit& point);

class Hemicubes {
public:
    Hemicubes(gl::Shaders& shaders, const Scene& scene);

    // Item buffers of so many views, one after the other, texels as in the layout.
    std::vector<Item> render(const std::vector<HemicubeView>& views, int resolution);
    // As many views as are worth one call.
    static std::size_t batch(int resolution)
    {
        return std::max<std::size_t>(1, (1u << 20) / std::size_t(3 * resolution * resolution));
    }
    std::vector<gl::Resource> resources() const { return {vertices_.resource(), items_.resource(), depth_.resource()}; }

private:
    gl::Program program_;
    gl::Buffer vertices_;
    gl::VertexArray vertex_array_;
    std::size_t vertex_count_ = 0;
    gl::Texture items_, depth_;
    gl::Framebuffer framebuffer_;
};

// The row of what is seen at a point with a normal, without its mirrors.
FormFactorRow hemicube_row(Hemicubes& hemicubes, const Patches& patches, const HemicubeView& view, int resolution,
                           TexelWeights weights);

// All rows, by item buffers; what mirrors show by mirrored ones (hemicube) or by rays (hybrid).
FormFactors render_form_factors(Hemicubes& hemicubes, const Patches& patches, const FormFactorParams& params);

// Planes on which flat mirrors lie; more of them are curved mirrors, which a mirrored camera cannot show.
constexpr std::size_t kMostMirrorPlanes = 16;
std::size_t mirror_planes(const Patches& patches);

}  // namespace conebook
