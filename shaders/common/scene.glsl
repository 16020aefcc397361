// Bindings of what GpuScene uploads.
#include "common/scene_structs.glsl"

layout(std430, binding = 0) readonly buffer MaterialBuffer { MaterialData materials[]; };
layout(std430, binding = 1) readonly buffer LightBuffer { LightData lights[]; };
layout(std140, binding = 0) uniform CameraBlock { CameraData camera; };
uniform int light_count;
uniform int material_index;
