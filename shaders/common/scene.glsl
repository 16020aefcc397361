// Bindings of what GpuScene uploads.
#include "common/bindings.glsl"
#include "common/camera.glsl"

// The material of the triangles being drawn. A uniform block and not a storage buffer: drivers may mask loads from
// storage in the helper invocations at a triangle's edge, and texture coordinates made from them would have no
// derivatives.
layout(std140, binding = kMaterialBlock) uniform MaterialBlock { MaterialData drawn_material; };
