#include "17_sparse_voxel_octree/octree.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <stdexcept>

namespace conebook {

void add_parameters(ParameterTable& table, OctreeParams& params)
{
    table.add_values("neighbours", params.neighbours, {6, 26}, "of a node with geometry that become border nodes");
    table.add("border_nodes", params.border_nodes, "empty nodes next to geometry, where light fades out");
}

Octree::Octree(gl::Shaders& shaders)
{
    const auto load = [&](const char* file, const gl::Defines& defines = {}) {
        return shaders.load({std::string("17_sparse_voxel_octree/") + file}, defines);
    };
    flag_ = load("flag.comp");
    count_children_ = load("count.comp", {{"BRICKS", "0"}});
    count_bricks_ = load("count.comp", {{"BRICKS", "1"}});
    scan_geometry_ = load("scan.comp", {{"COUNTED", "0"}});
    scan_empty_ = load("scan.comp", {{"COUNTED", "1"}});
    scan_bricks_ = load("scan.comp", {{"COUNTED", "2"}});
    allocate_geometry_ = load("allocate.comp", {{"EMPTY", "0"}});
    allocate_empty_ = load("allocate.comp", {{"EMPTY", "1"}});
    border_ = load("border.comp");
    dilate_ = load("dilate.comp");
    place_bricks_ = load("place_bricks.comp");
    list_bricks_ = load("list_bricks.comp");
    list_faces_ = load("list_faces.comp");
}

namespace {

void wait_for_writes() { glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT); }

std::size_t level_offset(int level)
{
    return offsetof(shared::OctreeState, levels) + std::size_t(level) * sizeof(shared::TreeLevel);
}

// One thread for each block of nodes of a level, or for each of its nodes with geometry.
void dispatch_blocks(const gl::Program& program, int level)
{
    program.set("level", level);
    program.use();
    glDispatchComputeIndirect(GLintptr(level_offset(level) + offsetof(shared::TreeLevel, block_groups)));
    wait_for_writes();
}
void dispatch_geometry(const gl::Program& program, int level, int level_uniform)
{
    program.set("level", level_uniform);
    program.use();
    glDispatchComputeIndirect(GLintptr(level_offset(level) + offsetof(shared::TreeLevel, geometry_groups)));
    wait_for_writes();
}
void scan(const gl::Program& program, int level)
{
    program.set("level", level);
    program.use();
    glDispatchCompute(1, 1, 1);
    wait_for_writes();
}

// The first `count` items of a buffer, in one of their own.
gl::Buffer cut_to(const gl::Buffer& buffer, const std::string& label, std::size_t bytes)
{
    gl::Buffer result(label, bytes);
    if (bytes > 0) glCopyNamedBufferSubData(buffer.id(), result.id(), 0, 0, GLsizeiptr(bytes));
    return result;
}

}  // namespace

void Octree::make_children(int level, bool empty)
{
    dispatch_blocks(count_children_, level);
    scan(empty ? scan_empty_ : scan_geometry_, level);
    dispatch_blocks(empty ? allocate_empty_ : allocate_geometry_, level);
}

void Octree::grow(const VoxelGrid& grid, const VoxelFaces& faces, const OctreeParams& params, GLuint capacity)
{
    nodes_ = gl::Buffer("nodes", capacity * 8 * sizeof(GLuint));
    places_ = gl::Buffer("node places", capacity * sizeof(GLuint));
    bricks_ = gl::Buffer("node bricks", capacity * sizeof(GLuint));
    const gl::Buffer blocks("node blocks", (capacity / shared::kNodesPerBlock + 1) * sizeof(GLuint));
    const gl::Buffer voxel_nodes("nodes of voxels", std::max<std::size_t>(faces.voxel_count(), 1) * sizeof(GLuint));
    shared::OctreeState start{};
    start.nodes = start.wanted = 1;
    start.capacity = capacity;
    start.levels[0] = {0, 1, 1, 0, {1, 1, 1, 0}, {1, 1, 1, 0}};
    state_ = gl::Buffer("octree state", sizeof start, &start);

    grid.bind();
    faces.bind();
    state_.bind(GL_SHADER_STORAGE_BUFFER, shared::kTreeStateBinding);
    places_.bind(GL_SHADER_STORAGE_BUFFER, shared::kNodePlaceBinding);
    nodes_.bind(GL_SHADER_STORAGE_BUFFER, shared::kNodeBinding);
    bricks_.bind(GL_SHADER_STORAGE_BUFFER, shared::kNodeBrickBinding);
    for (const gl::Program* program : {&flag_, &border_, &dilate_}) program->set("tree_depth", depth_);
    border_.set("neighbours", params.border_nodes ? params.neighbours : 0);

    // From the root down: children with geometry, then the empty ones round them.
    for (int level = 0; level < depth_; ++level) {
        voxel_nodes.bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelNodeBinding);
        flag_.set("level", level);
        flag_.use();
        gl::dispatch_items(faces.voxel_count(), 64);
        wait_for_writes();
        if (level + 1 == depth_) break;
        blocks.bind(GL_SHADER_STORAGE_BUFFER, shared::kTreeBlockBinding);
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, state_.id());
        make_children(level, false);
        dispatch_geometry(border_, level + 1, level);
        make_children(level, true);
    }

    // Which directions every node has, and the numbers of its bricks.
    blocks.bind(GL_SHADER_STORAGE_BUFFER, shared::kTreeBlockBinding);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, state_.id());
    for (int level = 0; level < depth_; ++level) {
        dispatch_geometry(dilate_, level, level);
        dispatch_blocks(count_bricks_, level);
        scan(scan_bricks_, level);
        dispatch_blocks(place_bricks_, level);
    }
    counts_ = state_.read_at<shared::OctreeState>(0);
}

