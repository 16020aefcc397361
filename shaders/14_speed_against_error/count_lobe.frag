#version 450 core
// What a pixel looks up for its specular lobe, as chapters 09 and 11 do it. EMITTERS 1: with what surfaces emit.
#include "14_speed_against_error/counting.glsl"
#if EMITTERS
#include "11_emissives/emitted_light.glsl"
#endif
#define STORE(light) vec4(float(walk_steps), float(light_fetches), 0.0, 1.0)
#include "09_specular_cones/lobe_light.glsl"
