// Tools that look into the tree: a cone shot from a pixel and the nodes that it samples, pictures that add up, a camera
// without perspective, lights that move.
#pragma once

#include "08_diffuse_cones/composite.hpp"
#include "17_sparse_voxel_octree/tree_view.hpp"

namespace conebook {

// What the view final adds up.
enum class UpTo : int { all = 0, direct = 1, diffuse = 2, specular = 3 };

struct TreeToolParams {
    // Pixel from which the test cone is shot, from the upper left, in shares of the picture's width and height, 0 .. 1.
    float pick_x = 0.5f, pick_y = 0.5f;
    float test_aperture = 30.0f;  // full, degrees, 0.1 .. 120
    UpTo up_to = UpTo::all;
    bool orthographic = false;
    float turn_lights = 0.0f;  // degrees round the vertical through the scene's middle, -360 .. 360
};
void add_parameters(ParameterTable& table, TreeToolParams& params);

LightParts parts_of(const std::string& view, UpTo up_to);
// `camera` without perspective: as large as what it sees at the distance of the scene's middle.
Camera without_perspective(const Camera& camera, const Bounds& bounds, glm::ivec2 size);
std::vector<Light> turned_lights(std::vector<Light> lights, const Bounds& bounds, float degrees);

class TestCone {
public:
    explicit TestCone(gl::Shaders& shaders);

    // `picture` with the outlines of the nodes that a cone from the picked pixel samples, from red to blue as it
    // comes to them; RGBA32F, valid until the next call.
    const gl::Texture& run(const gl::Texture& picture, const GBuffer& g_buffer, const TreeLight& light,
                           const ConeParams& cones, const TreeToolParams& params);
    // Numbers of the nodes, in the order of the cone; at most shared::kMaxSampledNodes.
    const std::vector<GLuint>& nodes() const { return nodes_; }

private:
    gl::Program trace_, outlines_;
    gl::Buffer sampled_;
    std::vector<GLuint> nodes_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

std::string description(const std::vector<GLuint>& sampled, const Octree& tree);

// Level and place of a node, as a box in voxels: xyz corner, w side.
glm::vec4 box_of(const Octree& tree, GLuint node, GLuint place);

}  // namespace conebook
