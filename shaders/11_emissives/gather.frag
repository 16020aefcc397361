#version 450 core
// Chapter 08's gathering of every point, with emitters.
#include "11_emissives/gather_all.glsl"
#include "08_diffuse_cones/gather_point.glsl"
