// One thread a fragment of one material: which triangle and which voxel, and what of the triangle is inside.
// BASE_COLOR_TEXTURE, METALLIC_ROUGHNESS_TEXTURE, EMISSION_TEXTURE, SPECULAR_TEXTURE, SPECULAR_COLOR_TEXTURE: 1 when
// the material has one. COVERAGE_TEXTURE, VERTEX_ALPHA: 1 when that decides how much its alpha mask leaves.
#define TEXTURES (BASE_COLOR_TEXTURE + METALLIC_ROUGHNESS_TEXTURE + EMISSION_TEXTURE + SPECULAR_TEXTURE + \
                  SPECULAR_COLOR_TEXTURE)
#include "04_conservative_voxelization/triangle_voxels.glsl"
#include "04_conservative_voxelization/scene_triangles.glsl"
#include "05_atomic_averaging/triangle_attributes.glsl"
#include "05_atomic_averaging/triangle_part.glsl"
#include "05_atomic_averaging/voxel_material.glsl"
#include "common/item_index.glsl"

layout(std430, binding = kFragmentBinding) readonly buffer FragmentBuffer { uvec2 fragments[]; };
uniform uint first_fragment, fragment_count;  // of the material in the list

struct Fragment {
    GridTriangle t;
    ivec3 voxel;
    TrianglePart part;
    VoxelMaterial material;
};

Fragment fetch_fragment(uint item)
{
    uvec2 pair = fragments[first_fragment + item];
    Fragment f;
    f.t = fetch_triangle(pair.x);
    f.voxel = unpack_voxel(pair.y);
    ivec3 voxel_t = axis_to_z(f.voxel, f.t.axis);
    f.part = part_in_voxel(f.t, voxel_t);
    f.material = voxel_material(f.t, triangle_attributes(pair.x), voxel_t, f.part);
    return f;
}
