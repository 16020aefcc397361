// What a voxelization counts.
#include "common/bindings.glsl"
#include "common/voxel_structs.glsl"

layout(std430, binding = kVoxelCounterBinding) buffer VoxelStatisticsBuffer { VoxelStatistics voxel_statistics; };

void count_degenerate() { atomicAdd(voxel_statistics.degenerate, 1u); }
