#include "17_sparse_voxel_octree/brick_pool.hpp"

#include <algorithm>
#include <stdexcept>

namespace conebook {

void add_parameters(ParameterTable& table, BrickParams& params)
{
    table.add("transfer", params.transfer, {"sum", "average"}, "what bricks do with samples that they share");
    table.add("brick_format", params.brick_format, {"rgba16f", "rgba32f"}, "of the bricks' texels");
}

std::vector<float> bound_weights(const shared::GridData& grid, int depth)
{
    const int side = 1 << depth, stride = side + 1;
    std::vector<float> weights(std::size_t(depth + 1) * 3 * std::size_t(stride), 0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        const auto row = [&](int sampled) { return &weights[std::size_t(((sampled + 1) * 3 + axis) * stride)]; };
        for (int i = 0; i < side; ++i) {
            const float inside =
                std::min(float(i + 1), grid.content_max[axis]) - std::max(float(i), grid.content_min[axis]);
            row(-1)[i] = std::clamp(inside, 0.0f, 1.0f);
        }
        // Spread: half of each of the two voxels. Filter: a quarter, a half, a quarter. Beyond the root there is
        // nothing.
        for (int i = 0; i <= side; ++i)
            row(0)[i] = 0.5f * ((i > 0 ? row(-1)[i - 1] : 0.0f) + (i < side ? row(-1)[i] : 0.0f));
        for (int sampled = 1; sampled < depth; ++sampled) {
            const int count = side >> sampled;
            const float* old = row(sampled - 1);
            for (int i = 0; i <= count; ++i)
                row(sampled)[i] =
                    0.5f * old[2 * i] + 0.25f * ((i > 0 ? old[2 * i - 1] : 0.0f) + (i < count ? old[2 * i + 1] : 0.0f));
        }
    }
    return weights;
}

BrickPool::BrickPool(gl::Shaders& shaders)
    : spread_(shaders, {"17_sparse_voxel_octree/spread.comp"}),
      transfer_(shaders, {"17_sparse_voxel_octree/transfer.comp"}),
      filter_(shaders, {"17_sparse_voxel_octree/filter.comp"}),
      unit_(shaders.load({"07_anisotropic_mips/light_unit.comp"}, {{"FORMAT", "0"}})),
      scale_("light scale", std::vector{glm::vec4(1.0f)})
{
}

void BrickPool::allocate(const VoxelGrid& grid, const Octree& tree, BrickFormat format)
{
    if (!allocated_for_.differs(tree.revision(), format)) return;
    GLint most = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
    constexpr std::size_t kInLayer = std::size_t(shared::kBrickRow) * shared::kBrickRow;
    const std::size_t bricks = tree.counts().bricks,
                      layers = std::max<std::size_t>((bricks + kInLayer - 1) / kInLayer, 1);
    if (3 * layers > std::size_t(most))
        throw std::runtime_error(std::to_string(bricks) + " bricks of the octree do not fit into a 3D texture of " +
                                 std::to_string(most) +
                                 " texels a side (GL_MAX_3D_TEXTURE_SIZE); use a smaller --set voxels=");
    const auto rows =
        int(std::clamp<std::size_t>((bricks + shared::kBrickRow - 1) / shared::kBrickRow, 1, shared::kBrickRow));
    const glm::ivec3 size = 3 * glm::ivec3(shared::kBrickRow, rows, int(layers));
    const GLenum texels = format == BrickFormat::rgba16f ? GL_RGBA16F : GL_RGBA32F;
    if (!pool_ || pool_.size() != size || pool_.format() != texels) {
        pool_ = {};
        pool_ = gl::texture_3d("brick pool", texels, size);
        pool_.set_filter(GL_LINEAR, GL_LINEAR);
        pool_.clear();  // a look-up may touch what lies beside the last brick, with a weight of 0
    }
    weights_ = gl::Buffer("weights within the bounds", bound_weights(grid.data(), tree.depth()));
}

void BrickPool::dispatch(const gl::Program& program, const Octree& tree, int level)
{
    const GLuint first = tree.level(level).bricks, count = tree.bricks_end(level) - first;
    program.set("level", level);
    program.set("first_brick", first);
    program.set("brick_count", count);
    program.use();
    gl::dispatch_items(count, 64);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

bool BrickPool::fill(const VoxelGrid& grid, const VoxelFaces& faces, const Octree& tree, const gl::Buffer& reflected,
                     Revision reflected_revision, const BrickParams& params)
{
    if (!made_from_.differs(tree.revision(), reflected.id(), reflected_revision, params)) return false;
    ++revision_;
    allocate(grid, tree, params.brick_format);
    const std::string format = std::to_string(int(params.brick_format));
    const gl::Program& spread = spread_.with({{"FORMAT", format}});
    const gl::Program& filter = filter_.with({{"FORMAT", format}});
    const gl::Program& transfer =
        transfer_.with({{"FORMAT", format}, {"AVERAGE", std::to_string(int(params.transfer))}});
    grid.bind();
    faces.bind();
    reflected.bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);

    // The unit that radiance is kept in, by chapter 07.
    const glm::vec4 one(1.0f);
    scale_.write(0, sizeof one, &one);
    unit_.set("part", glm::vec2(1.0f));
    scale_.bind(GL_SHADER_STORAGE_BUFFER, shared::kLightScaleBinding);
    unit_.use();
    gl::dispatch_items(faces.face_count(), 64);
    glMemoryBarrier(GL_UNIFORM_BARRIER_BIT);

    for (const gl::Program* program : {&spread, &filter, &transfer}) tree.bind(*program);
    tree.bind_leaf_faces(spread);
    scale_.bind(GL_UNIFORM_BUFFER, shared::kPyramidBlock);
    weights_.bind(GL_SHADER_STORAGE_BUFFER, shared::kTreeWeightBinding);
    tree.places().bind(GL_SHADER_STORAGE_BUFFER, shared::kNodePlaceBinding);
    tree.brick_list().bind(GL_SHADER_STORAGE_BUFFER, shared::kBrickListBinding);
    pool_.bind_image(0, 0, GL_READ_WRITE);

    // From the leaves up: own samples, then what neighbours have of them.
    for (int level = tree.depth() - 1; level >= 0; --level) {
        const bool is_leaf = level == tree.depth() - 1;
        spread.set("part", glm::vec2(1.0f));
        dispatch(is_leaf ? spread : filter, tree, level);
        transfer.set("is_leaf", is_leaf);
        for (int axis = 0; axis < 3; ++axis) {
            transfer.set("axis", axis);
            dispatch(transfer, tree, level);
        }
    }
    return true;
}

void BrickPool::bind(const Octree& tree, const gl::Program& program) const
{
    tree.bind(program);
    pool_.bind(GLuint(shared::kBrickPoolUnit));
    scale_.bind(GL_UNIFORM_BUFFER, shared::kPyramidBlock);
}

double BrickPool::light_unit() const { return double(scale_.read_at<float>(0)); }

}  // namespace conebook