bool Octree::build(const VoxelGrid& grid, const VoxelFaces& faces, const OctreeParams& params)
{
    if (!made_from_.differs(grid.revision(), faces.revision(), params)) return false;
    ++revision_;
    const glm::ivec3 size = grid.size();
    const auto side = unsigned(std::max({size.x, size.y, size.z, 4}));
    depth_ = int(std::bit_width(side - 1));
    // A flat wall has a leaf with geometry for every four voxels, and three times that with its border; all levels
    // together are 4/3 of the leaves, so about a node a voxel. Scattered voxels have up to 27.
    constexpr std::size_t kLeast = 4096, kMostIndex = 1u << 26;
    const std::size_t most = std::min(gl::most_storage_bytes() / (8 * sizeof(GLuint)), kMostIndex - 1);
    std::size_t capacity = std::min(kLeast + 2 * faces.voxel_count(), most);
    for (;;) {
        grow(grid, faces, params, GLuint(capacity));
        if (counts_.wanted <= counts_.capacity) break;
        if (capacity == most)
            throw std::runtime_error("the octree has more than " + std::to_string(most) +
                                     " nodes, the most that a storage block holds; use a smaller --set voxels=");
        capacity = std::min(std::max<std::size_t>(2 * capacity, counts_.wanted), most);
    }
    if (counts_.bricks >= (1u << 26))
        throw std::runtime_error("the octree has more than 2^26 bricks; use a smaller --set voxels=");

    // What is not needed goes.
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    nodes_ = cut_to(nodes_, "nodes", counts_.nodes * 8 * sizeof(GLuint));
    places_ = cut_to(places_, "node places", counts_.nodes * sizeof(GLuint));
    bricks_ = cut_to(bricks_, "node bricks", counts_.nodes * sizeof(GLuint));

    // From a brick the way back to its node.
    brick_list_ = gl::Buffer("brick list", counts_.bricks * sizeof(GLuint));
    bind(list_bricks_);
    state_.bind(GL_SHADER_STORAGE_BUFFER, shared::kTreeStateBinding);
    brick_list_.bind(GL_SHADER_STORAGE_BUFFER, shared::kBrickListBinding);
    list_bricks_.use();
    gl::dispatch_items(counts_.nodes, 64);

    // From a leaf's voxels to their faces.
    const shared::TreeLevel& leaves = level(depth_ - 1);
    const GLuint leaf_count = leaves.geometry_end - leaves.begin;
    leaf_faces_ = gl::Buffer("faces of leaves", leaf_count * 8 * sizeof(GLuint));
    places_.bind(GL_SHADER_STORAGE_BUFFER, shared::kNodePlaceBinding);
    faces.face_index().bind(shared::kFaceIndexUnit);
    bind_leaf_faces(list_faces_);
    list_faces_.use();
    gl::dispatch_items(leaf_count, 64);
    wait_for_writes();
    return true;
}

void Octree::bind_leaf_faces(const gl::Program& program) const
{
    leaf_faces_.bind(GL_SHADER_STORAGE_BUFFER, shared::kLeafFaceBinding);
    program.set("leaf_begin", level(depth_ - 1).begin);
    program.set("leaf_end", level(depth_ - 1).geometry_end);
}

void Octree::bind(const gl::Program& program) const
{
    nodes_.bind(GL_SHADER_STORAGE_BUFFER, shared::kNodeBinding);
    bricks_.bind(GL_SHADER_STORAGE_BUFFER, shared::kNodeBrickBinding);
    program.set("tree_depth", depth_);
}

std::vector<gl::Resource> Octree::resources() const
{
    return {nodes_.resource(), places_.resource(), bricks_.resource(), brick_list_.resource(), leaf_faces_.resource()};
}

}  // namespace conebook
