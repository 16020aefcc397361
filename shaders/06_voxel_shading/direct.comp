#version 450 core
// Direct light that every occupied face reflects: L = (rho / pi) E, one thread a face. What it emits is kept apart.
// SHADOWS 0: none, 1: shadow maps, 2: hard rays through the volume, 3: soft rays. DIRECTIONAL_LAMBERT 0 or 1.
#include "common/scene_structs.glsl"
#include "common/brdf.glsl"
#include "common/light.glsl"
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "04_conservative_voxelization/voxel_walk.glsl"
#if SHADOWS == 1
#include "common/shadow_map.glsl"
#endif

layout(std430, binding = kFaceListBinding) readonly buffer FaceListBuffer { uint face_list[]; };
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
// rgb L, a visible share of all lights; 4 x 8 bit: lights 0..3.
layout(std430, binding = kRadianceBinding) writeonly buffer RadianceBuffer { vec4 face_radiance[]; };
layout(std430, binding = kVisibilityBinding) writeonly buffer VisibilityBuffer { uint face_visibility[]; };
uniform float soft_sharpness;  // voxels

// Cosine of the mean normal, or Villegas 2016, section 3.4: every axis weighs with the square of the normal's
// component and receives what light falls on its side.
// snippet: cosine_factor
float cosine_factor(vec3 n, vec3 l)
{
#if DIRECTIONAL_LAMBERT
    return dot(n * n, max(sign(n) * l, vec3(0.0)));
#else
    return max(dot(n, l), 0.0);
#endif
}
// end snippet

// Shadow rays start two voxels away from the face, where its own voxels no longer block them.
const float kRayStart = 2.0;  // voxels

float ray_visibility(vec3 position_grid, vec3 normal, vec3 direction, float distance_grid)
{
    vec3 start = position_grid + kRayStart * (normal + direction) * 0.5 + direction;
#if SHADOWS == 2
    VoxelHit hit = walk_voxels(start, direction, 0);
    return hit.hit && hit.t < distance_grid - kRayStart ? 0.0 : 1.0;
#else
    // snippet: soft_ray
    // Villegas 2016, sections 2.2.1.1 and 3.4.1: each voxel hit adds (1 - v) * hit / distance, so that what is near the
    // receiver makes a hard shadow and what is far away a soft one. His hit / distance has no upper end and can make
    // the visibility negative; here it ends at 1. A look, not a measurable quantity: there is no light size in it.
    float shadow = 0.0, travelled = 0.0;
    vec3 from = start;
    for (int hits = 0; hits < 8 && shadow < 1.0; ++hits) {
        VoxelHit hit = walk_voxels(from, direction, 0);
        travelled += hit.t + 1.0;
        if (!hit.hit || travelled > distance_grid - kRayStart) break;
        shadow += (1.0 - shadow) * min(soft_sharpness / travelled, 1.0);
        from += direction * (hit.t + 1.0);
    }
    return 1.0 - shadow;
    // end snippet
#endif
}

void main()
{
    uint place = item_index();
    if (place >= voxel_statistics.faces) return;
    VoxelFace face = faces[place];
    vec3 normal = face.normal.xyz;
    vec3 position = scene_from_grid(face.position.xyz);
    vec3 irradiance = vec3(0.0);
    vec4 visibility = vec4(1.0);
    float total = 0.0, unshadowed = 0.0;
    for (int i = 0; i < light_count; ++i) {
        LightSample light = sample_light(lights[i], position);
        float visible = 1.0;
        // snippet: visible
#if SHADOWS == 1
        // A face's mean point may lie inside a round surface: the lookup starts half a voxel outside.
        visible = shadow_map_visibility(i, lights[i], position + 0.5 * grid.origin.w * normal, normal);
#elif SHADOWS >= 2
        visible = ray_visibility(face.position.xyz, normal, light.direction, light.distance / grid.origin.w);
#endif
        // end snippet
        // snippet: irradiance
        vec3 unblocked = light.irradiance * cosine_factor(normal, light.direction);
        irradiance += visible * unblocked;
        // end snippet
        float weight = unblocked.r + unblocked.g + unblocked.b;
        total += weight;
        unshadowed += visible * weight;
        if (i < 4) visibility[i] = visible;
    }
    // snippet: radiance
    vec3 radiance = face.albedo_area.rgb / kPi * irradiance;
    face_radiance[place] = vec4(radiance, total > 0.0 ? unshadowed / total : 1.0);
    face_visibility[place] = packUnorm4x8(visibility);
    // end snippet
}
