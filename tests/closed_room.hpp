// The white furnace as a file, of any reflectance and turned in any way. Header only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "robustness/gltf_builder.hpp"

namespace conebook {

// A closed cube of side 2 round the origin, every wall pure Lambert of rho that shines with Le (up to 1), turned by
// `rotation`, and a camera in it. With n bounces its radiance is Le (1 + rho + ... + rho^n) in every point and direction.
inline std::filesystem::path write_closed_room(const std::filesystem::path& folder, double rho, double emission,
                                               const glm::quat& rotation = {1, 0, 0, 0})
{
    test::GltfBuilder gltf;
    std::vector<float> positions;
    std::vector<std::uint16_t> indices;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const auto base = std::uint16_t(positions.size() / 3);
            for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
                glm::vec3 p;
                p[axis] = side;
                p[(axis + 1) % 3] = corner.x;
                p[(axis + 2) % 3] = corner.y;
                positions.insert(positions.end(), {p.x, p.y, p.z});
            }
            // Counter-clockwise as seen from inside: the normal is -side along the axis.
            for (const int i : {0, 1, 2, 0, 2, 3})
                indices.push_back(std::uint16_t(base + (side < 0.0f ? i : (4 - i) % 4)));
        }
    const int position = gltf.add_floats(positions, 3);
    const int index = gltf.add_accessor(indices, test::u16, "SCALAR");
    gltf.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", index}, {"material", 0}});
    gltf.append("materials",
                {{"pbrMetallicRoughness", {{"baseColorFactor", {rho, rho, rho, 1.0}}, {"metallicFactor", 0.0}}},
                 {"emissiveFactor", {emission, emission, emission}},
                 {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0.0}}}}}});
    gltf.root["extensionsUsed"] = {"KHR_materials_specular"};
    gltf.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.2}, {"znear", 0.01}}}});
    gltf.add_node({{"mesh", 0}, {"rotation", {rotation.x, rotation.y, rotation.z, rotation.w}}});
    gltf.add_node({{"camera", 0}, {"translation", {0.15, 0.1, 0.05}}});
    gltf.root["scenes"][0]["nodes"] = {0, 1};
    return test::write_file(folder / "room.glb", gltf.glb());
}

}  // namespace conebook
