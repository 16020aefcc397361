#include "19_vertex_radiosity/radiosity_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace conebook {
namespace {

struct Attribute {
    GLint components;
    std::size_t offset;
};

void set_layout(const gl::VertexArray& array, const gl::Buffer& buffer, std::size_t stride,
                const std::vector<Attribute>& attributes)
{
    glVertexArrayVertexBuffer(array.id(), 0, buffer.id(), 0, GLsizei(stride));
    for (GLuint i = 0; i < attributes.size(); ++i) {
        glEnableVertexArrayAttrib(array.id(), i);
        glVertexArrayAttribFormat(array.id(), i, attributes[i].components, GL_FLOAT, GL_FALSE,
                                  GLuint(attributes[i].offset));
        glVertexArrayAttribBinding(array.id(), i, 0);
    }
}

// A shader's loop over lights ends long before the 65,535 turns at which llvmpipe cuts it off.
constexpr int kLightsAtOnce = 8192;

}  // namespace

void PatchBuffers::upload(const PatchMesh& mesh)
{
    patch_count_ = int(mesh.patches.size());
    back_offset_ = mesh.back_offset();
    draws_ = mesh.draws;
    patches_ = gl::Buffer("patches", mesh.patches);
    vertices_ = gl::Buffer("subdivided vertices", mesh.vertices);
    indices_ = gl::Buffer("subdivided indices", mesh.indices);
    set_layout(points_, patches_, sizeof(shared::Patch),
               {{4, offsetof(shared::Patch, position)}, {4, offsetof(shared::Patch, normal)}});
    set_layout(triangles_, vertices_, sizeof(Vertex),
               {{3, offsetof(Vertex, position)},
                {3, offsetof(Vertex, normal)},
                {4, offsetof(Vertex, tangent)},
                {2, offsetof(Vertex, uv0)},
                {2, offsetof(Vertex, uv1)},
                {4, offsetof(Vertex, color)}});
    glVertexArrayElementBuffer(triangles_.id(), indices_.id());
}

void PatchBuffers::draw_points(const gl::Program& program) const
{
    if (patch_count_ == 0) return;
    program.use();
    glBindVertexArray(points_.id());
    glDrawArrays(GL_POINTS, 0, patch_count_);
}

void PatchBuffers::draw(const gl::Program& program, const GpuScene& scene, GLenum culled_of_single_sided) const
{
    program.use();
    glBindVertexArray(triangles_.id());
    glCullFace(culled_of_single_sided);
    scene.for_each_material([&](std::size_t material) {
        const bool two_sides = scene.materials()[material].double_sided;
        if (two_sides && culled_of_single_sided == GL_FRONT) return;
        (two_sides ? glDisable : glEnable)(GL_CULL_FACE);
        for (const Draw& draw : draws_) {
            if (std::size_t(draw.material) != material || draw.index_count == 0) continue;
            program.set("first_triangle", int(draw.first_index / 3));
            glDrawElements(GL_TRIANGLES, GLsizei(draw.index_count), GL_UNSIGNED_INT,
                           reinterpret_cast<const void*>(std::size_t(draw.first_index) * sizeof(GLuint)));
        }
    });
    glDisable(GL_CULL_FACE);
    glCullFace(GL_BACK);
}

void PatchBuffers::bind() const
{
    patches_.bind(GL_SHADER_STORAGE_BUFFER, shared::kPatchBinding);
    indices_.bind(GL_SHADER_STORAGE_BUFFER, shared::kIndexBinding);
}

std::vector<gl::Resource> PatchBuffers::resources() const
{
    return {patches_.resource(), vertices_.resource(), indices_.resource()};
}

RadiosityMap::RadiosityMap(gl::Shaders& shaders)
    : from_lights_(
          shaders.load({"19_vertex_radiosity/gather.vert", "19_vertex_radiosity/gather.frag"}, {{"PUNCTUAL", "1"}})),
      from_patches_(
          shaders.load({"19_vertex_radiosity/gather.vert", "19_vertex_radiosity/gather.frag"}, {{"PUNCTUAL", "0"}}))
{
    clear(0);
}

void RadiosityMap::clear(int patch_count)
{
    const int side = std::max(1, int(std::ceil(std::sqrt(double(patch_count)))));
    if (!direct_ || this->side() != side) {
        direct_ = gl::texture_2d("radiosity map, direct", GL_RGBA32F, {side, side});
        indirect_ = gl::texture_2d("radiosity map, indirect", GL_RGBA32F, {side, side});
        direct_target_ = gl::Framebuffer("radiosity map, direct", {&direct_});
        indirect_target_ = gl::Framebuffer("radiosity map, indirect", {&indirect_});
    }
    direct_.clear();
    indirect_.clear();
}

void RadiosityMap::clear_indirect() const { indirect_.clear(); }

void RadiosityMap::add(const gl::Program& program, const gl::Framebuffer& target, const PatchBuffers& patches,
                       const std::vector<std::uint32_t>& sight, std::size_t light_count, bool half_texel) const
{
    if (light_count == 0 || patches.patch_count() == 0) return;
    gl::require_storage("sights of patches", sight.size(), sizeof(GLuint), "a larger max_edge or fewer cells");
    const gl::Buffer sight_buffer("sight", sight);
    sight_buffer.bind(GL_SHADER_STORAGE_BUFFER, shared::kSightBinding);
    program.set("map_side", side());
    program.set("half_texel", half_texel ? 0.5f : 0.0f);
    program.set("patch_count", patches.patch_count());
    target.bind(direct_.size_2d());
    glBlendFunc(GL_ONE, GL_ONE);
    glEnable(GL_BLEND);
    for (int first = 0; first < int(light_count); first += kLightsAtOnce) {
        program.set("first_light", first);
        program.set("end_light", std::min(first + kLightsAtOnce, int(light_count)));
        patches.draw_points(program);
    }
    glDisable(GL_BLEND);
}

void RadiosityMap::add_direct(const PatchBuffers& patches, const GpuScene& scene,
                              const std::vector<std::uint32_t>& sight, bool half_texel)
{
    scene.bind_lights(from_lights_);
    add(from_lights_, direct_target_, patches, sight, scene.lights().size(), half_texel);
}

void RadiosityMap::add_indirect(const PatchBuffers& patches, const std::vector<LightNode>& lights,
                                const std::vector<std::uint32_t>& sight, FormFactor form_factor, bool half_texel)
{
    std::vector<shared::PatchLight> list;
    for (const LightNode& node : lights) list.push_back(node.light);
    const gl::Buffer light_buffer("patch lights", list);
    light_buffer.bind(GL_SHADER_STORAGE_BUFFER, shared::kPatchLightBinding);
    from_patches_.set("form_factor", int(form_factor));
    add(from_patches_, indirect_target_, patches, sight, lights.size(), half_texel);
}

void RadiosityMap::bind(const gl::Program& program) const
{
    direct_.bind(GLuint(shared::kFirstFreeUnit));
    indirect_.bind(GLuint(shared::kFirstFreeUnit + 1));
    program.set("map_side", side());
}

}  // namespace conebook
