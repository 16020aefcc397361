#include "17_sparse_voxel_octree/tree_light.hpp"

#include <array>
#include <bit>

namespace conebook {

void add_parameters(ParameterTable& table, TreeLightParams& params)
{
    add_parameters(table, params.grid);
    add_parameters(table, params.voxelizer);
    add_parameters(table, params.shading);
    add_parameters(table, params.shadow_maps);
    add_parameters(table, params.tree);
    add_parameters(table, params.bricks);
    table.add("injection", params.injection, {"faces", "photons"},
              "direct light of the faces: at their middles, or flux");
    add_parameters(table, params.photons);
    table.add("bounces", params.bounces, -1, 64, "", "indirect bounces; -1: until nothing changes");
    table.add("tolerance", params.tolerance, 1e-6, 0.1, "", "bounces=-1: largest change over largest radiance");
    table.add_values("links", params.links, {1, 5, 9, 16}, "cones of every face, along which light goes round");
    table.add("update", params.update, {"on_change", "always"}, "when passes run that do not depend on the camera");
}

void add_tree_cone_parameters(ParameterTable& table, ConeParams& params)
{
    table.add_values("cones", params.cones, {1, 5, 6, 9, 16, 32}, "diffuse cones over the hemisphere");
    table.add("cone_table", params.cone_table, {"tilted", "thesis", "thesis_added"},
              "tilts that keep the cosine, those published, or those of the published code");
    table.add("interleave", params.interleave, {"off", "on", "every_pixel"},
              "neighbouring pixels have different cones and share them, or every pixel has all");
    table.add("aperture", params.aperture, 0.0, 179.0, "deg", "full aperture of a diffuse cone; 0: as the set asks");
    table.add("step", params.step, 0.05, 4.0, "", "step over the cone's diameter, or over a sample's spacing");
    table.add("start_offset", params.start_offset, 0.0, 8.0, "voxels", "from the surface to the cone's start");
    table.add("ao_falloff", params.ao_falloff, 0.0, 100.0, "1/m", "ambient occlusion: 1 / (1 + this * distance)");
    table.add("sky", params.sky, 0.0, 1e4, "W/sr/m2", "radiance of what cones see that leave the grid");
}

TreeLight::TreeLight(gl::Shaders& shaders, const GpuScene& scene, const TreeLightParams& params)
    : params_(params),
      grid_(scene.bounds(), params.grid),
      voxelizer_(shaders),
      faces_(shaders, voxelizer_),
      shading_(shaders),
      photons_(shaders),
      tree_(shaders),
      bricks_(shaders),
      bounce_(shaders, {"17_sparse_voxel_octree/bounce.comp"}),
      change_("bounce change", 2 * sizeof(GLuint))
{
}

void TreeLight::bind(const gl::Program& program) const
{
    grid_.bind();
    bricks_.bind(tree_, program);
}

void TreeLight::run(App& app, const GpuScene& scene, const ShadowMaps& shadow_maps, const ConeParams& cones,
                    bool shows_photons)
{
    grid_.fit(scene.bounds(), params_.grid);
    if (params_.update == Update::always) {
        voxelizer_.forget();
        photons_.forget();
        bricks_.forget();
        bounced_from_.forget();
    }
    // Triangles -> occupied voxels -> mean material of their faces.
    app.pass("voxelize", Scope::scene, [&] { return voxelizer_.run(scene, grid_, params_.voxelizer); });
    app.pass("average", Scope::scene, [&] { return faces_.run(scene, grid_, voxelizer_); });
    // Occupied voxels -> nodes, and which bricks they have.
    app.pass("octree", Scope::scene, [&] { return tree_.build(grid_, faces_, params_.tree); });
    // Lights -> radiance of the faces.
    if (!by_photons())
        app.pass("voxel shading", Scope::light,
                 [&] { return shading_.run(scene, grid_, voxelizer_, faces_, shadow_maps, params_.shading); });
    if (by_photons() || shows_photons)
        app.pass("photons", Scope::light, [&] { return photons_.run(scene, grid_, faces_, tree_, params_.photons); });
    // Faces -> bricks of the leaves -> of all levels.
    if (few_bounces())
        app.pass("bricks", Scope::light,
                 [&] { return bricks_.fill(grid_, faces_, tree_, direct(), direct_revision(), params_.bricks); });
    else
        app.pass("bricks and bounces", Scope::light, [&] { return bounce(cones); });
}

bool TreeLight::bounce(const ConeParams& cones)
{
    // Of the cones' parameters the pixels alone have some; a face has links of them.
    ConeParams of_faces = cones;
    of_faces.cones = params_.links;
    of_faces.interleave = Interleave::on;
    if (!bounced_from_.differs(tree_.revision(), direct_revision(), params_.injection, params_.bricks, params_.bounces,
                               params_.tolerance, params_.links, of_faces))
        return false;
    constexpr int kSets = 64;  // of 8 x 8 faces of a wall
    constexpr int kMost = 64;
    const bool to_convergence = params_.bounces < 0;
    const int wanted = to_convergence ? kMost : params_.bounces - 1;
    const std::size_t bytes = faces_.face_count() * sizeof(glm::vec4);
    reflected_ = gl::Buffer("reflected by faces", bytes);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    if (bytes > 0) glCopyNamedBufferSubData(direct().id(), reflected_.id(), 0, 0, GLsizeiptr(bytes));
    directions_.update(of_faces, 0, kSets);
    bricks_.fill(grid_, faces_, tree_, reflected_, ++bounced_, params_.bricks);
    const gl::Program& program = bounce_.with({{"MEASURE", to_convergence ? "1" : "0"}});
    for (bounce_count_ = 0; bounce_count_ < wanted;) {
        bind(program);
        directions_.bind(program, of_faces);
        faces_.bind();
        direct().bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);
        reflected_.bind(GL_SHADER_STORAGE_BUFFER, shared::kReflectedBinding);
        change_.clear();
        change_.bind(GL_SHADER_STORAGE_BUFFER, shared::kTreeChangeBinding);
        program.use();
        gl::dispatch_items(faces_.face_count(), 64);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        ++bounce_count_;
        bricks_.fill(grid_, faces_, tree_, reflected_, ++bounced_, params_.bricks);
        if (!to_convergence) continue;
        const auto largest = change_.read_at<std::array<GLuint, 2>>(0);
        if (std::bit_cast<float>(largest[0]) <= params_.tolerance * std::bit_cast<float>(largest[1])) break;
    }
    return true;
}

