#include "16_only_what_is_needed/brick_light.hpp"

#include <stdexcept>

#include "16_only_what_is_needed/brick_list.hpp"

namespace conebook {

BrickIndex::BrickIndex(gl::Shaders& shaders)
    : mark_(shaders, {"16_only_what_is_needed/brick_mark.comp"}),
      directions_(shaders, {"16_only_what_is_needed/brick_directions.comp"}),
      places_(shaders.load({"16_only_what_is_needed/brick_places.comp"})),
      texels_(shaders.load({"16_only_what_is_needed/brick_texels.comp"})),
      totals_("brick totals", 2 * sizeof(GLuint))
{
}

void BrickIndex::run(const VoxelGrid& grid, const VoxelFaces& faces, const OccupiedLevels& occupied,
                     Directions directions)
{
    if (!made_from_.differs(faces.revision(), directions)) return;
    // How many bricks each level has.
    std::vector<glm::uvec4> records(shared::kLevelRecords);
    std::size_t count = shared::kLevelRecords;
    for (int level = 0; level < grid.levels(); ++level) {
        const glm::ivec3 size = ((grid.size() >> level) + shared::kBrickSide - 1) / shared::kBrickSide;
        records[std::size_t(level)] = glm::uvec4(size, GLuint(count));
        count += std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    }
    const gl::Buffer bricks("bricks", count * sizeof(glm::uvec4));
    bricks.write(0, records.size() * sizeof(glm::uvec4), records.data());
    bricks.bind(GL_SHADER_STORAGE_BUFFER, shared::kBrickBinding);
    totals_.bind(GL_SHADER_STORAGE_BUFFER, shared::kBrickTotalBinding);
    grid.bind();
    faces.bind();
    const auto for_voxels_of = [&](gl::ProgramVariants& programs, int level) {
        const gl::Program& program =
            programs.with({{"FINEST", level == 0 ? "1" : "0"}, {"DIRECTIONS", std::to_string(int(directions))}});
        if (level > 0) return occupied.dispatch(program, level);
        program.set("level", 0);
        program.use();
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.voxel_groups().id());
        glDispatchComputeIndirect(0);
    };
    const auto scan = [&](const gl::Program& program, std::size_t items, int total) {
        program.set("item_count", GLuint(items));
        program.use();
        glDispatchCompute(1, 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
        return totals_.read_at<GLuint>(std::size_t(total) * sizeof(GLuint));
    };

    // A bit for each voxel; where the list has a brick's first.
    for (int level = 0; level < grid.levels(); ++level) for_voxels_of(mark_, level);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    fit_list(bricks_, "bricks", GL_RGBA32UI, count);
    bricks_.bind_image(0, 0, GL_WRITE_ONLY);
    const std::size_t voxels = scan(places_, count, 0);

    // Their sides; where the list of texels has a voxel's first.
    const gl::Buffer sides("sides of voxels", voxels * sizeof(GLuint));
    sides.bind(GL_SHADER_STORAGE_BUFFER, shared::kBrickVoxelBinding);
    for (int level = 0; level < grid.levels(); ++level) {
        for_voxels_of(directions_, level);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    fit_list(voxels_, "voxels of bricks", GL_R32UI, voxels);
    voxels_.bind_image(0, 0, GL_WRITE_ONLY);
    texel_count_ = scan(texels_, voxels, 1);
    if (texel_count_ >= (1u << 26))
        throw std::runtime_error("the pyramids have more than 2^26 texels; use a smaller --set voxels=");
}

void BrickLight::fit(LightTexels& texels, const VoxelGrid& grid, const VoxelFaces& faces,
                     const OccupiedLevels& occupied, const PyramidParams& params)
{
    index_.run(grid, faces, occupied, Directions(params_.directions));
    const LightFormat format = LightFormat(params.format);
    fit_list(texels.light, "light pyramid", texel_format(format), index_.texel_count());
    texels.light.clear();
    if (format == LightFormat::r11g11b10f) {
        fit_list(texels.coverage, "coverage pyramid", GL_R8, index_.texel_count());
        texels.coverage.clear();
    } else {
        texels.coverage = {};
    }
    texels.defines = {{"LIGHT_STORAGE", "16_only_what_is_needed/brick_light.glsl"},
                      {"OCCUPANCY_STORAGE", "16_only_what_is_needed/brick_occupancy.glsl"}};
    texels.index = {{GLuint(shared::kBrickUnit), &index_.bricks()},
                    {GLuint(shared::kBrickVoxelUnit), &index_.voxels()}};
}

}  // namespace conebook
