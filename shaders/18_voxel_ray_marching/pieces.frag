#version 450 core
flat in vec3 radiance;  // W/(sr m^2)
layout(location = 0) out vec4 color;

void main() { color = vec4(radiance, 1.0); }
