// The list scattered into the voxels: one word each, of which the largest stays.
#pragma once

#include "18_voxel_ray_marching/stream_out.hpp"

namespace conebook {

enum class Payload : int { index = 0, packed = 1 };

struct PieceVoxelParams {
    // index: 7 bits of brightness and the piece's number, so that its light, normal and place are exact. packed: the
    // document's word, 4 bits a channel, 5 a component of the normal.
    int payload = int(Payload::index);
    // payload=index. lot: of several pieces in a voxel any, so that the mean over voxels is right; brightest: the
    // document's, which makes everything brighter where light has edges. payload=packed always keeps the brightest.
    int winner = 0;
    // six: a word for each side of a voxel, by the normal, so that thin walls have two sides and corners all of theirs.
    // one: the document's.
    int sides = 0;
};
void add_parameters(ParameterTable& table, PieceVoxelParams& params);

class PieceVoxels {
public:
    explicit PieceVoxels(gl::Shaders& shaders);

    // Throws std::runtime_error where there are more pieces than the word can number.
    void run(const StreamOut& list, const VoxelGrid& grid, const PieceVoxelParams& params);
    // For programs that include walk.glsl and are compiled with defines(): volumes, list, grid, their uniforms.
    void bind(const gl::Program& program) const;
    gl::Defines defines() const;  // of the last run
    const PieceVoxelParams& params() const { return params_; }

    GLuint occupied() const { return occupied_; }
    const gl::Texture& voxels() const { return voxels_; }  // r32ui: the word, with six sides a bit for each
    const gl::Texture& sides() const { return sides_; }    // r32ui: the words, six volumes side by side along x
    std::vector<gl::Resource> resources() const;

private:
    gl::ProgramVariants scatter_;
    gl::Texture voxels_, sides_;
    const gl::Buffer* pieces_ = nullptr;  // of the last run
    const VoxelGrid* grid_ = nullptr;
    PieceVoxelParams params_;
    GLuint occupied_ = 0;
    float largest_radiance_ = 0.0f;
};

// Pictures of them, for --view. RGBA32F, alpha 1 where there is something; valid until the next call.
class PieceViews {
public:
    explicit PieceViews(gl::Shaders& shaders);
    const gl::Texture& points(const StreamOut& list, const gl::Buffer& camera, glm::ivec2 size);
    const gl::Texture& cubes(const PieceVoxels& voxels, const gl::Buffer& camera, glm::ivec2 size);

private:
    gl::Program points_;
    gl::ProgramVariants cubes_;
    gl::VertexArray no_vertices_, vertices_;
    gl::Texture color_, depth_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
