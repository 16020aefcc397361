// What the passes that build the octree share.
#define TREE_ACCESS
#include "17_sparse_voxel_octree/octree.glsl"
#include "common/item_index.glsl"

layout(std430, binding = kTreeStateBinding) buffer StateBuffer { OctreeState tree; };
layout(std430, binding = kNodePlaceBinding) buffer PlaceBuffer { uint node_places[]; };
// While the tree grows: bits 0-5 directions that voxels of the node send to, bits 6-11 with those of its neighbours. In
// the end: first brick << 6 | directions.
layout(std430, binding = kNodeBrickBinding) buffer NodeBrickBuffer { uint node_bricks[]; };
uniform int level;
