#include "gl/gpu_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <set>
#include <utility>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace conebook {

namespace {

constexpr int kSlots = shared::kTextureSlots;

std::array<const TextureSlot*, kSlots> slots_of(const Material& m)
{
    return {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
            &m.emission_texture,   &m.specular_texture,           &m.specular_color_texture};
}

bool is_srgb(int slot)
{
    return slot == shared::kBaseColorSlot || slot == shared::kEmissionSlot || slot == shared::kSpecularColorSlot;
}

// Materials are bound one at a time as uniform blocks; 256 is the coarsest alignment that OpenGL 4.5 allows a driver
// (table 23.71, UNIFORM_BUFFER_OFFSET_ALIGNMENT).
constexpr std::size_t kMaterialStride = sizeof(shared::MaterialData);
static_assert(kMaterialStride % 256 == 0);

shared::MaterialData material_data(const Material& m)
{
    shared::MaterialData data{};
    data.base_color = m.base_color;
    data.emission = glm::vec4(m.emission, m.alpha_cutoff);
    data.specular = glm::vec4(m.specular_color, m.specular);
    data.metallic = m.metallic;
    data.roughness = m.roughness;
    data.normal_scale = m.normal_scale;
    data.flags = (m.alpha_mode == AlphaMode::mask ? shared::kMaterialMasked : 0) |
                 (m.double_sided ? shared::kMaterialDoubleSided : 0) | (m.unlit ? shared::kMaterialUnlit : 0);
    const auto slots = slots_of(m);
    for (int s = 0; s < kSlots; ++s) {
        const glm::mat3 rows = glm::transpose(slots[s]->uv_transform);
        data.uv_row[2 * s] = glm::vec4(rows[0], float(slots[s]->uv_set));
        data.uv_row[2 * s + 1] = glm::vec4(rows[1], slots[s]->present() ? 1.0f : 0.0f);
    }
    return data;
}

int level_count(int width, int height) { return 1 + int(std::floor(std::log2(double(std::max(width, height))))); }

gl::Texture upload_rgba8(const Image& image, GLenum format)
{
    gl::Texture texture = gl::texture_2d(image.name.empty() ? "texture" : image.name, format,
                                         {image.width, image.height}, level_count(image.width, image.height));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture.id(), 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
    glGenerateTextureMipmap(texture.id());  // averages sRGB formats in linear light (OpenGL 4.5, 8.24)
    return texture;
}

// 1 where the mask lets the texel stay, 0 elsewhere: averaged, that is the covered share of the area.
gl::Texture upload_coverage(const Image& image, const Material& m)
{
    std::vector<std::uint8_t> covered(std::size_t(image.width) * std::size_t(image.height));
    for (std::size_t i = 0; i < covered.size(); ++i)
        covered[i] = float(image.rgba[4 * i + 3]) / 255.0f * m.base_color.a >= m.alpha_cutoff ? 255 : 0;
    gl::Texture texture = gl::texture_2d(image.name + " coverage", GL_R8, {image.width, image.height},
                                         level_count(image.width, image.height));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture.id(), 0, 0, 0, image.width, image.height, GL_RED, GL_UNSIGNED_BYTE, covered.data());
    glGenerateTextureMipmap(texture.id());
    return texture;
}

GLint wrap_mode(Wrap wrap)
{
    return wrap == Wrap::repeat ? GL_REPEAT : wrap == Wrap::clamp_to_edge ? GL_CLAMP_TO_EDGE : GL_MIRRORED_REPEAT;
}

GLuint make_sampler(const TextureSlot& slot)
{
    GLuint id = 0;
    glCreateSamplers(1, &id);
    const bool linear = slot.min_filter == Filter::linear;
    const GLint minification = slot.mipmapped ? (linear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_LINEAR)
                                              : (linear ? GL_LINEAR : GL_NEAREST);
    glSamplerParameteri(id, GL_TEXTURE_MIN_FILTER, minification);
    glSamplerParameteri(id, GL_TEXTURE_MAG_FILTER, slot.mag_filter == Filter::linear ? GL_LINEAR : GL_NEAREST);
    glSamplerParameteri(id, GL_TEXTURE_WRAP_S, wrap_mode(slot.wrap_s));
    glSamplerParameteri(id, GL_TEXTURE_WRAP_T, wrap_mode(slot.wrap_t));
    return id;
}

}  // namespace

