// Constants of the material and light model, read by C++ and GLSL alike, so that the path tracer and the shaders
// cannot drift apart. The model itself: common/reference/brdf.hpp.
#ifndef CONEBOOK_MATERIAL_CONSTANTS_GLSL
#define CONEBOOK_MATERIAL_CONSTANTS_GLSL
#ifdef __cplusplus
namespace conebook {
#endif

// Perceptual roughness is clamped from below: a perfect mirror would show a punctual light as an infinitely bright
// point. At 0.03 (GGX alpha 0.0009) the lobe is 0.1 degrees wide, sharper than a pixel of the book's pictures.
const float kMinRoughness = 0.03;

// cos of the angle between shading normal and view is clamped from below: interpolated and mapped normals may turn
// away from the eye, where the visibility term is not defined.
const float kMinNdotV = 1.0e-4;

// m. The distance to a punctual light is clamped from below, so that E = I cos / d^2 stays finite at the light: for I
// up to 1e8 W/sr a float holds it. That is all it is for: a scene of a micrometre is lit as one of a metre.
const float kMinLightDistance = 1.0e-15;

// Reflectance at normal incidence of a dielectric with index of refraction 1.5: ((1.5 - 1) / (1.5 + 1))^2.
const float kDielectricF0 = 0.04;

// A spot's cos(inner) - cos(outer) is clamped from below (KHR_lights_punctual, "Inner and Outer Cone Angles").
const float kMinSpotCosineSpan = 0.001;

#ifdef __cplusplus
}  // namespace conebook
#endif
#endif
