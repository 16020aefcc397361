// What the specular passes need of a surface. Included after common/g_buffer.glsl.
const float kSharp = 0.1;   // roughness below which one cone is enough: 4 degrees wide, a voxel at 14 voxels
const float kShared = 0.3;  // from which on the lobe is so wide that neighbours have nearly the same

bool has_lobe(GBufferSample surface)
{
    return max(max(surface.f0.r, max(surface.f0.g, surface.f0.b)), surface.f90) > 1e-4;
}

// Interpolated and mapped normals may turn away from the eye; nothing can be mirrored there but in the facet itself.
vec3 lobe_normal(GBufferSample surface, vec3 view)
{
    return dot(surface.normal, view) > 0.0 ? surface.normal : surface.geometric_normal;
}
