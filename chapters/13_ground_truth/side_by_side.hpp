// A picture and its reference as one: half and half, or the signed difference.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "13_ground_truth/background_tracer.hpp"
#include "app/options.hpp"
#include "gl/handles.hpp"
#include "gl/shaders.hpp"

namespace conebook {

enum class Show : int { picture, reference, split, difference };

// As on the command line.
std::string show_name(Show show);

struct ReferenceParams {
    // Of a view of light: what the cones make, what the path tracer makes, the left half of one and the right half of
    // the other, or (I - R) / (I + R) with I the cones' radiance and R the path tracer's.
    Show show = Show::picture;
    // Samples per pixel that a headless frame adds, 1 .. 65536. In a window the reference refines without end.
    int spp = 16;
    // The difference that is shown in full colour, 0.01 .. 1. 0.5 is a factor of three, as in compare's heat map.
    float difference_range = 0.5f;
};
void add_parameters(ParameterTable& table, ReferenceParams& params);

// The views of light of chapter 12, and `reference`: all light as the path tracer makes it.
std::vector<View> reference_views();

// The part of the light that the path tracer has to make for a view; nothing for views that show no light of a pixel.
std::optional<Part> part_of(const View& view);

// Throws std::runtime_error when `strict` and the path tracer has nothing to show for this view; else such a view shows
// its picture, so that a window can go through all of them.
Show what_to_show(const View& view, const ReferenceParams& params, bool strict);

// Valid until the next run.
struct SideBySideResult {
    const gl::Texture* linear = nullptr;  // RGBA32F: radiance, or the difference of each channel, -1..1
    const gl::Texture* shown = nullptr;   // RGBA32F: radiance, or the difference as a colour, linear
    Encoding encoding = Encoding::radiance;
};

class SideBySide {
public:
    explicit SideBySide(gl::Shaders& shaders);

    // The reference as a texture, RGBA32F of this size; black, with alpha 0, where there is none.
    const gl::Texture& upload(const std::shared_ptr<const Refinement>& newest, glm::ivec2 size);

    // Of two pictures of the same size, bottom row first; `show` says which of them may be null. Colours of the difference: black where both are equal, red
    // where the picture is too bright, blue where it is too dark; full at `range`, on to white at 2 * range; grey where
    // the reference shows no geometry.
    SideBySideResult run(Show show, const gl::Texture* picture, const gl::Texture* reference, Encoding encoding,
                         float range);

    std::vector<gl::Resource> resources() const
    {
        return {reference_.resource(), linear_.resource(), colors_.resource()};
    }

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture reference_, linear_, colors_;
    gl::Framebuffer framebuffer_;
    std::shared_ptr<const Refinement> uploaded_;
};

}  // namespace conebook
