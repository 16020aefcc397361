// The ray through the middle of a pixel, in scene space.
#include "common/camera.glsl"

struct Ray {
    vec3 origin;
    vec3 direction;  // unit
};

// Through two points next to the scene: from an eye 100 km away the ray would wander by centimetres. It begins in front
// of the near plane where the camera's own lets it, because voxels are thicker than the surfaces in them.
Ray camera_ray(vec2 pixel_center)
{
    vec2 ndc = 2.0 * pixel_center * camera.size.zw - 1.0;
    vec3 near_point = unproject(ndc, 1.0), direction = normalize(unproject(ndc, 0.0) - near_point);
    return Ray(near_point - camera.forward.w / dot(direction, camera.forward.xyz) * direction, direction);
}
