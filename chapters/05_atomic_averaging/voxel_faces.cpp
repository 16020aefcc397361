#include "05_atomic_averaging/voxel_faces.hpp"

#include <stdexcept>

#include "gl/pixel_pass.hpp"

namespace conebook {

namespace {

constexpr int kBlock = 4;  // voxels along a side of the blocks that the list is made from

glm::ivec3 blocks_of(const VoxelGrid& grid) { return (grid.size() + kBlock - 1) / kBlock; }

// Buffers only grow, so that a changing scene does not allocate every frame.
void grow(gl::Buffer& buffer, const std::string& label, std::size_t bytes)
{
    if (!buffer || buffer.bytes() < bytes) buffer = gl::Buffer(label, bytes);
}

gl::Defines voxel_material_defines(const Material& m, bool has_vertex_alpha)
{
    const auto flag = [](bool on) { return on ? std::string("1") : std::string("0"); };
    return {{"BASE_COLOR_TEXTURE", flag(m.base_color_texture.present())},
            {"METALLIC_ROUGHNESS_TEXTURE", flag(m.metallic_roughness_texture.present())},
            {"EMISSION_TEXTURE", flag(m.emission_texture.present())},
            {"SPECULAR_TEXTURE", flag(m.specular_texture.present())},
            {"SPECULAR_COLOR_TEXTURE", flag(m.specular_color_texture.present())},
            {"COVERAGE_TEXTURE", flag(m.alpha_mode == AlphaMode::mask && m.base_color_texture.present())},
            {"VERTEX_ALPHA", flag(m.alpha_mode == AlphaMode::mask && has_vertex_alpha)},
            {"EMISSION", flag(m.shines())}};
}

}  // namespace

std::vector<Need> voxel_material_needs(const GpuScene& scene)
{
    const bool textures = scene.has_textures(), emission = scene.has_emission();
    return {{"textures in voxels", textures, textures ? "materials have them" : "no material has any"},
            {"normal maps in voxels", false, "their details are smaller than voxels"},
            {"emission in voxels", emission, emission ? "materials shine" : "no material shines: no sums for it"}};
}

const gl::Program& FragmentPrograms::of(const GpuScene& scene, std::size_t material, const gl::Defines& more)
{
    const bool vertex_alpha = scene.material_uses()[material].vertex_alpha;
    gl::Defines defines = voxel_material_defines(scene.materials()[material], vertex_alpha);
    defines.insert(more.begin(), more.end());
    gl::Program& program = programs_[defines];
    if (program.id() == 0) program = shaders_->load({file_}, defines);
    return program;
}

void FragmentPrograms::run(const GpuScene& scene, const VoxelGrid& grid, const FragmentList& fragments,
                           const gl::Defines& more, GLuint first_face)
{
    grid.bind();
    scene.bind_triangles();
    fragments.buffer().bind(GL_SHADER_STORAGE_BUFFER, shared::kFragmentBinding);
    scene.for_each_material([&](std::size_t i) {
        const shared::FragmentRange& range = fragments.ranges()[i];
        if (range.count == 0) return;
        const gl::Program& program = of(scene, i, more);
        program.use();
        program.set("first_face", first_face);
        program.set("first_fragment", range.begin);
        program.set("fragment_count", range.count);
        gl::dispatch_items(range.count, 64);
    });
}

void FaceLists::count_groups()
{
    const auto dispatch_of = [](const char* label, std::size_t items) {
        return gl::Buffer(label, std::vector{gl::group_counts(items, 64)});
    };
    face_groups = dispatch_of("face dispatch", counted.faces);
    voxel_groups = dispatch_of("voxel dispatch", counted.voxels);
}

VoxelFaces::VoxelFaces(gl::Shaders& shaders, const ConservativeVoxelizer& voxelizer)
    : count_blocks_(shaders.load({"05_atomic_averaging/count_blocks.comp"})),
      scan_blocks_(shaders.load({"05_atomic_averaging/scan_blocks.comp"})),
      write_list_(shaders.load({"05_atomic_averaging/write_list.comp"})),
      resolve_(shaders.load({"05_atomic_averaging/resolve.comp"})),
      accumulate_(shaders, "05_atomic_averaging/accumulate.comp"),
      statistics_(&voxelizer.statistics_buffer())
{
}

void VoxelFaces::allocate(const VoxelGrid& grid)
{
    if (lists_.face_index && lists_.face_index.size() == grid.size()) return;
    lists_.face_index = gl::texture_3d("face index", GL_R32UI, grid.size());
    const glm::ivec3 blocks = blocks_of(grid);
    block_counts_ = gl::Buffer("block counts", std::size_t(blocks.x) * std::size_t(blocks.y) * std::size_t(blocks.z) *
                                                   4 * sizeof(GLuint));
}

void VoxelFaces::make_lists(const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer)
{
    const glm::ivec3 blocks = blocks_of(grid);
    const std::size_t block_count = std::size_t(blocks.x) * std::size_t(blocks.y) * std::size_t(blocks.z);
    grid.bind();
    voxelizer.occupancy().bind(shared::kOccupancyUnit);
    statistics_->bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelCounterBinding);
    block_counts_.bind(GL_SHADER_STORAGE_BUFFER, shared::kBlockBinding);

