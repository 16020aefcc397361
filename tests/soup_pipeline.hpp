// A scene made in code and its voxels: chapters 04 and 05 without a program around them. Header only.
#pragma once

#include <array>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "scene_builder.hpp"
#include "voxel_scene.hpp"

namespace conebook {

// Bounds for which make_grid() gives voxels of 1 m and grid space = scene space: n voxels along x, the first side at 0.
inline Bounds unit_bounds(int n) { return {glm::vec3(0.5f), glm::vec3(float(n) - 0.5f)}; }

// A scene of triangles without sharing, one material.
inline Scene triangle_soup(const std::vector<std::array<glm::vec3, 3>>& triangles, const Material& material = lambert(0.5f))
{
    Scene scene;
    scene.materials.push_back(material);
    for (const auto& t : triangles) {
        const glm::vec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
        const float length = glm::length(n);
        for (const glm::vec3& p : t) {
            scene.indices.push_back(std::uint32_t(scene.vertices.size()));
            scene.vertices.push_back({p, length > 0.0f ? n / length : glm::vec3(0, 1, 0), glm::vec4(1, 0, 0, 1),
                                      glm::vec2(0.0f), glm::vec2(0.0f), glm::vec4(1.0f)});
        }
    }
    scene.draws.push_back({0, std::uint32_t(scene.indices.size()), 0, ""});
    scene.bounds = {scene.vertices[0].position, scene.vertices[0].position};
    for (const Vertex& v : scene.vertices) {
        scene.bounds.min = glm::min(scene.bounds.min, v.position);
        scene.bounds.max = glm::max(scene.bounds.max, v.position);
    }
    return scene;
}

inline glm::vec3 random_direction(std::mt19937& random)
{
    std::normal_distribution<float> gauss;
    return glm::normalize(glm::vec3(gauss(random), gauss(random), gauss(random)) + 1e-9f);
}

// Triangles of random shape and direction, sizes spread evenly on a log scale, kept inside the bounds.
inline std::vector<std::array<glm::vec3, 3>> random_triangles(std::mt19937& random, int count, const Bounds& bounds,
                                                              float smallest, float largest)
{
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    std::vector<std::array<glm::vec3, 3>> triangles;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 center = bounds.min + bounds.extent() * glm::vec3(unit(random), unit(random), unit(random));
        const float size = smallest * std::pow(largest / smallest, unit(random));
        std::array<glm::vec3, 3> t;
        for (glm::vec3& p : t)
            p = glm::clamp(center + 0.58f * size * random_direction(random), bounds.min, bounds.max);
        triangles.push_back(t);
    }
    return triangles;
}

class SoupPipeline {
public:
    SoupPipeline(const Scene& scene, int voxels, Voxelizer voxelizer = Voxelizer::compute)
        : SoupPipeline(scene, scene.bounds, voxels, voxelizer)
    {
    }
    SoupPipeline(const Scene& scene, const Bounds& bounds, int voxels, Voxelizer voxelizer = Voxelizer::compute,
                 bool conservative = true)
        : voxels_(scene, bounds, voxels, {voxelizer, conservative, false})
    {
    }
    void voxelize() { voxels_.voxelize(); }
    void average() { voxels_.average(); }

    // Mask of faces of every voxel, x fastest.
    std::vector<GLuint> occupancy() const { return gl::read_uints(voxels_.voxelizer.occupancy()); }
    std::vector<shared::VoxelFace> faces() const
    {
        auto all = voxels_.faces.faces().read<shared::VoxelFace>();
        all.resize(voxels_.faces.face_count());
        return all;
    }
    std::vector<GLuint> face_list() const
    {
        auto all = voxels_.faces.face_list().read<GLuint>();
        all.resize(voxels_.faces.face_count());
        return all;
    }
    // By (voxel, face direction).
    std::map<std::pair<std::array<int, 3>, int>, shared::VoxelFace> faces_by_voxel() const
    {
        std::map<std::pair<std::array<int, 3>, int>, shared::VoxelFace> map;
        const auto list = face_list();
        const auto values = faces();
        for (std::size_t i = 0; i < list.size(); ++i)
            map[{{int(list[i] & 511u), int(list[i] >> 9 & 511u), int(list[i] >> 18 & 511u)}, int(list[i] >> 27)}] =
                values[i];
        return map;
    }
    shared::VoxelStatistics statistics() const
    {
        return voxels_.voxelizer.statistics_buffer().read_at<shared::VoxelStatistics>(0);
    }
    std::size_t fragment_count() const { return voxels_.voxelizer.fragments().count(); }
    double total_area_voxels() const
    {
        double sum = 0.0;
        for (const auto& face : faces()) sum += double(face.albedo_area.a);
        return sum;
    }

    const GpuScene& scene() const { return voxels_.scene; }
    const VoxelGrid& grid() const { return voxels_.grid; }
    ConservativeVoxelizer& voxelizer() { return voxels_.voxelizer; }
    VoxelFaces& voxel_faces() { return voxels_.faces; }

private:
    VoxelScene voxels_;
};

}  // namespace conebook