// snippet: is_outside
bool is_outside(const Bounds& box, const glm::mat4& clip_from_scene)
{
    // The sides are sums and differences of the rows (Gribb & Hartmann 2001): -w <= x, y <= w and 0 <= z <= w.
    const glm::dmat4 rows(glm::transpose(clip_from_scene));
    for (const glm::dvec4& side :
         {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[2], rows[3] - rows[2]}) {
        bool beyond = true;
        for (int i = 0; i < 8 && beyond; ++i) {
            const glm::dvec4 corner(glm::dvec3(box.corner(i)), 1.0);
            constexpr double kRounding = 1e-5;  // of a sum of four floats, and more
            beyond = glm::dot(side, corner) < -kRounding * glm::dot(glm::abs(side), glm::abs(corner));
        }
        if (beyond) return true;
    }
    return false;
}
// end snippet

shared::LightData light_data(const Light& light)
{
    // KHR_lights_punctual, "Inner and Outer Cone Angles": attenuation = saturate(cos * scale + offset)^2.
    const float cos_outer = std::cos(light.outer_cone_angle), cos_inner = std::cos(light.inner_cone_angle);
    const float scale = 1.0f / std::max(0.001f, cos_inner - cos_outer);
    shared::LightData data{};
    data.position = glm::vec4(light.position, float(int(light.type)));
    data.direction = glm::vec4(light.direction, light.range);
    data.intensity = glm::vec4(light.intensity, 0.0f);
    data.spot = glm::vec4(scale, -cos_outer * scale, cos_outer, 0.0f);
    return data;
}

shared::CameraData camera_data(const Camera& camera, glm::ivec2 size, const Bounds& content)
{
    // In double precision, rounded once at the end: from 100 km away the scene's 2 m are a difference of large numbers.
    const glm::dmat4 scene_from_view(camera.world_from_camera), view_from_scene = glm::affineInverse(scene_from_view);
    const auto [near, far] = visible_depths(camera, content);
    // Reversed depth, 1 at the near plane and 0 at the far one: GLM's matrices with the two planes exchanged.
    const glm::dmat4 clip_from_view =
        camera.orthographic
            ? glm::orthoRH_ZO<double>(-camera.x_mag, camera.x_mag, -camera.y_mag, camera.y_mag, far, near)
            : glm::perspectiveRH_ZO<double>(camera.y_fov, double(size.x) / size.y, far, near);
    shared::CameraData data{};
    data.clip_from_scene = clip_from_view * view_from_scene;
    data.scene_from_clip = scene_from_view * glm::inverse(clip_from_view);
    data.position = glm::vec4(glm::vec3(camera.world_from_camera[3]), camera.orthographic ? 0.0f : 1.0f);
    const double in_front = std::min(near - double(camera.z_near), double(glm::length(content.extent())));
    data.forward = glm::vec4(-glm::vec3(camera.world_from_camera[2]), in_front);
    data.size = glm::vec4(size, 1.0f / glm::vec2(size));
    return data;
}

shared::CameraData moved(const shared::CameraData& camera, glm::vec2 pixels)
{
    if (pixels == glm::vec2(0.0f)) return camera;
    const glm::vec2 clip = 2.0f * pixels * glm::vec2(camera.size.z, camera.size.w);
    shared::CameraData data = camera;
    data.clip_from_scene = glm::translate(glm::mat4(1.0f), glm::vec3(clip, 0.0f)) * camera.clip_from_scene;
    data.scene_from_clip = camera.scene_from_clip * glm::translate(glm::mat4(1.0f), glm::vec3(-clip, 0.0f));
    return data;
}

namespace {
std::optional<Bounds> bounds_of(const Scene& scene, const Draw& draw)
{
    if (draw.index_count == 0) return {};
    Bounds box{glm::vec3(INFINITY), glm::vec3(-INFINITY)};
    for (std::uint32_t i = draw.first_index; i < draw.first_index + draw.index_count; ++i) {
        box.min = glm::min(box.min, scene.vertices[scene.indices[i]].position);
        box.max = glm::max(box.max, scene.vertices[scene.indices[i]].position);
    }
    return box;
}

gl::Buffer light_buffer(const std::vector<Light>& lights)
{
    std::vector<shared::LightData> data;
    for (const Light& light : lights) data.push_back(light_data(light));
    return gl::Buffer("lights", data);
}
}  // namespace

