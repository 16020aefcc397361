#include "17_sparse_voxel_octree/tree_view.hpp"

#include <algorithm>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, TreeViewParams& params)
{
    table.add("level", params.level, -1, shared::kMaxTreeLevels - 1, "", "of nodes and bricks, 0: root, -1: leaves");
    table.add("node", params.node, -1, (1 << 26) - 1, "", "number of a node to highlight, -1: none");
    for (const auto& [name, field] :
         {std::pair{"node_x", &params.node_x}, {"node_y", &params.node_y}, {"node_z", &params.node_z}})
        table.add(name, *field, -1, 1023, "voxels", "highlight the node of level= at this voxel; -1: none");
    table.add("show_neighbours", params.show_neighbours, "highlight the neighbours of the node too");
    table.add("only_selected", params.only_selected, "nodes, bricks: show what is highlighted alone");
    table.add("direction", params.direction, {"-x", "+x", "-y", "+y", "-z", "+z", "seen"},
              "direction that bricks show");
    table.add("brick_layer", params.brick_layer, -1, 2, "", "layer of the bricks along the direction's axis, -1: all");
    table.add("brick_quantity", params.brick_quantity, {"light", "coverage"}, "what bricks show");
}

std::vector<View> tree_views()
{
    return {{"final", Encoding::radiance, "all light"},
            {"direct", Encoding::radiance, "direct light alone"},
            {"indirect_diffuse", Encoding::radiance, "indirect light through the diffuse lobe"},
            {"indirect_specular", Encoding::radiance, "indirect light through the specular lobe"},
            {"ambient_occlusion", Encoding::data, "share of the hemisphere that is open"},
            {"voxels", Encoding::radiance, "radiance of the voxels after the last bounce"},
            {"photons", Encoding::radiance,
             "flux that the lights' views give to the voxels, over their side squared, W/m^2"},
            {"test_cone", Encoding::radiance, "all light, and the nodes that a cone from the picked pixel samples"},
            {"nodes", Encoding::color, "nodes of level=: with geometry as cubes, border nodes as wires"},
            {"bricks", Encoding::radiance, "samples of the bricks of level="}};
}

Encoding encoding_of(const View& view, const TreeViewParams& params)
{
    return view.name == "bricks" && params.brick_quantity == BrickQuantity::coverage ? Encoding::data : view.encoding;
}

