#include "17_sparse_voxel_octree/tree_tools.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, TreeToolParams& params)
{
    table.add("pick_x", params.pick_x, 0.0, 1.0, "", "view test_cone: share of the picture's width, from the left");
    table.add("pick_y", params.pick_y, 0.0, 1.0, "", "view test_cone: share of the picture's height, from the top");
    table.add("test_aperture", params.test_aperture, 0.1, 120.0, "deg", "view test_cone: full aperture of the cone");
    table.add("up_to", params.up_to, {"all", "direct", "diffuse", "specular"},
              "view final: add up direct light, then diffuse, then specular, then emission");
    table.add("orthographic", params.orthographic, "a camera without perspective");
    table.add("turn_lights", params.turn_lights, -360.0, 360.0, "deg", "turn the lights round the scene's middle");
}

LightParts parts_of(const std::string& view, UpTo up_to)
{
    LightParts parts = parts_of_view(view);
    if ((view != "final" && view != "test_cone") || up_to == UpTo::all) return parts;
    return {1.0f, up_to >= UpTo::diffuse ? 1.0f : 0.0f, up_to >= UpTo::specular ? 1.0f : 0.0f, 0.0f, false};
}

Camera without_perspective(const Camera& camera, const Bounds& bounds, glm::ivec2 size)
{
    if (camera.orthographic) return camera;
    Camera result = camera;
    const glm::vec3 eye(camera.world_from_camera[3]), forward(-camera.world_from_camera[2]);
    const float distance = std::max(glm::dot(bounds.center() - eye, forward), 0.1f * bounds.longest_side());
    result.orthographic = true;
    result.y_mag = distance * std::tan(0.5f * camera.y_fov);
    result.x_mag = result.y_mag * float(size.x) / float(size.y);
    return result;
}

std::vector<Light> turned_lights(std::vector<Light> lights, const Bounds& bounds, float degrees)
{
    const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), glm::radians(degrees), glm::vec3(0.0f, 1.0f, 0.0f));
    for (Light& light : lights) {
        light.position = bounds.center() + glm::vec3(turn * glm::vec4(light.position - bounds.center(), 0.0f));
        light.direction = glm::vec3(turn * glm::vec4(light.direction, 0.0f));
    }
    return lights;
}

glm::vec4 box_of(const Octree& tree, GLuint node, GLuint place)
{
    int level = 0;
    while (level + 1 < tree.depth() && tree.level(level).end <= node) ++level;
    const auto side = float(1 << (tree.depth() - level));
    return {side * glm::vec3(place & 1023u, place >> 10 & 1023u, place >> 20 & 1023u), side};
}

std::string description(const std::vector<GLuint>& sampled, const Octree& tree)
{
    std::string text = "test cone samples ";
    text += std::to_string(sampled.size());
    text += " nodes:";
    for (const GLuint node : sampled) {
        int level = 0;
        while (level + 1 < tree.depth() && tree.level(level).end <= node) ++level;
        for (const std::string& part :
             {std::string(" "), std::to_string(node), std::string(" (level "), std::to_string(level), std::string(")")})
            text += part;
    }
    return text;
}

TestCone::TestCone(gl::Shaders& shaders)
    : trace_(shaders.load({"17_sparse_voxel_octree/test_cone.comp"})),
      outlines_(shaders.load({"common/fullscreen.vert", "17_sparse_voxel_octree/outlines.frag"})),
      sampled_("nodes of the test cone", (1 + shared::kMaxSampledNodes) * sizeof(GLuint))
{
}

const gl::Texture& TestCone::run(const gl::Texture& picture, const GBuffer& g_buffer, const TreeLight& light,
                                 const ConeParams& cones, const TreeToolParams& params)
{
    // Which nodes.
    const glm::ivec2 size = g_buffer.size();
    const glm::vec2 place(params.pick_x, 1.0f - params.pick_y);
    g_buffer.bind();
    light.bind(trace_);
    set_cones(trace_, cones);
    trace_.set("pixel", glm::clamp(glm::ivec2(place * glm::vec2(size)), glm::ivec2(0), size - 1));
    trace_.set("tan_half_aperture", std::tan(glm::radians(0.5f * params.test_aperture)));
    trace_.set("start_offset", cones.start_offset);
    sampled_.bind(GL_SHADER_STORAGE_BUFFER, shared::kTreeChangeBinding);
    trace_.use();
    glDispatchCompute(1, 1, 1);
    nodes_ = sampled_.read<GLuint>();
    const GLuint count = std::min(nodes_[0], GLuint(shared::kMaxSampledNodes));
    nodes_ = std::vector<GLuint>(nodes_.begin() + 1, nodes_.begin() + 1 + std::ptrdiff_t(count));

    // Their outlines.
    std::vector<glm::vec4> boxes;
    for (const GLuint node : nodes_)
        boxes.push_back(box_of(light.tree(), node, light.tree().places().read_at<GLuint>(node * sizeof(GLuint))));
    const gl::Buffer box_buffer("outlined nodes", boxes);
    gl::fit_to_pixels(color_, framebuffer_, "outlines", GL_RGBA32F, size);
    box_buffer.bind(GL_SHADER_STORAGE_BUFFER, shared::kTreeChangeBinding);
    picture.bind(16);
    outlines_.set("box_count", int(boxes.size()));
    gl::draw_pixels(outlines_, framebuffer_, no_vertices_, size);
    return color_;
}

}  // namespace conebook
