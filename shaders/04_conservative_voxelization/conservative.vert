#version 450 core
// The geometry shader needs the three vertices of a triangle as they are in the scene.
layout(location = 0) in vec3 position;
out vec3 vertex_position;  // scene space, m

void main() { vertex_position = position; }
