#version 450 core
// Indirect diffuse light of every point that gathers.
#include "08_diffuse_cones/gather_point.glsl"
