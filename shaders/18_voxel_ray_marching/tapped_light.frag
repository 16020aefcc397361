#version 450 core
// Direct light with shadows whose edges are blurred by many taps: each looks up the shadow map at another place near
// the point's own (Ropret 2013, section 2.2). One width for all edges: a look, and no light's size.
#include "common/g_buffer.glsl"
#include "common/brdf.glsl"
#include "common/light.glsl"
#include "common/shadow_map.glsl"

uniform int shadow_taps;      // 1: the filter of chapter 03
uniform float shadow_radius;  // texels
layout(location = 0) out vec4 radiance;  // W/(sr m^2); alpha: 1 where there is a surface

// Points on a disc, spread evenly (Vogel 1979), turned by another angle at every pixel.
float tapped_visibility(int light_index, LightData light, vec3 position, vec3 normal, float turn)
{
    ivec4 layers = shadow_lights[light_index].layers;
    if (layers.y == 0) return 1.0;
    int layer = layers.x + (layers.y == 6 ? cube_face(position - light.position.xyz) : 0);
    mat4 clip_from_scene = shadow_layers[layer].clip_from_scene;
    ivec4 place = shadow_layers[layer].place;
    float size = float(place.w), clip_w = (clip_from_scene * vec4(position, 1.0)).w;
    position += shadow_bias_texels * texel_width_m(clip_from_scene, clip_w, size) * normal;
    vec4 clip = clip_from_scene * vec4(position, 1.0);
    if (any(greaterThan(abs(clip.xy), clip.ww))) return 1.0;
    vec3 ndc = clip.xyz / clip.w;
    vec2 texel = (0.5 * ndc.xy + 0.5) * size;
    vec2 gradient = shadow_receiver_plane == 1 ? plane_gradient(clip_from_scene, position, normal) / size : vec2(0.0);
    // snippet: taps
    float lit = 0.0;
    for (int i = 0; i < shadow_taps; ++i) {
        float r = shadow_radius * sqrt((float(i) + 0.5) / float(shadow_taps)), angle = turn + 2.39996323 * float(i);
        ivec2 tap = ivec2(floor(texel + r * vec2(cos(angle), sin(angle))));
        float own_depth = max(ndc.z + dot(gradient, vec2(tap) + 0.5 - texel), 0.0);
        tap = place.xy + clamp(tap, ivec2(0), ivec2(place.w - 1));
        lit += own_depth >= texelFetch(shadow_maps, ivec3(tap, place.z), 0).r ? 1.0 : 0.0;
    }
    return lit / float(shadow_taps);
    // end snippet
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GBufferSample s = read_g_buffer(pixel);
    vec3 view = view_direction(s.position), sum = vec3(0.0);
    // Interleaved gradient noise (Jimenez 2014): neighbours differ as much as they can.
    float turn = 6.28318531 * fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
    for (int i = 0; s.covered && i < light_count; ++i) {
        LightSample light = sample_light(lights[i], s.position);
        bool faces_light = dot(s.geometric_normal, light.direction) > 0.0;  // else it lies in its own shadow
        float visible = 0.0;
        if (faces_light)
            visible = shadow_taps == 1 ? shadow_map_visibility(i, lights[i], s.position, s.geometric_normal)
                                       : tapped_visibility(i, lights[i], s.position, s.geometric_normal, turn);
        sum += reflected_radiance(s.normal, view, light.direction, visible * light.irradiance, s.albedo, s.roughness,
                                  s.f0, s.f90);
    }
    radiance = vec4(sum, s.covered ? 1.0 : 0.0);
}
