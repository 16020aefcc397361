// The scenes of assets/: one function each. What each is for and its measures: assets/README.md.
#pragma once

#include "glb.hpp"

namespace conebook::generator {

Asset cornell_box();
Asset cornell_area();
Asset cornell_empty();
Asset white_furnace();
Asset thin_wall();
Asset thin_wall_solid();
Asset lights();
Asset glossy_room();
Asset emissive_shapes();
Asset materials();
Asset colonnade();
Asset door();
Asset walking_lamp();
Asset spinning_shapes();
Asset figure();

}  // namespace conebook::generator
