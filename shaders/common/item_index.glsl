// Compute shaders over a list, in work groups of 64 threads, one thread an item: the item of this thread. The groups
// beyond the 65,535 that OpenGL promises a side are in further rows (gl::group_counts()); the last may reach beyond the
// list.
layout(local_size_x = 64) in;

uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint item_index() { return 64u * group_index() + gl_LocalInvocationIndex; }
