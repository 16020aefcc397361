// All parts of the light of one frame as pictures beside the one that the program writes.
#pragma once

#include <filesystem>

#include "12_second_bounce/camera_light.hpp"

namespace conebook {

// Writes final, direct, indirect_diffuse and indirect_specular of the last frame of `light`: X.exr or X.png becomes
// X_direct.exr, ... Throws std::runtime_error when a file cannot be written or a value is not finite.
void write_part_pictures(const std::filesystem::path& output, CameraLight& light);

}  // namespace conebook
