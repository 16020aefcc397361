// The ray through the middle of a pixel, in scene space.
#include "common/bindings.glsl"
#include "common/scene_structs.glsl"

layout(std140, binding = kCameraBlock) uniform CameraBlock { CameraData camera; };

struct Ray {
    vec3 origin;
    vec3 direction;  // unit
};

Ray camera_ray(vec2 pixel_center)
{
    vec2 ndc = 2.0 * pixel_center * camera.size.zw - 1.0;
    vec4 near_point = camera.scene_from_clip * vec4(ndc, 1.0, 1.0);  // reversed depth: 1 is near
    vec3 near_position = near_point.xyz / near_point.w;
    bool perspective = camera.position.w > 0.5;
    vec3 origin = perspective ? camera.position.xyz : near_position;
    return Ray(origin, perspective ? normalize(near_position - camera.position.xyz) : camera.forward.xyz);
}
