// Other ways to average, and how far they are from the right answer. Only chapter 05 uses them.
#pragma once

#include "05_atomic_averaging/voxel_faces.hpp"

namespace conebook {

// How chapter 05 averages, for comparison; later chapters use the sums.
enum class Averaging : int { sums = 0, compare_and_swap = 1, compare_and_swap_truncating = 2, racing_store = 3 };

// Into one RGBA8 texel a voxel; both sides of a sheet share it. Every fragment weighs the same.
class NaiveAverage {
public:
    explicit NaiveAverage(gl::Shaders& shaders);
    // `averaging`: any but the sums.
    void run(const GpuScene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer, Averaging averaging);
    const gl::Texture& color() const { return color_; }  // r32ui holding RGBA8, A the number of fragments

private:
    FragmentPrograms programs_;
    gl::Texture color_;
};

// Root mean square difference from the faces' albedo, over all channels of the voxels with a single face (the others
// mix faces, which is another error).
double rms_error(const NaiveAverage& naive, const VoxelFaces& faces);

// Counts what differs from the first frame: naive texels, or words of the faces when there is no naive mean.
class ChangeCounter {
public:
    void look(const VoxelFaces& faces, const NaiveAverage* naive);
    double most_changed() const { return most_changed_; }

private:
    std::vector<GLuint> first_;
    double most_changed_ = 0.0;
};

}  // namespace conebook
