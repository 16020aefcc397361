// Punctual lights (KHR_lights_punctual): the scene's list of them, and what one of them sends to a point.
#include "common/bindings.glsl"
#include "common/scene_structs.glsl"
#include "common/material_constants.glsl"

layout(std430, binding = kLightBinding) readonly buffer LightBuffer { LightData lights[]; };
uniform int light_count;

struct LightSample {
    vec3 direction;   // unit, from the point to the light; zero at the very place of the light
    vec3 irradiance;  // W/m^2 on a plane perpendicular to `direction`, no cosine yet
    float distance;   // m to the light; kInfiniteDistance for directional lights
};

const float kInfiniteDistance = 1.0e18;  // m, beyond every scene that is read; its square is still a float

// snippet: sample_light
LightSample sample_light(LightData light, vec3 position)
{
    if (int(light.position.w) == kLightDirectional)
        return LightSample(-light.direction.xyz, light.intensity.rgb, kInfiniteDistance);

    vec3 to_light = light.position.xyz - position;
    float d = max(length(to_light), kMinLightDistance);
    vec3 direction = to_light / d;
    float factor = 1.0 / (d * d);  // E = I / d^2
    if (light.direction.w > 0.0) {  // range: a smooth end of the light
        float q = d / light.direction.w;
        factor *= clamp(1.0 - q * q * q * q, 0.0, 1.0);
    }
    if (int(light.position.w) == kLightSpot) {
        float edge = clamp(dot(light.direction.xyz, -direction) * light.spot.x + light.spot.y, 0.0, 1.0);
        factor *= edge * edge;
    }
    return LightSample(direction, light.intensity.rgb * factor, d);
}
// end snippet
