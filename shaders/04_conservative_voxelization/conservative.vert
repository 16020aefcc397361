#version 450 core
// The geometry shader reads the vertices itself, in grid space.
void main() { gl_Position = vec4(0.0); }
