#version 450 core
// Chapter 09's light in the lobe, with emitters, which cones see at any distance.
#include "11_emissives/emitted_light.glsl"
#include "09_specular_cones/lobe_light.glsl"
