#version 450 core
// Light in the specular lobe of every pixel.
#include "09_specular_cones/lobe_light.glsl"
