#version 450 core
// Indirect diffuse light of every pixel, from the points around it.
#include "08_diffuse_cones/upsample.glsl"
