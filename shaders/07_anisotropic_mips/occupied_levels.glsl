// Which voxels of every level hold something; their order may differ from run to run, what is made from them does not.
struct LevelCount {
    uint groups_x, groups_y, groups_z;  // indirect dispatch, 64 voxels a work group, in rows of kMostGroups
    uint count;
};
const uint kMostGroups = 65535u;  // the most a side that OpenGL 4.5 promises, as in gl::group_counts()

// Packed voxels, level after level.
layout(std430, binding = kOccupiedBinding) buffer OccupiedBuffer { uint occupied[]; };
layout(std430, binding = kLevelBinding) buffer LevelBuffer { LevelCount levels[]; };
