// Which voxels of every level hold something; their order may differ from run to run, what is made from them does not.
struct LevelCount {
    uint groups_x, groups_y, groups_z;  // indirect dispatch, 64 voxels a work group
    uint count;
};
// Packed voxels, level after level.
layout(std430, binding = kOccupiedBinding) buffer OccupiedBuffer { uint occupied[]; };
layout(std430, binding = kLevelBinding) buffer LevelBuffer { LevelCount levels[]; };