    // Count, by blocks.
    count_blocks_.use();
    gl::dispatch_items(block_count, 64);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

    // Counts to places, and the totals.
    scan_blocks_.use();
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    lists_.counted = statistics_->read_at<shared::VoxelStatistics>(0);
    if (lists_.counted.faces >= (1u << 26))
        throw std::runtime_error("the voxels have more than 2^26 faces; use a smaller --set voxels=");
    gl::require_storage("faces of voxels, their sums", lists_.counted.faces, kBytesOfSums, "a smaller --set voxels=");

    // Write the lists.
    grow(lists_.voxel_list, "voxel list", lists_.counted.voxels * sizeof(GLuint));
    grow(lists_.face_list, "face list", lists_.counted.faces * sizeof(GLuint));
    lists_.count_groups();
    lists_.face_index.clear();
    lists_.face_index.bind_image(1, 0, GL_WRITE_ONLY);
    lists_.voxel_list.bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelListBinding);
    lists_.face_list.bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceListBinding);
    write_list_.use();
    gl::dispatch_items(block_count, 64);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                    GL_TEXTURE_FETCH_BARRIER_BIT);
}

bool VoxelFaces::run(const GpuScene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer)
{
    if (!made_from_.differs(voxelizer.revision())) return false;
    ++revision_;
    allocate(grid);
    make_lists(grid, voxelizer);
    lists_.kept = lists_.counted.faces;
    ++lists_.order;
    grow(lists_.sums, "face sums", lists_.counted.faces * kBytesOfSums);
    grow(lists_.faces, "faces", lists_.counted.faces * sizeof(shared::VoxelFace));
    lists_.sums.clear();
    add(scene, grid, voxelizer.fragments(), 0);
    divide(grid, 0, lists_.counted.faces);
    return true;
}

void VoxelFaces::add(const GpuScene& scene, const VoxelGrid& grid, const FragmentList& fragments, GLuint first_face)
{
    lists_.sums.bind(GL_SHADER_STORAGE_BUFFER, shared::kSumBinding);
    lists_.face_index.bind_image(0, 0, GL_READ_ONLY);
    accumulate_.run(scene, grid, fragments, {}, first_face);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void VoxelFaces::divide(const VoxelGrid& grid, GLuint first_face, GLuint count)
{
    grid.bind();
    bind();
    lists_.sums.bind(GL_SHADER_STORAGE_BUFFER, shared::kSumBinding);
    resolve_.set("first_face", first_face);
    resolve_.set("face_count", count);
    resolve_.use();
    gl::dispatch_items(count, 64);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void VoxelFaces::bind() const
{
    statistics_->bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelCounterBinding);
    lists_.voxel_list.bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelListBinding);
    lists_.face_list.bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceListBinding);
    lists_.faces.bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceBinding);
    lists_.face_index.bind(shared::kFaceIndexUnit);
}

std::vector<gl::Resource> VoxelFaces::resources() const
{
    return {lists_.face_index.resource(), lists_.voxel_list.resource(), lists_.face_list.resource(), lists_.sums.resource(),
            lists_.faces.resource(),      block_counts_.resource()};
}

FaceViewPass::FaceViewPass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "05_atomic_averaging/face_view.frag"}))
{
}

const gl::Texture& FaceViewPass::run(const VoxelGrid& grid, const gl::Texture& occupancy, const VoxelFaces& faces,
                                     const FaceQuantity& quantity, const gl::Buffer& camera, glm::ivec2 size)
{
    gl::fit_to_pixels(color_, framebuffer_, "face view", GL_RGBA32F, size);
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
