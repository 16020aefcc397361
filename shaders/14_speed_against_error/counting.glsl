// Counters that the cones of chapters 08, 09 and 11 call, for one invocation. Included before them.
uint walk_steps = 0u;     // texels of the walk volume
uint light_fetches = 0u;  // filtered texels of the pyramids
// snippet: count_macros
#define COUNT_WALK_STEPS(count) walk_steps += uint(count);
#define COUNT_LIGHT_FETCHES(count) light_fetches += uint(count);
// end snippet
