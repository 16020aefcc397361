#include "08_diffuse_cones/walk_volume.hpp"

#include <algorithm>

namespace conebook {

namespace {

// As in shaders/08_diffuse_cones/walk_bits.glsl.
constexpr int kPadding = 64, kLevels = 7;

std::size_t product(const glm::ivec3& v) { return std::size_t(v.x) * std::size_t(v.y) * std::size_t(v.z); }

}  // namespace

WalkVolume::WalkVolume(gl::Shaders& shaders, WalkStorage storage)
    : storage_(std::move(storage)),
      mark_(shaders.load({"08_diffuse_cones/walk_mark.comp"})),
      double_(shaders.load({"08_diffuse_cones/walk_double.comp"})),
      leaps_(shaders, {"08_diffuse_cones/walk_leaps.comp"}),
      coverage_(shaders, {"08_diffuse_cones/walk_coverage.comp"})
{
}

void WalkVolume::bind() const
{
    cells_.words.bind(GLuint(shared::kWalkVolumeUnit));
    for (const auto& [unit, texture] : cells_.index) texture->bind(unit);
}

bool WalkVolume::run(const VoxelGrid& grid, const VoxelFaces& faces, int stored)
{
    if (!made_from_.differs(faces.revision(), stored)) return false;
    ++revision_;
    const glm::ivec3 size = grid.size() + 1;
    const glm::ivec3 rows((size.x + kPadding + 31) / 32, size.y + kPadding, size.z + kPadding);
    const gl::Buffer bits("walk bits", kLevels * product(rows) * sizeof(GLuint));
    // No voxel has more than eight cells round its corners.
    const std::size_t most_cells = std::min(8 * faces.voxel_count(), product(size));
    const gl::Buffer cells("occupied cells", (1 + most_cells) * sizeof(GLuint));
    grid.bind();
    faces.bind();
    bits.bind(GL_SHADER_STORAGE_BUFFER, shared::kWalkBitBinding);
    cells.bind(GL_SHADER_STORAGE_BUFFER, shared::kWalkCellBinding);

    // A bit for every cell that holds something.
    mark_.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.voxel_groups().id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

    // Cubes of twice the side, six times.
    double_.use();
    for (int level = 0; level + 1 < kLevels; ++level) {
        double_.set("level", level);
        gl::dispatch_items(product(rows), 64);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }

    // Room for the cells.
    if (stored != 0) {
        storage_(cells_, grid);
    } else if (cells_.words.target() != GL_TEXTURE_3D || cells_.words.size() != size) {
        cells_ = {gl::texture_3d("walk volume", GL_R32UI, size), {}, {}};
    }
    bind();
    cells_.words.bind_image(0, 0, GL_WRITE_ONLY);

    // Empty cells: how far to leap. The others: a list.
    leaps_.with(cells_.defines).use();
    gl::dispatch_items(product({(size.x + 31) / 32, size.y, size.z}), 64);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);

    // Of each in the list, what it covers.
    occupied_cells_ = cells.read_at<GLuint>(0);
    coverage_.with(cells_.defines).use();
    gl::dispatch_items(occupied_cells_, 64);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    return true;
}

}  // namespace conebook
