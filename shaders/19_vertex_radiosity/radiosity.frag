#version 450 core
// L = rho / pi E + Le.
#include "common/surface.glsl"

in vec3 front_irradiance, back_irradiance;  // W/m^2
uniform float emission_part;

layout(location = 0) out vec4 radiance;  // W/(sr m^2); alpha: 1 where there is a surface

const float kPi = 3.14159265358979;

void main()
{
    Surface s = read_surface();
    vec3 irradiance = gl_FrontFacing ? front_irradiance : back_irradiance;
    radiance = vec4(s.material.albedo / kPi * irradiance + emission_part * s.material.emission, 1.0);
}
