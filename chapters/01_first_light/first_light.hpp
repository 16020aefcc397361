// Chapter 01's picture for a window of any chapter, while that chapter's own first picture is being made.
#pragma once

#include <functional>

#include "01_first_light/tone_map.hpp"
#include "app/app.hpp"

namespace conebook {

// For App::show_meanwhile: direct light without shadows, or what the view shows of surfaces. What it is given must
// outlive the result.
std::function<const gl::Texture&()> first_light(App& app, const GpuScene& scene, const DisplayParams& display);

}  // namespace conebook
