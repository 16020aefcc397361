// Visibility of a light by its shadow map: taught in chapter 03, used wherever direct light is computed.
#include "common/bindings.glsl"
#include "common/shadow_structs.glsl"
#include "common/scene_structs.glsl"

layout(std430, binding = kShadowLayerBinding) readonly buffer ShadowLayerBuffer { ShadowLayer shadow_layers[]; };
layout(std430, binding = kShadowLightBinding) readonly buffer ShadowLightBuffer { ShadowLight shadow_lights[]; };
layout(binding = kShadowMapUnit) uniform sampler2DArray shadow_maps;
uniform float shadow_bias_texels;    // how far the point moves along its normal, in widths of a texel
uniform int shadow_receiver_plane;   // 1: compare with the receiver's plane; 0: with the point's depth alone, the acne

// Which of the six maps of a point light sees the direction.
int cube_face(vec3 d)
{
    vec3 a = abs(d);
    int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (d[axis] < 0.0 ? 1 : 0);
}

// snippet: plane_gradient
// Depth of the receiver's own plane at texels around the projected point. A projection maps planes to planes, so in
// (u, v, depth) the plane through the point is  depth = depth_0 + g . (uv - uv_0):  no slope is too steep for it.
vec2 plane_gradient(mat4 clip_from_scene, vec3 position, vec3 normal)
{
    vec3 t = normalize(abs(normal.x) > 0.5 ? cross(normal, vec3(0.0, 1.0, 0.0)) : cross(normal, vec3(1.0, 0.0, 0.0)));
    vec3 b = cross(normal, t);
    vec4 c = clip_from_scene * vec4(position, 1.0), ct = clip_from_scene * vec4(t, 0.0),
         cb = clip_from_scene * vec4(b, 0.0);
    // Derivatives of clip.xyz / clip.w along the two tangents.
    vec3 dt = (ct.xyz * c.w - c.xyz * ct.w) / (c.w * c.w), db = (cb.xyz * c.w - c.xyz * cb.w) / (c.w * c.w);
    float determinant = dt.x * db.y - dt.y * db.x;
    vec2 gradient = vec2(dt.z * db.y - db.z * dt.y, db.z * dt.x - dt.z * db.x) / determinant;
    bool is_seen_edge_on = abs(determinant) <= 1e-9 * (dot(dt.xy, dt.xy) + dot(db.xy, db.xy));
    return is_seen_edge_on ? vec2(0.0) : 2.0 * gradient;  // ndc spans 2, uv spans 1
}
// end snippet

// The larger side of a texel at the point, m. Across the map's axis, which is the row of w in a perspective and has no
// part in a parallel projection, a row of the matrix is as long as ndc units per metre where clip.w is 1.
float texel_width_m(mat4 clip_from_scene, float clip_w, float size)
{
    mat4 rows = transpose(clip_from_scene);
    vec3 axis = rows[3].xyz;
    vec3 x = rows[0].xyz - dot(rows[0].xyz, axis) * axis, y = rows[1].xyz - dot(rows[1].xyz, axis) * axis;
    return 2.0 / size * clip_w * inversesqrt(min(dot(x, x), dot(y, y)));
}

// Share of the light that reaches the point, 0..1: percentage-closer filtering (Reeves et al. 1987) of 3 x 3 texels
// whose weights move with the point. Outside its maps a light throws no shadow (a spot gives no light there).
float shadow_map_visibility(int light_index, LightData light, vec3 position, vec3 geometric_normal)
{
    ivec4 layers = shadow_lights[light_index].layers;
    if (layers.y == 0) return 1.0;
    int layer = layers.x + (layers.y == 6 ? cube_face(position - light.position.xyz) : 0);
    mat4 clip_from_scene = shadow_layers[layer].clip_from_scene;
    ivec4 place = shadow_layers[layer].place;
    vec4 clip = clip_from_scene * vec4(position, 1.0);
    if (any(greaterThan(abs(clip.xy), clip.ww))) return 1.0;
    float size = float(place.w);
    // snippet: normal_offset
    // Step off the surface. Along the light that is offset / cos(theta) of clearance, more where the light grazes and
    // every error of the map grows with tan(theta); across, the shadow moves by at most the offset itself.
    position += shadow_bias_texels * texel_width_m(clip_from_scene, clip.w, size) * geometric_normal;
    clip = clip_from_scene * vec4(position, 1.0);
    // end snippet
    vec3 ndc = clip.xyz / clip.w;
    vec2 texel = (0.5 * ndc.xy + 0.5) * size;
    vec2 gradient = plane_gradient(clip_from_scene, position, geometric_normal) / size;  // depth per texel
    gradient = shadow_receiver_plane == 1 ? gradient : vec2(0.0);

    // snippet: filter
    vec2 corner = floor(texel - 1.5), f = texel - 1.5 - corner;
    float lit = 0.0;
    for (int i = 0; i < 16; ++i) {
        vec2 tap = corner + vec2(i & 3, i >> 2);
        vec2 from_point = tap + 0.5 - texel;
        float own_depth = max(ndc.z + dot(gradient, from_point), 0.0);  // a steep plane may leave the map's far end
        ivec2 safe = place.xy + clamp(ivec2(tap), ivec2(0), ivec2(place.w - 1));
        float nearest = texelFetch(shadow_maps, ivec3(safe, place.z), 0).r;
        float weight_x = (i & 3) == 0 ? 1.0 - f.x : (i & 3) == 3 ? f.x : 1.0;
        float weight_y = (i >> 2) == 0 ? 1.0 - f.y : (i >> 2) == 3 ? f.y : 1.0;
        lit += own_depth >= nearest ? weight_x * weight_y : 0.0;
    }
    // end snippet
    return lit / 9.0;
}
