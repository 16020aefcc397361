#include "06_voxel_shading/voxel_shading.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, VoxelShadingParams& params)
{
    table.add("voxel_shadows", params.voxel_shadows, {"none", "map", "hard_ray", "soft_ray"}, "shadows on voxels");
    table.add("voxel_lambert", params.voxel_lambert, {"lambert", "directional"},
              "cosine of the mean normal, or of its axes one by one");
    table.add("soft_sharpness", params.soft_sharpness, 0.1, 100.0, "voxels",
              "soft_ray: distance at which a hit still blocks everything");
}

VoxelShading::VoxelShading(gl::Shaders& shaders) : program_(shaders, {"06_voxel_shading/direct.comp"}) {}

bool VoxelShading::run(const GpuScene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer,
                       const VoxelFaces& faces, const ShadowMaps& shadow_maps, const VoxelShadingParams& params)
{
    if (!made_from_.differs(faces.revision(), scene.lights_revision(), shadow_maps.revision(), params)) return false;
    ++revision_;
    if (radiance_.bytes() < faces.face_count() * sizeof(glm::vec4)) {
        radiance_ = gl::Buffer("face radiance", faces.face_count() * sizeof(glm::vec4));
        visibility_ = gl::Buffer("face visibility", faces.face_count() * sizeof(GLuint));
    }
    const gl::Program& program = program_.with({{"SHADOWS", std::to_string(int(params.voxel_shadows))},
                                                {"DIRECTIONAL_LAMBERT", std::to_string(int(params.voxel_lambert))}});
    program.use();
    grid.bind();
    faces.bind();
    voxelizer.occupancy().bind(shared::kOccupancyUnit);
    scene.bind_lights(program);
    shadow_maps.bind(program);
    program.set("soft_sharpness", params.soft_sharpness);
    // snippet: dispatch
    radiance_.bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);
    visibility_.bind(GL_SHADER_STORAGE_BUFFER, shared::kVisibilityBinding);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.face_groups().id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    // end snippet
    return true;
}

}  // namespace conebook
