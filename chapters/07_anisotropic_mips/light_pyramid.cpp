#include "07_anisotropic_mips/light_pyramid.hpp"

#include <algorithm>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, PyramidParams& params)
{
    table.add("isotropic", params.isotropic, "finest level: one value for all six directions, for comparison");
}

void add_parameters(ParameterTable& table, PyramidViewParams& params)
{
    table.add("direction", params.direction, {"-x", "+x", "-y", "+y", "-z", "+z", "seen"},
              "direction that pyramid views show");
}

LightPyramid::LightPyramid(gl::Shaders& shaders, const VoxelGrid& grid, const PyramidParams& params)
    : base_(shaders.load({"07_anisotropic_mips/light_base.comp"}, {{"ISOTROPIC", params.isotropic ? "1" : "0"}})),
      next_level_(shaders.load({"07_anisotropic_mips/light_level.comp"})),
      light_(gl::texture_3d("light pyramid", GL_RGBA16F, grid.size() * glm::ivec3(shared::kFaceCount, 1, 1),
                            grid.levels()))
{
    light_.set_filter(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
    clear();
}

void LightPyramid::bind() const { light_.bind(GLuint(shared::kLightAtlasUnit)); }

void LightPyramid::run(const VoxelGrid& grid, const VoxelFaces& faces, const gl::Buffer& face_radiance)
{
    constexpr GLbitfield kWrittenImage = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;
    // Finest level: occupied voxels only, the others stay empty.
    grid.bind();
    faces.bind();
    bind();
    face_radiance.bind(GL_SHADER_STORAGE_BUFFER, 11);
    light_.bind_image(0, 0, GL_WRITE_ONLY);
    base_.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.voxel_groups().id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(kWrittenImage);

    // Each level from the one below.
    next_level_.use();
    for (int level = 1; level < grid.levels(); ++level) {
        light_.bind_image(0, level, GL_WRITE_ONLY);
        next_level_.set("level", level);
        glm::ivec3 size = grid.size() >> level;
        size.x *= shared::kFaceCount;
        const glm::ivec3 groups = (size + 3) / 4;
        glDispatchCompute(GLuint(groups.x), GLuint(groups.y), GLuint(groups.z));
        glMemoryBarrier(kWrittenImage);
    }
}

PyramidViewPass::PyramidViewPass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "07_anisotropic_mips/pyramid_view.frag"}))
{
}

const gl::Texture& PyramidViewPass::run(const VoxelGrid& grid, const gl::Texture& occupancy,
                                        const LightPyramid& pyramid, int level, const PyramidViewParams& params,
                                        bool show_coverage, const gl::Buffer& camera, glm::ivec2 size)
{
    gl::fit_to_pixels(color_, framebuffer_, "pyramid view", GL_RGBA16F, size);
    grid.bind();
    camera.bind(GL_UNIFORM_BUFFER, 0);
    occupancy.bind(shared::kOccupancyUnit);
    pyramid.bind();
    program_.set("level", std::min(level, grid.levels() - 1));
    program_.set("direction", params.direction);
    program_.set("show_coverage", show_coverage);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, size);
    return color_;
}

}  // namespace conebook
