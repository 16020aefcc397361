#version 450 core
// Chapter 08's way from points to pixels, with emitters where a pixel gathers for itself.
#include "11_emissives/gather_all.glsl"
#include "08_diffuse_cones/upsample_pixel.glsl"
