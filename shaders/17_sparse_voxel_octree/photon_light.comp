#version 450 core
// Flux to light, one thread a face. The bricks hold max(n.d, 0) (rho / pi) Phi / v^2 for the direction d: the area of
// the face, which the coverage brings in again, is divided out here.
#include "common/brdf.glsl"
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "common/voxel_grid.glsl"
#include "17_sparse_voxel_octree/octree_structs.glsl"

layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kFluxBinding) readonly buffer FluxBuffer { uint flux[]; };
layout(std430, binding = kRadianceBinding) writeonly buffer RadianceBuffer { vec4 face_radiance[]; };
// Phi / v^2, W/m^2
layout(std430, binding = kReflectedBinding) writeonly buffer IrradianceBuffer { vec4 irradiance[]; };
uniform float flux_unit;  // W

const float kLeastArea = 1e-6;  // voxel sides squared; smaller faces cover nothing

void main()
{
    uint place = item_index();
    if (place >= voxel_statistics.faces) return;
    // snippet: photon_light
    vec3 watt;
    for (uint c = 0u; c < 3u; ++c)
        watt[c] = (float(flux[6u * place + c + 3u]) * 4294967296.0 + float(flux[6u * place + c])) * flux_unit;
    vec3 per_voxel = watt / (grid.origin.w * grid.origin.w);
    vec4 albedo_area = faces[place].albedo_area;
    face_radiance[place] = vec4(albedo_area.rgb / kPi * per_voxel / max(albedo_area.a, kLeastArea), 1.0);
    irradiance[place] = vec4(per_voxel, 1.0);
    // end snippet
}
