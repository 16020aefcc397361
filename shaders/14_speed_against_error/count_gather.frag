#version 450 core
// What a point looks up while it gathers, as chapter 08 does it.
#include "14_speed_against_error/counting.glsl"
#define STORE(sum) vec4(float(walk_steps), float(light_fetches), sum.ambient, 1.0)
#include "08_diffuse_cones/gather_point.glsl"
