// Poses on the GPU: writes the vertices of what has moved where GpuScene has them, so that everything else stays as it
// is.
// Its twin on the CPU: scene/pose.hpp.
#pragma once

#include <vector>

#include "gl/gpu_scene.hpp"
#include "scene/pose.hpp"

namespace conebook {

class PosePass {
public:
    // `scene` must outlive this, and the nodes of its file stay as they are. Without anything dynamic among them, this
    // holds nothing and does nothing; objects that were put into the scene are placed by who moves them.
    PosePass(gl::Shaders& shaders, const Scene& scene);

    // Poses the dynamic nodes whose matrices or weights differ from those of the last call (at the first: all of them, so that
    // no vertex is the loader's, which rounds otherwise) and counts up geometry_revision(). Says whether there were any. `gpu_scene` was made from the same scene.
    bool run(GpuScene& gpu_scene, const std::vector<NodePose>& nodes);

    // Indices into Scene::nodes of those that the last call moved.
    const std::vector<std::size_t>& moved() const { return moved_; }
    std::vector<gl::Resource> resources() const;

private:
    // A dynamic node: where its matrices and weights begin, and what they were.
    struct Part {
        std::size_t node = 0;
        std::size_t first_matrix = 0, first_weight = 0;
        std::vector<glm::dmat4> matrices;
        std::vector<double> weights;
    };
    void dispatch(const Part& part) const;

    const Scene& scene_;
    gl::Program program_;
    std::vector<Part> parts_;
    std::vector<std::size_t> moved_;
    gl::Buffer modelled_, deltas_, matrices_, weights_;
};

}  // namespace conebook
