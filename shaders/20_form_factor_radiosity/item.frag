#version 450 core
// The item buffer: which triangle a texel sees, and where on it.
flat in uint triangle_and_side;
in vec2 barycentrics;

layout(location = 0) out uvec2 item;

void main() { item = uvec2(triangle_and_side, packUnorm2x16(barycentrics)); }
