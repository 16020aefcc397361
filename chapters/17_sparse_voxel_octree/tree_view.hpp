// The octree as it is: nodes of a level, samples of their bricks, one node and its neighbours.
#pragma once

#include <array>
#include <string>

#include "17_sparse_voxel_octree/tree_light.hpp"
#include "app/options.hpp"

namespace conebook {

enum class BrickQuantity : int { light = 0, coverage = 1 };

struct TreeViewParams {
    int level = -1;                                       // of views nodes and bricks, 0 = root; -1: leaves
    int node = -1;                                        // number of a node to highlight, -1: none
    int node_x = -1, node_y = -1, node_z = -1;            // the node of `level` that holds this voxel instead, -1: none
    bool show_neighbours = false;                         // highlight the node's neighbours too
    bool only_selected = false;                           // show nothing else
    PyramidSide direction = PyramidSide::seen;            // of bricks: -x +x -y +y -z +z, or the side that is seen
    int brick_layer = -1;                                 // of bricks: 0 .. 2 along the direction's axis, -1: all
    BrickQuantity brick_quantity = BrickQuantity::light;  // of bricks: light, coverage
};
void add_parameters(ParameterTable& table, TreeViewParams& params);

// final and its parts, voxels, photons, nodes, bricks.
std::vector<View> tree_views();
// How the view becomes a .png: coverage is no radiance.
Encoding encoding_of(const View& view, const TreeViewParams& params);

// A node and what is round it, read back from the GPU.
struct NodeReport {
    int node = -1, level = 0;  // node -1: there is none
    glm::ivec3 place{0};       // in nodes of the level
    bool has_geometry = false;
    GLuint directions = 0;  // bit d: it has a brick of direction d
    GLuint first_brick = 0;
    std::array<GLuint, 8> children{};  // x + 2 y + 4 z; 0: none
    std::vector<int> neighbours;       // those of 26 that there are
};
bool is_chosen(const TreeViewParams& params);
// The node that `params` chooses.
NodeReport find_node(const Octree& tree, const TreeViewParams& params);
std::string description(const NodeReport& node);

class TreeViewPass {
public:
    explicit TreeViewPass(gl::Shaders& shaders);
    // RGBA32F of views voxels, photons, nodes and bricks, alpha 0 where nothing is met; null for other views. Valid
    // until the next call.
    const gl::Texture* run(const TreeLight& light, const std::string& view, const TreeViewParams& params,
                           const shared::CameraData& camera, glm::ivec2 size);

private:
    gl::ProgramVariants program_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
