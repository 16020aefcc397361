// Colours that stand for numbers, read by C++ and GLSL alike, so that pictures and the colour bars beside them
// (tools/sheet.cpp) cannot drift apart. Display-referred values 0..1, but for count_color, which is linear light.
#ifndef CONEBOOK_COLOR_SCALES_GLSL
#define CONEBOOK_COLOR_SCALES_GLSL
#ifdef __cplusplus
#include <glm/glm.hpp>
namespace conebook::color_scales {
using glm::abs;
using glm::clamp;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::vec3;
#define CONEBOOK_INLINE inline
#else
#define CONEBOOK_INLINE
#endif

CONEBOOK_INLINE
// snippet: difference_color
// Black at 0; red above, blue below, full at 1; on to white at 2. Brightness tells the amount, hue the sign.
vec3 difference_color(float d)
{
    float strong = abs(d), beyond = clamp(strong - 1.0f, 0.0f, 1.0f);
    float first = min(strong, 1.0f), second = min((d >= 0.0f ? 0.35f : 0.45f) * strong * strong + beyond, 1.0f);
    return d >= 0.0f ? vec3(first, second, beyond) : vec3(beyond, second, first);
}
// end snippet

// Of what is counted: 1 dark blue, 2 blue, 4 green, 8 yellow, 16 and more red.
CONEBOOK_INLINE vec3 count_color(float number)
{
    float x = clamp(log2(max(number, 1.0f)), 0.0f, 4.0f);
    vec3 low = mix(vec3(0.02f, 0.03f, 0.2f), vec3(0.05f, 0.25f, 0.9f), clamp(x, 0.0f, 1.0f));
    vec3 middle = mix(low, vec3(0.1f, 0.8f, 0.2f), clamp(x - 1.0f, 0.0f, 1.0f));
    vec3 high = mix(middle, vec3(1.0f, 0.8f, 0.05f), clamp(x - 2.0f, 0.0f, 1.0f));
    return mix(high, vec3(0.9f, 0.05f, 0.02f), clamp(x - 3.0f, 0.0f, 1.0f));
}

// Of a share of the largest, 0..1: from black through red and yellow to white.
CONEBOOK_INLINE vec3 heat_color(float share)
{
    return clamp(3.0f * share - vec3(0.0f, 1.0f, 2.0f), vec3(0.0f), vec3(1.0f));
}

#undef CONEBOOK_INLINE
#ifdef __cplusplus
}  // namespace conebook::color_scales
#endif
#endif
