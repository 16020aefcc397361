#include "gl/pose_pass.hpp"

#include <algorithm>

namespace conebook {

// The shader reads both as words.
static_assert(sizeof(ModelledVertex) == 18 * sizeof(float) && sizeof(MorphDelta) == 9 * sizeof(float));
static_assert(sizeof(Vertex) == 18 * sizeof(float));

PosePass::PosePass(gl::Shaders& shaders, const Scene& scene) : scene_(scene)
{
    std::size_t matrices = 0, weights = 0;
    const std::vector<NodePose> rest = rest_pose(scene);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.dynamic || node.modelled.count == 0 || node.object >= 0) continue;
        parts_.push_back({i, matrices, weights, {}, {}});
        matrices += scene_from_mesh(scene, rest, i).size();
        weights += node.weights.size();
    }
    if (parts_.empty()) return;
    program_ = shaders.load({"common/pose.comp"});
    modelled_ = gl::Buffer("modelled vertices", scene.modelled);
    deltas_ = gl::Buffer("morph targets", scene.deltas);
    matrices_ = gl::Buffer("pose matrices", matrices * sizeof(glm::mat4));
    weights_ = gl::Buffer("morph weights", weights * sizeof(float));
}

bool PosePass::run(GpuScene& gpu_scene, const std::vector<NodePose>& nodes)
{
    moved_.clear();
    for (Part& part : parts_) {
        std::vector<glm::dmat4> matrices = scene_from_mesh(scene_, nodes, part.node);
        const std::vector<double>& weights = nodes[part.node].weights;
        if (matrices == part.matrices && weights == part.weights) continue;
        part.matrices = std::move(matrices);
        part.weights = weights;
        moved_.push_back(part.node);
        const std::vector<glm::mat4> as_floats(part.matrices.begin(), part.matrices.end());
        matrices_.write(part.first_matrix * sizeof(glm::mat4), as_floats.size() * sizeof(glm::mat4), as_floats.data());
        const std::vector<float> float_weights(weights.begin(), weights.end());
        if (!weights.empty())
            weights_.write(part.first_weight * sizeof(float), weights.size() * sizeof(float), float_weights.data());
    }
    if (moved_.empty()) return false;
    program_.use();
    gpu_scene.vertices().bind(GL_SHADER_STORAGE_BUFFER, shared::kVertexBinding);
    modelled_.bind(GL_SHADER_STORAGE_BUFFER, shared::kModelledBinding);
    deltas_.bind(GL_SHADER_STORAGE_BUFFER, shared::kMorphDeltaBinding);
    matrices_.bind(GL_SHADER_STORAGE_BUFFER, shared::kPoseMatrixBinding);
    weights_.bind(GL_SHADER_STORAGE_BUFFER, shared::kMorphWeightBinding);
    for (const Part& part : parts_)
        if (std::find(moved_.begin(), moved_.end(), part.node) != moved_.end()) dispatch(part);
    // As attributes of vertices, and as what shaders pull.
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    gpu_scene.mark_moved();
    return true;
}

void PosePass::dispatch(const Part& part) const
{
    constexpr GLuint kGroup = 64;                     // of pose.comp
    constexpr GLuint kMostVertices = 65535 * kGroup;  // the least that OpenGL 4.5 promises (table 23.66)
    const Node& node = scene_.nodes[part.node];
    program_.set("first_matrix", GLuint(part.first_matrix));
    program_.set("has_skin", node.skin >= 0);
    program_.set("first_weight", GLuint(part.first_weight));
    program_.set("target_count", GLuint(node.weights.size()));
    program_.set("target_stride", node.modelled.count);
    program_.set("is_mirrored", node.mirrored);
    for (std::uint32_t d = node.draws.first; d < node.draws.end(); ++d) {
        const Draw& draw = scene_.draws[d];
        program_.set("flat_normals", draw.flat_normals);
        const std::uint32_t in_node = draw.vertices.first - node.vertices.first;
        const GLuint step = kMostVertices / 3 * 3;  // triangles stay together
        for (GLuint done = 0; done < draw.vertices.count; done += step) {
            const GLuint count = std::min(step, draw.vertices.count - done);
            program_.set("vertex_count", count);
            program_.set("first_vertex", draw.vertices.first + done);
            program_.set("first_modelled", node.modelled.first + in_node + done);
            program_.set("first_delta", node.first_delta + in_node + done);
            glDispatchCompute(gl::group_count(count, kGroup), 1, 1);
        }
    }
}

std::vector<gl::Resource> PosePass::resources() const
{
    if (parts_.empty()) return {};
    return {{"poses", modelled_.bytes() + deltas_.bytes() + matrices_.bytes() + weights_.bytes()}};
}

}  // namespace conebook
