#include "12_second_bounce/scene_light.hpp"

#include "app/needs.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, SceneLightParams& params)
{
    add_parameters(table, params.voxels);
    add_parameters(table, params.bounces);
    add_parameters(table, params.emitters);
    add_parameters(table, params.shadow_maps);
}

SceneLight::SceneLight(gl::Shaders& shaders, const Scene& source, const GpuScene& scene, const SceneLightParams& params,
                       const SceneStorages& storages)
    : params_(params),
      shadow_maps_(shaders),
      voxels_(shaders, scene, params.voxels, storages.light),
      walk_volume_(shaders, storages.walk),
      emitters_(shaders, source, storages.light),
      bounces_(shaders)
{
}

void SceneLight::run(App& app, const GpuScene& scene, const ConeParams& cones, const LightPlan& plan,
                     const std::function<FaceChange()>& voxelize)
{
    scene_revision_ = scene.geometry_revision() + scene.lights_revision();
    if (params_.voxels.update == Update::always) shadow_maps_.forget();
    // What the lights see, if pixels or voxels ask.
    if (plan.shadow_maps.used)
        app.pass("shadow maps", Scope::light, [&] { return shadow_maps_.draw(scene, params_.shadow_maps); });

    // Triangles -> voxels -> what their faces reflect of direct light.
    if (!plan.voxels.used) return;
    const FaceChange change = voxelize();
    voxels_.shade(app, scene, shadow_maps_);

    // Where rays may leap, and what shines.
    if (!plan.pyramid.used) return;
    const VoxelStorage storage = params_.voxels.pyramid.storage;
    app.pass("walk volume", Scope::scene, [&] { return walk_volume_.run(voxels_.grid(), voxels_.faces(), int(storage)); });
    app.pass("emitters", Scope::scene, [&] {
        return emitters_.run(scene, voxels_.grid(), voxels_.faces(), voxels_.shading(), params_.emitters, storage,
                             plan.makes_everything);
    });

    // Faces light faces, along links that stay.
    if (plan.further_bounces.used) {
        // The rays of faces ask the pyramid what covers the back of the place where they start.
        voxels_.filter_coverage(app);
        app.pass("links", Scope::scene,
                 [&] { return bounces_.link(voxels_, walk_volume_, emitters_, cones, params_.bounces, change); });
        app.pass("further bounces", Scope::light, [&] { return bounces_.run(voxels_, cones, params_.bounces); });
    }

    // Faces -> pyramids, for the cones of the pixels.
    if (plan.further_bounces.used && goes_round(params_.bounces))
        voxels_.filter(app, bounces_.reflected(), bounces_.revision(), emitters_.part_of_voxels());
    else
        voxels_.filter(app, emitters_.part_of_voxels());

    // Who stores no more than there is keeps no more than is asked for.
    if (storage == VoxelStorage::dense) return;
    voxels_.free_scratch();
    bounces_.free_scratch();
}

std::vector<gl::Resource> SceneLight::resources() const
{
    std::vector<gl::Resource> all = shadow_maps_.resources();
    for (const auto& part :
         {voxels_.resources(), walk_volume_.resources(), emitters_.resources(), bounces_.resources()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<Need> SceneLight::needs(const Scene& source, const GpuScene& scene) const
{
    std::vector<Need> all = voxel_material_needs(scene);
    if (!source.lights.empty())
        for (const Need& need : shadow_maps_.needs(scene)) all.push_back(need);
    all.push_back(light_need(source));
    all.push_back(emitters_.need());
    return all;
}

std::vector<Count> SceneLight::counts() const
{
    std::vector<Count> all = voxels_.counts();
    all.push_back({"bounces from voxel to voxel", double(bounces_.count()), ""});
    return all;
}

}  // namespace conebook
