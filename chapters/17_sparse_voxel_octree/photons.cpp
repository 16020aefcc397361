#include "17_sparse_voxel_octree/photons.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>

namespace conebook {

void add_parameters(ParameterTable& table, PhotonParams& params)
{
    table.add("photon_map_size", params.photon_map_size, 64, 8192, "texels",
              "injection=photons: side of a light's view");
}

Photons::Photons(gl::Shaders& shaders)
    : depth_(shaders.load({"03_shadow_map/shadow.vert", "03_shadow_map/shadow.frag"})),
      inject_(shaders.load({"17_sparse_voxel_octree/inject.comp"})),
      light_(shaders.load({"17_sparse_voxel_octree/photon_light.comp"}))
{
}

void Photons::draw(const GpuScene& scene, const glm::mat4& clip_from_scene, int size)
{
    if (!view_ || view_.size_2d() != glm::ivec2(size)) {
        view_ = gl::texture_2d("light view", GL_DEPTH_COMPONENT32F, glm::ivec2(size));
        framebuffer_ = gl::Framebuffer("light view", {}, &view_);
    }
    view_.clear();  // 0: farthest
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    framebuffer_.bind(glm::ivec2(size));
    depth_.set("clip_from_scene", clip_from_scene);
    scene.draw(depth_, Culling::none);
    glDisable(GL_DEPTH_TEST);
}

bool Photons::run(const GpuScene& scene, const VoxelGrid& grid, const VoxelFaces& faces, const Octree& tree,
                  const PhotonParams& params)
{
    if (!made_from_.differs(tree.revision(), scene.lights_revision(), params)) return false;
    ++revision_;
    flux_ = gl::Buffer("flux of faces", faces.face_count() * 6 * sizeof(GLuint));
    radiance_ = gl::Buffer("light of photons", faces.face_count() * sizeof(glm::vec4));
    irradiance_ = gl::Buffer("irradiance by photons", faces.face_count() * sizeof(glm::vec4));

    // Of the flux of the brightest light a texel has about 1 / n^2: that is 2^20 units, and a light of a
    // ten-thousandth of it still has a hundred a texel.
    float most = 0.0f;
    const glm::vec3 extent = scene.bounds().extent();
    for (const Light& light : scene.lights()) {
        const float brightest = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
        const bool directional = light.type == LightType::directional;
        most = std::max(most, brightest * (directional ? glm::dot(extent, extent) : 4.0f * glm::pi<float>()));
    }
    const auto texels = float(params.photon_map_size) * float(params.photon_map_size);
    flux_unit_ = std::max(most / (texels * std::exp2(20.0f)), 1e-37f);

    for (std::size_t i = 0; i < scene.lights().size(); ++i) {
        const std::vector<glm::mat4> views =
            shadow_matrices(scene.lights()[i], scene.bounds(), nullptr, params.photon_map_size);
        for (const glm::mat4& view : views) {
            draw(scene, view, params.photon_map_size);
            // Six views of 90 degrees and a few texels more: the width of what counts in tangents is 1.
            const glm::dmat4 scene_from_clip = glm::inverse(glm::dmat4(view));
            const double half_width =
                views.size() == 6 ? double(glm::length(glm::vec3(view[0][0], view[1][0], view[2][0]))) : 1.0;
            grid.bind();
            faces.bind();
            scene.bind_lights(inject_);
            view_.bind(16);
            tree.bind(inject_);
            tree.bind_leaf_faces(inject_);
            flux_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFluxBinding);
            inject_.set("light_index", int(i));
            inject_.set("scene_from_clip", glm::mat4(scene_from_clip));
            inject_.set("half_width", float(half_width));
            inject_.set("flux_unit", flux_unit_);
            inject_.use();
            const GLuint groups = gl::group_count(std::size_t(params.photon_map_size), 8);
            glDispatchCompute(groups, groups, 1);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        }
    }

    grid.bind();
    faces.bind();
    flux_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFluxBinding);
    radiance_.bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);
    irradiance_.bind(GL_SHADER_STORAGE_BUFFER, shared::kReflectedBinding);
    light_.set("flux_unit", flux_unit_);
    light_.use();
    gl::dispatch_items(faces.face_count(), 64);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return true;
}

glm::dvec3 Photons::total_flux() const
{
    glm::dvec3 sum(0.0);
    const auto words = flux_.read<GLuint>();
    for (std::size_t i = 0; i < words.size(); i += 6)
        for (int c = 0; c < 3; ++c)
            sum[c] += (double(words[i + std::size_t(c)]) + 4294967296.0 * double(words[i + 3 + std::size_t(c)])) *
                      double(flux_unit_);
    return sum;
}

}  // namespace conebook
