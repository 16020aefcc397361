// The walk volume as a word for every cell, 08_diffuse_cones/walk.glsl.
layout(binding = kWalkVolumeUnit) uniform usampler3D walk_volume;

// The word of a cell. Where a storage has one word for a cube of `unit` empty cells a side, leaps are in that unit, and
// `cell` becomes the one of the cube where the leap begins; `down`: 1 for axes along which the ray goes towards lower
// coordinates.
uint walk_word(inout vec3 cell, vec3 down, out float unit)
{
    unit = 1.0;
    return texelFetch(walk_volume, ivec3(cell), 0).r;
}

#ifdef STORES_WALK
layout(r32ui, binding = 0) writeonly uniform uimage3D stored_walk;
void store_walk(ivec3 cell, uint word) { imageStore(stored_walk, cell, uvec4(word)); }
#endif