namespace {

// What the triangles of a draw make of its material.
MaterialUse use_of(const Scene& scene, const Draw& draw)
{
    MaterialUse use;
    use.triangles = draw.index_count / 3;
    for (std::uint32_t i = draw.first_index; i < draw.first_index + draw.index_count; i += 3) {
        const auto corner = [&](std::uint32_t k) { return scene.vertices[scene.indices[i + k]].position; };
        const glm::vec3 a = corner(0), b = corner(1), c = corner(2);
        const glm::vec3 sides = glm::max(a, glm::max(b, c)) - glm::min(a, glm::min(b, c));
        const glm::vec3 areas = 0.5f * glm::abs(glm::cross(b - a, c - a));
        use.box_sides_m += double(sides.x + sides.y + sides.z);
        use.seen_areas_m2 += double(areas.x + areas.y + areas.z);
    }
    for (std::uint32_t i = 0; i < draw.index_count && !use.vertex_alpha; ++i)
        use.vertex_alpha = scene.vertices[scene.indices[draw.first_index + i]].color.a != 1.0f;
    return use;
}

void add(MaterialUse& sum, const MaterialUse& one)
{
    sum.triangles += one.triangles;
    sum.vertex_alpha = sum.vertex_alpha || one.vertex_alpha;
    sum.box_sides_m += one.box_sides_m;
    sum.seen_areas_m2 += one.seen_areas_m2;
}


}  // namespace

GpuScene::GpuScene(const Scene& scene)
    : bounds_(scene.bounds), lights_(scene.lights), light_buffer_(light_buffer(scene.lights))
{
    white_ = upload_rgba8({"white", 1, 1, {255, 255, 255, 255}}, GL_RGBA8);
    set_triangles(scene, 0);
}