namespace {

int shown_level(const Octree& tree, const TreeViewParams& params)
{
    return params.level < 0 ? tree.depth() - 1 : std::min(params.level, tree.depth() - 1);
}

// The node of `level` at a place, -1 where there is none.
int node_at(const std::vector<GLuint>& nodes, const glm::ivec3& place, int level)
{
    if (glm::any(glm::lessThan(place, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(place, glm::ivec3(1 << level))))
        return -1;
    GLuint node = 0;
    for (int shift = level - 1; shift >= 0; --shift) {
        const glm::ivec3 bit = (place >> shift) & 1;
        node = nodes[8 * node + GLuint(bit.x + 2 * bit.y + 4 * bit.z)];
        if (node == 0) return -1;
    }
    return int(node);
}

}  // namespace

namespace {

bool is_by_place(const TreeViewParams& params)
{
    return params.node_x >= 0 && params.node_y >= 0 && params.node_z >= 0;
}

}  // namespace

bool is_chosen(const TreeViewParams& params) { return params.node >= 0 || is_by_place(params); }

NodeReport find_node(const Octree& tree, const TreeViewParams& params)
{
    NodeReport report;
    if (!is_chosen(params)) return report;
    const glm::ivec3 voxel(params.node_x, params.node_y, params.node_z);
    const bool by_place = is_by_place(params);
    const std::vector<GLuint> nodes = tree.nodes().read<GLuint>();
    if (by_place) {
        report.level = shown_level(tree, params);
        report.node = node_at(nodes, voxel >> (tree.depth() - report.level), report.level);
    } else {
        report.node = params.node < int(tree.counts().nodes) ? params.node : -1;
    }
    if (report.node < 0) return report;
    const auto node = GLuint(report.node);
    while (tree.level(report.level).end <= node) ++report.level;
    while (tree.level(report.level).begin > node) --report.level;
    const GLuint place = tree.places().read_at<GLuint>(node * sizeof(GLuint));
    const GLuint bricks = tree.node_bricks().read_at<GLuint>(node * sizeof(GLuint));
    report.place = glm::ivec3(place & 1023u, place >> 10 & 1023u, place >> 20 & 1023u);
    report.has_geometry = node < tree.level(report.level).geometry_end;
    report.directions = bricks & 63u;
    report.first_brick = bricks >> 6;
    std::copy_n(nodes.begin() + std::ptrdiff_t(8 * node), 8, report.children.begin());
    for (int i = 0; i < 27; ++i) {
        const int other =
            i == 13 ? -1 : node_at(nodes, report.place + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1, report.level);
        if (other >= 0) report.neighbours.push_back(other);
    }
    return report;
}

std::string description(const NodeReport& node)
{
    if (node.node < 0) return "no such node";
    std::string text = "node";
    const auto add_number = [&](auto value) {
        text += ' ';
        text += std::to_string(value);
    };
    add_number(node.node);
    text += " of level";
    add_number(node.level);
    text += " at";
    for (int axis = 0; axis < 3; ++axis) add_number(node.place[axis]);
    if (!node.has_geometry) text += ", border";
    text += ", children";
    for (const GLuint child : node.children) add_number(child);
    text += ", bricks";
    GLuint brick = node.first_brick;
    constexpr const char* kNames[] = {" -x", " +x", " -y", " +y", " -z", " +z"};
    for (int d = 0; d < 6; ++d) {
        if ((node.directions >> d & 1u) == 0) continue;
        text += kNames[d];
        add_number(brick++);
    }
    text += ", neighbours";
    for (const int other : node.neighbours) add_number(other);
    return text;
}

TreeViewPass::TreeViewPass(gl::Shaders& shaders)
    : program_(shaders, {"common/fullscreen.vert", "17_sparse_voxel_octree/tree_view.frag"})
{
}

const gl::Texture* TreeViewPass::run(const TreeLight& light, const std::string& view, const TreeViewParams& params,
                                     const shared::CameraData& camera_data, glm::ivec2 size)
{
    if (view != "voxels" && view != "photons" && view != "nodes" && view != "bricks") return nullptr;
    const gl::Buffer camera("camera", std::vector{camera_data});
    const Octree& tree = light.tree();
    const NodeReport chosen = find_node(tree, params);
    const bool voxels = view == "voxels" || view == "photons";
    const int level = voxels ? tree.depth() - 1 : shown_level(tree, params);
    std::vector<int> selected;
    if (chosen.node >= 0) selected.push_back(chosen.node);
    if (params.show_neighbours) selected.insert(selected.end(), chosen.neighbours.begin(), chosen.neighbours.end());
    gl::fit_to_pixels(color_, framebuffer_, "tree view", GL_RGBA32F, size);
    const gl::Program& program = program_.with({{"SHOW", view == "nodes" ? "0" : view == "bricks" ? "1" : "2"}});
    light.bind(program);
    camera.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    tree.bind_leaf_faces(program);
    light.faces().faces().bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceBinding);
    (view == "photons" ? light.photons().irradiance() : light.reflected())
        .bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);
    program.set("with_emission", view == "voxels");
    program.set("level", level);
    program.set("geometry_end", tree.level(level).geometry_end);
    program.set("selected_count", int(selected.size()));
    for (std::size_t i = 0; i < selected.size(); ++i)
        program.set(("selected[" + std::to_string(i) + "]").c_str(), selected[i]);
    program.set("only_selected", params.only_selected && !voxels);
    program.set("direction", int(params.direction));
    program.set("layer", params.brick_layer);
    program.set("quantity", int(params.brick_quantity));
    gl::draw_pixels(program, framebuffer_, no_vertices_, size);
    return &color_;
}

}  // namespace conebook
