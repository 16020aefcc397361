#include "14_speed_against_error/part_pictures.hpp"

namespace conebook {

void write_part_pictures(const std::filesystem::path& output, CameraLight& light)
{
    for (const std::string part : {"final", "direct", "indirect_diffuse", "indirect_specular"}) {
        const std::filesystem::path file = output.parent_path() / (output.stem().string() + "_" + part + ".exr");
        write_exr(file, finite_picture(light.composite(part), file));
    }
}

}  // namespace conebook
