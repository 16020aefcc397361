// How much of a voxel lies within the scene's bounds. Beyond them nothing is known, so what is outside is left out of
// averages instead of being counted as empty: a wall that ends at the bounds stays whole.
#include "common/voxel_grid.glsl"

// Share of the voxel's length along `axis`.
float inside_share(ivec3 voxel, int axis, int level)
{
    float size = float(1 << level), low = float(voxel[axis]) * size;
    float inside = min(low + size, grid.content_max[axis]) - max(low, grid.content_min[axis]);
    return clamp(inside / size, 1e-6, 1.0);
}

// Weight of a column of voxels along the face's axis in the mean over its cross-section.
float column_weight(ivec3 voxel, int face, int level)
{
    int axis = face >> 1;
    return inside_share(voxel, (axis + 1) % 3, level) * inside_share(voxel, (axis + 2) % 3, level);
}
