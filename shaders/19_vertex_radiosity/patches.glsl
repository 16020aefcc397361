// The list of patches, and where the radiosity map has the irradiance of one.
#include "common/bindings.glsl"
#include "19_vertex_radiosity/patch_structs.glsl"

layout(std430, binding = kPatchBinding) readonly buffer PatchBuffer { Patch patches[]; };

ivec2 map_place(int patch_id, int map_side) { return ivec2(patch_id % map_side, patch_id / map_side); }