void GpuScene::set_triangles(const Scene& scene, std::size_t same_images)
{
    triangle_count_ = scene.triangle_count();
    draws_ = scene.draws;
    materials_ = scene.materials;
    vertex_buffer_ = gl::Buffer("vertices", scene.vertices);
    index_buffer_ = gl::Buffer("indices", scene.indices);
    std::vector<shared::MaterialData> materials;
    for (const Material& m : scene.materials) materials.push_back(material_data(m));
    material_buffer_ = gl::Buffer("materials", materials);
    has_emission_ = std::any_of(materials_.begin(), materials_.end(), std::mem_fn(&Material::shines));
    find_dynamic(scene);

    std::vector<GLuint> triangle_materials(triangle_count_, 0u);
    draw_uses_.clear();
    for (const Draw& draw : scene.draws) {
        const bool double_sided = scene.materials[std::size_t(draw.material)].double_sided;
        const GLuint word = GLuint(draw.material) | (double_sided ? shared::kTriangleDoubleSided : 0u);
        std::fill_n(triangle_materials.begin() + draw.first_index / 3, draw.index_count / 3, word);
        draw_uses_.push_back(use_of(scene, draw));
    }
    triangle_material_buffer_ = gl::Buffer("materials of triangles", triangle_materials);
    material_uses_.assign(materials.size(), {});
    for (std::size_t d = 0; d < draws_.size(); ++d) add(material_uses_[std::size_t(draws_[d].material)], draw_uses_[d]);

    struct Attribute {
        GLint components;
        std::size_t offset;
    };
    const Attribute attributes[] = {{3, offsetof(Vertex, position)}, {3, offsetof(Vertex, normal)},
                                    {4, offsetof(Vertex, tangent)},  {2, offsetof(Vertex, uv0)},
                                    {2, offsetof(Vertex, uv1)},      {4, offsetof(Vertex, color)}};
    const GLuint vao = vertex_array_.id();
    glVertexArrayVertexBuffer(vao, 0, vertex_buffer_.id(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(vao, index_buffer_.id());
    for (GLuint i = 0; i < std::size(attributes); ++i) {
        glEnableVertexArrayAttrib(vao, i);
        glVertexArrayAttribFormat(vao, i, attributes[i].components, GL_FLOAT, GL_FALSE, GLuint(attributes[i].offset));
        glVertexArrayAttribBinding(vao, i, 0);
    }
    bind_textures(scene, same_images);
}

void GpuScene::bind_textures(const Scene& scene, std::size_t same_images)
{
    std::map<TextureOf, gl::Texture> before = std::exchange(textures_, {});
    const auto texture_of = [&](const TextureOf& key, const Material& m) {
        const auto [entry, is_new] = textures_.try_emplace(key);
        if (!is_new) return entry->second.id();
        const auto kept = before.find(key);
        const Image& image = scene.images[std::size_t(key.image)];
        if (kept != before.end() && std::size_t(key.image) < same_images)
            entry->second = std::move(kept->second);
        else if (key.content == Content::coverage)
            entry->second = upload_coverage(image, m);
        else
            entry->second = upload_rgba8(image, key.content == Content::srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8);
        return entry->second.id();
    };
    bindings_.clear();
    for (const Material& m : scene.materials) {
        auto& bindings = bindings_.emplace_back();
        const auto slots = slots_of(m);
        for (int s = 0; s < kSlots; ++s) {
            if (!slots[s]->present()) continue;
            const Content content = is_srgb(s) ? Content::srgb : Content::linear;
            bindings[s].texture = texture_of({slots[s]->image, content, 0.0f, 0.0f}, m);
            bindings[s].sampler = gl::Handle<gl::delete_sampler>(make_sampler(*slots[s]));
        }
        if (m.alpha_mode == AlphaMode::mask && m.base_color_texture.present()) {
            TextureSlot slot = m.base_color_texture;
            bindings[shared::kCoverageUnit].texture =
                texture_of({slot.image, Content::coverage, m.base_color.a, m.alpha_cutoff}, m);
            slot.mipmapped = true;
            slot.min_filter = Filter::linear;
            bindings[shared::kCoverageUnit].sampler = gl::Handle<gl::delete_sampler>(make_sampler(slot));
        }
    }
}

void GpuScene::move(const Scene& scene, std::size_t index)
{
    const Node& node = scene.nodes[index];
    vertex_buffer_.write(node.vertices.first * sizeof(Vertex), node.vertices.count * sizeof(Vertex),
                         &scene.vertices[node.vertices.first]);
    std::set<int> materials;
    for (std::uint32_t d = node.draws.first; d < node.draws.end(); ++d) {
        draw_uses_[d] = use_of(scene, draws_[d]);
        if (boxes_[d]) boxes_[d] = bounds_of(scene, draws_[d]);
        materials.insert(draws_[d].material);
    }
    for (const int material : materials) {  // in the order in which they were summed first
        material_uses_[std::size_t(material)] = {};
        for (std::size_t d = 0; d < draws_.size(); ++d)
            if (draws_[d].material == material) add(material_uses_[std::size_t(material)], draw_uses_[d]);
    }
}

void GpuScene::set_material(const Scene& scene, std::size_t material)
{
    materials_[material] = scene.materials[material];
    const shared::MaterialData data = material_data(materials_[material]);
    material_buffer_.write(material * kMaterialStride, sizeof data, &data);
    has_emission_ = std::any_of(materials_.begin(), materials_.end(), std::mem_fn(&Material::shines));
}

void GpuScene::find_dynamic(const Scene& scene)
{
    std::vector<bool> moves(draws_.size(), false);
    for (const Node& node : scene.nodes)
        for (std::uint32_t d = node.draws.first; d < node.draws.end() && node.dynamic; ++d) moves[d] = true;
    boxes_.assign(draws_.size(), {});
    for (std::size_t d = 0; d < draws_.size(); ++d)
        if (!moves[d]) boxes_[d] = bounds_of(scene, draws_[d]);
    may_move_ = std::any_of(scene.nodes.begin(), scene.nodes.end(),
                            [](const Node& node) { return node.dynamic && node.vertices.count > 0; });
}

void GpuScene::set_lights(const std::vector<Light>& lights)
{
    lights_ = lights;
    light_buffer_ = light_buffer(lights_);
    ++lights_revision_;
}

void GpuScene::bind_lights(const gl::Program& program) const
{
    light_buffer_.bind(GL_SHADER_STORAGE_BUFFER, shared::kLightBinding);
    program.set("light_count", int(lights_.size()));
}

void GpuScene::bind_material(std::size_t material) const
{
    glBindBufferRange(GL_UNIFORM_BUFFER, shared::kMaterialBlock, material_buffer_.id(),
                      GLintptr(material) * GLintptr(kMaterialStride), sizeof(shared::MaterialData));
    const auto& bindings = bindings_[material];
    for (GLuint unit = 0; unit < bindings.size(); ++unit) {
        const BoundTexture& bound = bindings[unit];
        glBindTextureUnit(unit, bound.texture != 0 ? bound.texture : white_.id());
        glBindSampler(unit, bound.sampler.id());
    }
}

namespace {
void unbind_samplers()
{
    for (GLuint unit = 0; unit <= GLuint(shared::kCoverageUnit); ++unit) glBindSampler(unit, 0);
}
}  // namespace

std::size_t GpuScene::for_each_draw(const gl::Program& program, Culling culling, const glm::mat4* clip_from_scene,
                                    const std::function<void(const Draw&)>& run) const
{
    std::size_t drawn = 0;
    program.use();
    bind_lights(program);
    glBindVertexArray(vertex_array_.id());
    glCullFace(GL_BACK);
    int bound_material = -1;
    for (std::size_t i = 0; i < draws_.size(); ++i) {
        const Draw& draw = draws_[i];
        if (clip_from_scene != nullptr && boxes_[i] && is_outside(*boxes_[i], *clip_from_scene)) continue;
        ++drawn;
        if (draw.material != bound_material) {
            bound_material = draw.material;
            bind_material(std::size_t(draw.material));
            const bool cull =
                culling == Culling::back_of_single_sided && !materials_[std::size_t(draw.material)].double_sided;
            (cull ? glEnable : glDisable)(GL_CULL_FACE);
        }
        run(draw);
    }
    glDisable(GL_CULL_FACE);
    unbind_samplers();
    return drawn;
}

namespace {
const void* index_offset(std::size_t index) { return reinterpret_cast<const void*>(index * sizeof(GLuint)); }
}  // namespace

std::size_t GpuScene::draw(const gl::Program& program, Culling culling, const glm::mat4* clip_from_scene) const
{
    return for_each_draw(program, culling, clip_from_scene, [](const Draw& draw) {
        glDrawElements(GL_TRIANGLES, GLsizei(draw.index_count), GL_UNSIGNED_INT, index_offset(draw.first_index));
    });
}

void GpuScene::draw_patches(const gl::Program& program, int instances, std::uint32_t most_patches) const
{
    glPatchParameteri(GL_PATCH_VERTICES, 3);
    for_each_draw(program, Culling::none, nullptr, [&](const Draw& draw) {
        for (std::uint32_t done = 0; done < draw.index_count; done += 3 * most_patches)
            glDrawElementsInstanced(GL_PATCHES, GLsizei(std::min(3 * most_patches, draw.index_count - done)),
                                    GL_UNSIGNED_INT, index_offset(draw.first_index + done), instances);
    });
}

void GpuScene::draw_geometry(const gl::Program& program, Range triangles) const
{
    program.set("first_triangle", triangles.first);
    program.use();
    glBindVertexArray(vertex_array_.id());
    glDrawElements(GL_TRIANGLES, GLsizei(3 * triangles.count), GL_UNSIGNED_INT,
                   index_offset(3 * std::size_t(triangles.first)));
}

void GpuScene::bind_triangles() const
{
    gl::require_storage("vertices", vertex_buffer_.bytes() / sizeof(Vertex), sizeof(Vertex), "a smaller scene");
    gl::require_storage("triangles", triangle_count_, 3 * sizeof(GLuint), "a smaller scene");
    vertex_buffer_.bind(GL_SHADER_STORAGE_BUFFER, shared::kVertexBinding);
    index_buffer_.bind(GL_SHADER_STORAGE_BUFFER, shared::kIndexBinding);
    triangle_material_buffer_.bind(GL_SHADER_STORAGE_BUFFER, shared::kTriangleMaterialBinding);
}

void GpuScene::for_each_material(const std::function<void(std::size_t)>& run) const
{
    for (std::size_t material = 0; material < materials_.size(); ++material) {
        bind_material(material);
        run(material);
    }
    unbind_samplers();
}

std::vector<Triangle> GpuScene::triangles() const
{
    const auto vertices = vertex_buffer_.read<Vertex>();
    const auto indices = index_buffer_.read<std::uint32_t>();
    std::vector<Triangle> triangles;
    triangles.reserve(triangle_count_);
    for (const Draw& draw : draws_) {
        const bool double_sided = materials_[std::size_t(draw.material)].double_sided;
        for (std::size_t i = draw.first_index; i < draw.first_index + draw.index_count; i += 3)
            triangles.push_back(
                {{vertices[indices[i]].position, vertices[indices[i + 1]].position, vertices[indices[i + 2]].position},
                 double_sided});
    }
    return triangles;
}

std::vector<gl::Resource> GpuScene::resources() const
{
    std::size_t texture_bytes = 0;
    for (const auto& [key, texture] : textures_) texture_bytes += texture.bytes();
    return {{"scene geometry", vertex_buffer_.bytes() + index_buffer_.bytes() + triangle_material_buffer_.bytes()},
            {"scene textures", texture_bytes},
            {"scene materials and lights", material_buffer_.bytes() + light_buffer_.bytes()}};
}

}  // namespace conebook
