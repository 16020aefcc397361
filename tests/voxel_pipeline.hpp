// A scene made in code and its lit voxels: chapters 03 to 07 without a program around them. Header only.
//
//     VoxelPipeline pipeline(scene, 64);
//     for (const LitFace& face : pipeline.faces()) ...          // mean material and radiance of every occupied face
//     const PyramidLevel level = pipeline.level(2);             // what the pyramids hold
#pragma once

#include "lit_scene.hpp"
#include "scene_builder.hpp"

namespace conebook {

// An occupied face as chapters 05 and 06 leave it.
struct LitFace {
    glm::ivec3 voxel;
    int direction;  // 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z
    shared::VoxelFace mean;
    glm::vec3 radiance;  // reflected of direct light, and emitted, W/(sr m^2)
    float visibility;    // 0..1
};

// One level of the six pyramids in double precision.
struct PyramidLevel {
    glm::ivec3 size{0};
    std::vector<glm::dvec4> texels;  // rgb: coverage times radiance, a: coverage
    std::size_t index(int direction, const glm::ivec3& v) const
    {
        return (std::size_t(v.z) * std::size_t(size.y) + std::size_t(v.y)) * 6 * std::size_t(size.x) +
               std::size_t(direction * size.x + v.x);
    }
    const glm::dvec4& at(int direction, const glm::ivec3& v) const { return texels[index(direction, v)]; }
    glm::dvec4& at(int direction, const glm::ivec3& v) { return texels[index(direction, v)]; }
};

// function(direction, voxel) for every texel.
template <typename Function>
void for_each_voxel(const PyramidLevel& level, Function function)
{
    for (int direction = 0; direction < 6; ++direction)
        for (int z = 0; z < level.size.z; ++z)
            for (int y = 0; y < level.size.y; ++y)
                for (int x = 0; x < level.size.x; ++x) function(direction, glm::ivec3(x, y, z));
}

class VoxelPipeline {
public:
    VoxelPipeline(const Scene& scene, int voxels, const VoxelShadingParams& shading = {},
                  const PyramidParams& pyramid = {})
        : lit_(scene, voxels, shading, pyramid)
    {
    }

    std::vector<LitFace> faces() const
    {
        const auto entries = lit_.faces.face_list().read<GLuint>();
        const auto means = lit_.faces.faces().read<shared::VoxelFace>();
        const auto radiance = lit_.shading.radiance().read<glm::vec4>();
        std::vector<LitFace> all;
        for (std::size_t i = 0; i < lit_.faces.face_count(); ++i) {
            const GLuint e = entries[i];
            all.push_back({{int(e & 511u), int((e >> 9) & 511u), int((e >> 18) & 511u)},
                           int(e >> 27),
                           means[i],
                           glm::vec3(radiance[i]) + glm::vec3(means[i].emission),
                           radiance[i].a});
        }
        return all;
    }

    PyramidLevel level(int level) const
    {
        const std::vector<float> values = gl::read_floats(lit_.pyramid.light(), level, 4);
        PyramidLevel result{lit_.grid.size() >> level, {}};
        for (std::size_t i = 0; i < values.size(); i += 4)
            result.texels.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
        return result;
    }

    const shared::GridData& grid() const { return lit_.grid.data(); }
    int levels() const { return lit_.grid.levels(); }
    glm::dvec3 scene_from_grid(const glm::dvec3& p) const
    {
        return p * double(lit_.grid.voxel_size_m()) + glm::dvec3(lit_.grid.data().origin);
    }

private:
    LitScene lit_;
};

}  // namespace conebook
