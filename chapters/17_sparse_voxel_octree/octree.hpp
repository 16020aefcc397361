// A sparse voxel octree, built level by level on the GPU from the list of occupied voxels.
#pragma once

#include "05_atomic_averaging/voxel_faces.hpp"
#include "17_sparse_voxel_octree/octree_structs.glsl"

namespace conebook {

struct OctreeParams {
    // Which neighbours of a node with geometry become border nodes: 26, or the 6 at its sides, or none. Fewer than
    // 26, for comparison, leave samples that bricks do not agree on, and light that is cut off.
    int neighbours = 26;
    bool border_nodes = true;
    bool operator==(const OctreeParams&) const = default;
};
void add_parameters(ParameterTable& table, OctreeParams& params);

// Levels 0 (the root, 2^depth voxels wide, the least that holds the grid) to depth - 1 (leaves of 2^3 voxels). See
// shaders/17_sparse_voxel_octree/octree.glsl for the nodes and bricks.glsl for what they hold.
class Octree {
public:
    explicit Octree(gl::Shaders& shaders);

    // Makes the tree if the faces or a parameter have changed, and says whether it did. Reads the counts of nodes and
    // bricks back once, and builds again in the rare case that there were more nodes than room. Throws
    // std::runtime_error when there are more than a storage block or an index holds.
    bool build(const VoxelGrid& grid, const VoxelFaces& faces, const OctreeParams& params);
    void forget() { made_from_.forget(); }  // the next call builds whatever has changed, for measuring
    Revision revision() const { return revision_; }

    int depth() const { return depth_; }
    const shared::OctreeState& counts() const { return counts_; }
    const shared::TreeLevel& level(int i) const { return counts_.levels[i]; }
    // First brick behind the level's.
    GLuint bricks_end(int level) const
    {
        return level + 1 < depth_ ? counts_.levels[level + 1].bricks : counts_.bricks;
    }

    const gl::Buffer& nodes() const { return nodes_; }            // 8 uints a node: see octree.glsl
    const gl::Buffer& places() const { return places_; }          // uint a node: place in its level, 10 bits an axis
    const gl::Buffer& node_bricks() const { return bricks_; }     // uint a node: first brick << 6 | directions
    const gl::Buffer& brick_list() const { return brick_list_; }  // uint a brick: node << 3 | direction
    const gl::Buffer& leaf_faces() const { return leaf_faces_; }  // 8 uints a leaf with geometry: see leaf_faces.glsl
    std::vector<gl::Resource> resources() const;

    // kNodeBinding, kNodeBrickBinding, and uniform tree_depth of `program`.
    void bind(const gl::Program& program) const;
    // kLeafFaceBinding and uniforms of leaf_faces.glsl.
    void bind_leaf_faces(const gl::Program& program) const;

private:
    void grow(const VoxelGrid& grid, const VoxelFaces& faces, const OctreeParams& params, GLuint capacity);
    void make_children(int level, bool empty);
    gl::Program flag_, count_children_, count_bricks_, scan_geometry_, scan_empty_, scan_bricks_, allocate_geometry_,
        allocate_empty_, border_, dilate_, place_bricks_, list_bricks_, list_faces_;
    gl::Buffer nodes_, places_, bricks_, brick_list_, leaf_faces_, state_;
    shared::OctreeState counts_{};
    int depth_ = 2;
    MadeFrom<Revision, Revision, OctreeParams> made_from_;  // grid, faces
    Revision revision_ = 0;
};

}  // namespace conebook
