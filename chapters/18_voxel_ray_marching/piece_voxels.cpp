#include "18_voxel_ray_marching/piece_voxels.hpp"

#include <cstring>
#include <stdexcept>

#include "gl/pixel_pass.hpp"

namespace conebook {

namespace {
// Their order is that of the choices.
constexpr int kSixSides = 0;
constexpr int kIndexBits = 24;  // packing.glsl
}  // namespace

void add_parameters(ParameterTable& table, PieceVoxelParams& params)
{
    table.add("payload", params.payload, {"index", "packed"},
              "a voxel's word: the brightest piece's number, or 32 bits of it");
    table.add("winner", params.winner, {"lot", "brightest"}, "payload=index: which of several pieces a voxel keeps");
    table.add("sides", params.sides, {"six", "one"}, "words of a voxel: one a side, or one");
}

PieceVoxels::PieceVoxels(gl::Shaders& shaders) : scatter_(shaders, {"18_voxel_ray_marching/scatter.comp"}) {}

gl::Defines PieceVoxels::defines() const
{
    return {{"INDEX", params_.payload == int(Payload::index) ? "1" : "0"},
            {"BRIGHTEST", params_.winner == 1 ? "1" : "0"},
            {"SIX_SIDES", params_.sides == kSixSides ? "1" : "0"}};
}

void PieceVoxels::run(const StreamOut& list, const VoxelGrid& grid, const PieceVoxelParams& params)
{
    params_ = params;
    pieces_ = &list.pieces();
    grid_ = &grid;
    if (params_.payload == int(Payload::index) && list.count() >= 1u << kIndexBits)
        throw std::runtime_error("payload=index: " + std::to_string(list.count()) + " pieces, and the word numbers " +
                                 std::to_string((1 << kIndexBits) - 1) + "; use fewer voxels or payload=packed");
    if (!voxels_ || voxels_.size() != grid.size()) voxels_ = gl::texture_3d("voxels", GL_R32UI, grid.size());
    const glm::ivec3 sides_size =
        params_.sides == kSixSides ? grid.size() * glm::ivec3(shared::kFaceCount, 1, 1) : glm::ivec3(1);
    if (!sides_ || sides_.size() != sides_size) sides_ = gl::texture_3d("sides of voxels", GL_R32UI, sides_size);
    voxels_.clear();
    sides_.clear();

    const gl::Program& scatter = scatter_.with(defines());
    scatter.use();
    grid.bind();
    voxels_.bind_image(0, 0, GL_READ_WRITE);
    sides_.bind_image(1, 0, GL_READ_WRITE);
    list.pieces().bind(GL_SHADER_STORAGE_BUFFER, shared::kPieceBinding);
    list.counts().bind(GL_SHADER_STORAGE_BUFFER, shared::kPieceCountBinding);
    scatter.set("piece_count", list.count());
    gl::dispatch_items(list.count(), 64);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    const std::vector<GLuint> counts = list.counts().read<GLuint>();
    std::memcpy(&largest_radiance_, &counts[0], sizeof largest_radiance_);
    occupied_ = counts[1];
}

void PieceVoxels::bind(const gl::Program& program) const
{
    grid_->bind();
    voxels_.bind(22);
    sides_.bind(23);
    pieces_->bind(GL_SHADER_STORAGE_BUFFER, shared::kPieceBinding);
    program.set("largest_channel", largest_radiance_);
}

std::vector<gl::Resource> PieceVoxels::resources() const { return {voxels_.resource(), sides_.resource()}; }

PieceViews::PieceViews(gl::Shaders& shaders)
    : points_(shaders.load({"18_voxel_ray_marching/pieces.vert", "18_voxel_ray_marching/pieces.frag"})),
      cubes_(shaders, {"common/fullscreen.vert", "18_voxel_ray_marching/voxel_view.frag"})
{
    for (GLuint i = 0; i < 2; ++i) {
        glEnableVertexArrayAttrib(vertices_.id(), i);
        glVertexArrayAttribIFormat(vertices_.id(), i, 4, GL_UNSIGNED_INT, i * 4 * GLuint(sizeof(GLuint)));
        glVertexArrayAttribBinding(vertices_.id(), i, 0);
    }
}

const gl::Texture& PieceViews::points(const StreamOut& list, const gl::Buffer& camera, glm::ivec2 size)
{
    if (!depth_ || depth_.size_2d() != size) {
        color_ = gl::texture_2d("pieces", GL_RGBA32F, size);
        depth_ = gl::texture_2d("depth of pieces", GL_DEPTH_COMPONENT32F, size);
        framebuffer_ = gl::Framebuffer("pieces", {&color_}, &depth_);
    }
    color_.clear();
    depth_.clear();  // 0: farthest
    framebuffer_.bind(size);
    camera.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    points_.use();
    glVertexArrayVertexBuffer(vertices_.id(), 0, list.pieces().id(), 0, sizeof(Piece));
    glBindVertexArray(vertices_.id());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDrawArrays(GL_POINTS, 0, GLsizei(list.count()));
    glDisable(GL_DEPTH_TEST);
    return color_;
}

const gl::Texture& PieceViews::cubes(const PieceVoxels& voxels, const gl::Buffer& camera, glm::ivec2 size)
{
    const gl::Program& program = cubes_.with(voxels.defines());
    depth_ = gl::Texture();  // points() makes both again
    gl::fit_to_pixels(color_, framebuffer_, "voxels", GL_RGBA32F, size);
    camera.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    voxels.bind(program);
    program.set("sky_radiance", glm::vec3(-1.0f));
    program.set("min_distance", 0.0f);
    gl::draw_pixels(program, framebuffer_, no_vertices_, size);
    return color_;
}

}  // namespace conebook
