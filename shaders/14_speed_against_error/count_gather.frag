#version 450 core
// What a point looks up while it gathers, as chapters 08 and 11 do it. EMITTERS 1: with rays aimed at emitters.
#include "14_speed_against_error/counting.glsl"
#if EMITTERS
#include "11_emissives/gather_all.glsl"
#else
#include "08_diffuse_cones/gather.glsl"
#define GATHER(start, geometric_normal, normal, position_grid, set) gather_diffuse(start, geometric_normal, normal, set)
#endif
#define STORE(sum) vec4(float(walk_steps), float(light_fetches), sum.ambient, 1.0)
#include "08_diffuse_cones/gather_point.glsl"