std::vector<gl::Resource> TreeLight::resources() const
{
    std::vector<gl::Resource> all = voxelizer_.resources();
    for (const auto& part :
         {faces_.resources(), shading_.resources(), photons_.resources(), tree_.resources(), bricks_.resources()})
        all.insert(all.end(), part.begin(), part.end());
    all.push_back(reflected_.resource());
    return all;
}

std::vector<Count> TreeLight::counts() const
{
    const shared::OctreeState& counted = tree_.counts();
    std::vector<Count> all = {{"voxel size", double(grid_.voxel_size_m()), "m"},
                              {"occupied voxels", double(faces_.voxel_count()), ""},
                              {"occupied faces", double(faces_.face_count()), ""},
                              {"levels", double(tree_.depth()), ""},
                              {"nodes", double(counted.nodes), ""},
                              {"bricks", double(counted.bricks), ""},
                              {"bounces from voxel to voxel", double(bounce_count_), ""}};
    for (int level = 0; level < tree_.depth(); ++level) {
        const shared::TreeLevel& l = tree_.level(level);
        all.push_back({"nodes with geometry of level " + std::to_string(level), double(l.geometry_end - l.begin), ""});
        all.push_back({"border nodes of level " + std::to_string(level), double(l.end - l.geometry_end), ""});
    }
    return all;
}

}  // namespace conebook
