#include "16_only_what_is_needed/brick_walk.hpp"

#include "16_only_what_is_needed/brick_list.hpp"

namespace conebook {

BrickWalk::BrickWalk(gl::Shaders& shaders)
    : find_bricks_(shaders.load({"16_only_what_is_needed/brick_walk_bricks.comp"})),
      total_("bricks of the walk volume", sizeof(GLuint))
{
}

void BrickWalk::fit(WalkCellWords& cells, const VoxelGrid& grid)
{
    const glm::ivec3 size = (grid.size() + 1 + shared::kBrickSide - 1) / shared::kBrickSide;
    if (!bricks_ || bricks_.size() != size) bricks_ = gl::texture_3d("bricks of the walk volume", GL_R32UI, size);
    total_.clear();
    total_.bind(GL_SHADER_STORAGE_BUFFER, shared::kBrickTotalBinding);
    bricks_.bind_image(0, 0, GL_WRITE_ONLY);
    find_bricks_.use();
    gl::dispatch_items(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z), 64);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    listed_bricks_ = total_.read_at<GLuint>(0);

    constexpr std::size_t kCells = shared::kBrickSide * shared::kBrickSide * shared::kBrickSide;
    fit_list(cells.words, "walk volume", GL_R32UI, std::max<std::size_t>(listed_bricks_, 1) * kCells);
    cells.defines = {{"WALK_STORAGE", "16_only_what_is_needed/brick_walk.glsl"}};
    cells.index = {{GLuint(shared::kWalkBrickUnit), &bricks_}};
}

}  // namespace conebook
