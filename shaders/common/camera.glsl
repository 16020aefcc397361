// The camera of this frame.
#include "common/bindings.glsl"
#include "common/scene_structs.glsl"

layout(std140, binding = kCameraBlock) uniform CameraBlock { CameraData camera; };

// Unit vector from a point to the eye.
vec3 view_direction(vec3 position)
{
    return camera.position.w > 0.5 ? normalize(camera.position.xyz - position) : -camera.forward.xyz;
}

// m along the camera's axis.
float axial_distance(vec3 position) { return dot(position - camera.position.xyz, camera.forward.xyz); }

// Scene space position of a point of the near (depth 1) or the far plane (depth 0), or between.
vec3 unproject(vec2 ndc, float depth)
{
    vec4 scene = camera.scene_from_clip * vec4(ndc, depth, 1.0);
    return scene.xyz / scene.w;
}
