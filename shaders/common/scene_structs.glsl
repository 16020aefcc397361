// Materials, lights and the camera as C++ writes them and GLSL reads them.
#ifdef __cplusplus
#pragma once
#endif
#include "common/cpp_glsl.glsl"

CONEBOOK_SHARED_BEGIN

// Texture slots of a material; also the texture units that they are bound to.
CONEBOOK_CONSTANT int kBaseColorSlot = 0;
CONEBOOK_CONSTANT int kMetallicRoughnessSlot = 1;
CONEBOOK_CONSTANT int kNormalSlot = 2;
CONEBOOK_CONSTANT int kEmissionSlot = 3;
CONEBOOK_CONSTANT int kSpecularSlot = 4;
CONEBOOK_CONSTANT int kSpecularColorSlot = 5;
CONEBOOK_CONSTANT int kTextureSlots = 6;
CONEBOOK_CONSTANT int kCoverageUnit = 6;  // alpha mask, 0 or 1 at level 0, so that its mips are coverage
CONEBOOK_CONSTANT int kFirstFreeUnit = 8;  // passes bind their own textures from here on

CONEBOOK_CONSTANT int kMaterialMasked = 1;
CONEBOOK_CONSTANT int kMaterialDoubleSided = 2;
CONEBOOK_CONSTANT int kMaterialUnlit = 4;

// In the word that a triangle has for its material, next to the material's number.
CONEBOOK_CONSTANT uint kTriangleDoubleSided = 0x80000000u;

struct MaterialData {
    vec4 base_color;         // linear RGBA factor
    vec4 emission;           // rgb: radiance factor W/(sr m^2), a: alpha cutoff
    vec4 specular;           // rgb: specular colour, a: specular factor
    float metallic;          // 0..1
    float roughness;         // perceptual, 0..1
    float normal_scale;
    int flags;               // kMaterial...
    vec4 uv_row[12];         // slot s: u' = dot(uv_row[2s].xyz, (u, v, 1)), v' with uv_row[2s+1];
                             // uv_row[2s].w: UV set (0 or 1), uv_row[2s+1].w: 1 when the slot has a texture
};

CONEBOOK_CONSTANT int kLightDirectional = 0;
CONEBOOK_CONSTANT int kLightPoint = 1;
CONEBOOK_CONSTANT int kLightSpot = 2;

// KHR_lights_punctual.
struct LightData {
    vec4 position;    // xyz: scene space; w: type (kLight...)
    vec4 direction;   // xyz: unit, the way the light travels; w: range in m, 0 = infinite
    vec4 intensity;   // rgb: W/sr (point, spot) or W/m^2 (directional)
    vec4 spot;        // x, y: angular attenuation scale and offset; z: cos(outer); w: unused
};

struct CameraData {
    mat4 clip_from_scene;   // reversed depth: 1 at the near plane, 0 at the far one, both as near to the scene as can be
    mat4 scene_from_clip;
    vec4 position;          // xyz: scene space; w: 1 perspective, 0 orthographic
    vec4 forward;           // xyz: unit, where the camera looks; w: m of free way in front of that near plane that rays
                            // may use as well, at most the diagonal of the scene
    vec4 size;              // xy: picture in pixels, zw: 1 / xy
};

CONEBOOK_SHARED_END
