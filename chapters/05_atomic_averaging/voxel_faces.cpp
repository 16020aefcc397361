#include "05_atomic_averaging/voxel_faces.hpp"

#include <stdexcept>

#include "gl/pixel_pass.hpp"

namespace conebook {

namespace {

constexpr int kBlock = 4;  // voxels along a side of the blocks that the list is made from

glm::ivec3 blocks_of(const VoxelGrid& grid) { return (grid.size() + kBlock - 1) / kBlock; }

gl::Buffer dispatch_of(const std::string& label, std::size_t items)
{
    return gl::Buffer(label, std::vector<GLuint>{gl::group_count(items, 64), 1, 1});
}

// Enough for `count` items; buffers only grow, so that a changing scene does not allocate every frame.
void grow(gl::Buffer& buffer, const std::string& label, std::size_t bytes)
{
    if (!buffer || buffer.bytes() < bytes) buffer = gl::Buffer(label, bytes);
}

}  // namespace

gl::Defines column_defines(const GpuScene& scene)
{
    return {{"CONSERVATIVE", "1"}, {"ATTRIBUTES", "1"}, {"TEXTURES", scene.has_textures() ? "1" : "0"}};
}

std::vector<Need> voxel_material_needs(const GpuScene& scene)
{
    const bool textures = scene.has_textures(), emission = scene.has_emission();
    return {{"textures in voxels", textures, textures ? "materials have them" : "no material has any"},
            {"normal maps in voxels", false, "their details are smaller than voxels"},
            {"emission in voxels", emission, emission ? "materials shine" : "no material shines: no sums for it"}};
}

VoxelFaces::VoxelFaces(gl::Shaders& shaders, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer)
    : shaders_(&shaders),
      count_blocks_(shaders.load({"05_atomic_averaging/count_blocks.comp"})),
      scan_blocks_(shaders.load({"05_atomic_averaging/scan_blocks.comp"})),
      write_list_(shaders.load({"05_atomic_averaging/write_list.comp"})),
      resolve_(shaders.load({"05_atomic_averaging/resolve.comp"})),
      face_index_(gl::texture_3d("face index", GL_R32UI, grid.size())),
      statistics_(&voxelizer.statistics_buffer())
{
    const glm::ivec3 blocks = blocks_of(grid);
    block_counts_ = gl::Buffer("block counts", std::size_t(blocks.x) * std::size_t(blocks.y) * std::size_t(blocks.z) *
                                                   4 * sizeof(GLuint));
}

const gl::Program& VoxelFaces::accumulate_program(const GpuScene& scene, Voxelizer voxelizer)
{
    gl::Program& program = accumulate_[{scene.has_textures(), scene.has_emission()}];
    if (program.id() != 0) return program;
    gl::Defines defines = column_defines(scene);
    defines["EMISSION"] = scene.has_emission() ? "1" : "0";
    program = voxelizer == Voxelizer::raster
                  ? shaders_->load({"04_conservative_voxelization/conservative.vert",
                                    "04_conservative_voxelization/conservative.geom",
                                    "05_atomic_averaging/accumulate.frag"},
                                   defines)
                  : shaders_->load({"05_atomic_averaging/accumulate.comp"}, defines);
    return program;
}

void VoxelFaces::make_lists(const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer)
{
    const glm::ivec3 blocks = blocks_of(grid);
    const GLuint block_groups = gl::group_count(std::size_t(blocks.x) * std::size_t(blocks.y) * std::size_t(blocks.z), 64);
    grid.bind();
    voxelizer.occupancy().bind(shared::kOccupancyUnit);
    statistics_->bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelCounterBinding);
    block_counts_.bind(GL_SHADER_STORAGE_BUFFER, shared::kBlockBinding);

    // Count, by blocks.
    count_blocks_.use();
    glDispatchCompute(block_groups, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

    // Counts to places, and the totals.
    scan_blocks_.use();
    glDispatchCompute(1, 1, 1);
    counted_ = statistics_->read_at<shared::VoxelStatistics>(0);
    if (counted_.faces >= (1u << 26))
        throw std::runtime_error("the voxels have more than 2^26 faces; use a smaller --set voxels=");

    // Write the lists.
    grow(voxel_list_, "voxel list", counted_.voxels * sizeof(GLuint));
    grow(face_list_, "face list", counted_.faces * sizeof(GLuint));
    face_groups_ = dispatch_of("face dispatch", counted_.faces);
    voxel_groups_ = dispatch_of("voxel dispatch", counted_.voxels);
    face_index_.clear();
    face_index_.bind_image(1, 0, GL_WRITE_ONLY);
    voxel_list_.bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelListBinding);
    face_list_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceListBinding);
    write_list_.use();
    glDispatchCompute(block_groups, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                    GL_TEXTURE_FETCH_BARRIER_BIT);
}

bool VoxelFaces::run(const GpuScene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer)
{
    if (!made_from_.differs(voxelizer.revision())) return false;
    ++revision_;
    make_lists(grid, voxelizer);

    // Add up the fragments of every face.
    grow(sums_, "face sums", counted_.faces * 2 * shared::kSumCount * sizeof(GLuint));
    grow(faces_, "faces", counted_.faces * sizeof(shared::VoxelFace));
    sums_.clear();
    sums_.bind(GL_SHADER_STORAGE_BUFFER, shared::kSumBinding);
    face_index_.bind_image(0, 0, GL_READ_ONLY);
    for_each_column(accumulate_program(scene, voxelizer.voxelizer()), voxelizer.voxelizer(), scene, grid, voxelizer.column_plane());
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

    // Divide.
    bind();
    resolve_.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, face_groups_.id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return true;
}

void VoxelFaces::bind() const
{
    statistics_->bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelCounterBinding);
    voxel_list_.bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelListBinding);
    face_list_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceListBinding);
    faces_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceBinding);
    face_index_.bind(shared::kFaceIndexUnit);
}

std::vector<gl::Resource> VoxelFaces::resources() const
{
    return {face_index_.resource(), voxel_list_.resource(), face_list_.resource(), sums_.resource(),
            faces_.resource(),      block_counts_.resource()};
}

FaceViewPass::FaceViewPass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "05_atomic_averaging/face_view.frag"}))
{
}

const gl::Texture& FaceViewPass::run(const VoxelGrid& grid, const gl::Texture& occupancy, const VoxelFaces& faces,
                                     const FaceQuantity& quantity, const gl::Buffer& camera, glm::ivec2 size)
{
    gl::fit_to_pixels(color_, framebuffer_, "face view", GL_RGBA16F, size);
    grid.bind();
    camera.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    occupancy.bind(shared::kOccupancyUnit);
    faces.face_index().bind(shared::kFaceIndexUnit);
    if (quantity.packed != nullptr) quantity.packed->bind(shared::kPackedColorUnit);
    if (quantity.buffer != nullptr) quantity.buffer->bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceBinding);
    if (quantity.plus != nullptr) quantity.plus->bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);
    program_.set("stride", quantity.stride);
    program_.set("offset", quantity.offset);
    program_.set("show", quantity.show);
    program_.set("has_plus", quantity.plus != nullptr);
    program_.set("plus_stride", quantity.plus_stride);
    program_.set("plus_offset", quantity.plus_offset);
    program_.set("has_packed", quantity.packed != nullptr);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, size);
    return color_;
}

}  // namespace conebook
