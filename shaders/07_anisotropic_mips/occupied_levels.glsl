// Which voxels of every level hold something; their order may differ from run to run, what is made from them does not.
struct LevelCount {
    uint groups_x, groups_y, groups_z;  // indirect dispatch, 64 voxels a work group
    uint count;
};
layout(std430, binding = 12) buffer OccupiedBuffer { uint occupied[]; };  // packed voxels, level after level
layout(std430, binding = 13) buffer LevelBuffer { LevelCount levels[]; };
