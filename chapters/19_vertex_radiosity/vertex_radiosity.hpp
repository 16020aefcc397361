// All of it, step by step: the lights light the patches, some patches become lights, and some of those that these
// light again.
#pragma once

#include <functional>
#include <optional>

#include "19_vertex_radiosity/further_lights.hpp"
#include "19_vertex_radiosity/sight.hpp"
#include "app/app.hpp"

namespace conebook {

struct VertexRadiosityParams {
    PatchMeshParams mesh;
    PickParams pick;
    FurtherLightParams further;
    // Indirect bounces, -1: all. 0 lights the patches directly (step 1), 1 adds light of the patches picked and of
    // emissive surfaces (step 2), 2 that of what their rays meet (step 3), and further bounces go on like that.
    int bounces = -1;
    // The document's number of steps, 1 .. 3; 0: as `bounces` asks.
    int steps = 0;
    // Of a patch nearer to a light than this, in roots of the light's area, 0 .. 100, the texels of the light's cell
    // light it in smaller groups: a disc is exact on its axis and from far away alone. 0: never, as in the document.
    float near = 4.0f;
    FormFactor form_factor = FormFactor::exact;
    // Off: patches are drawn at the corners of the map's texels and read from their middles, as in the document.
    bool half_texel = true;
};
void add_parameters(ParameterTable& table, VertexRadiosityParams& params);
// The one place where steps become bounces; -1: all.
int asked_bounces(const VertexRadiosityParams& params);

class VertexRadiosity {
public:
    // `source` and `params` must outlive this.
    VertexRadiosity(gl::Shaders& shaders, const Scene& source, const VertexRadiosityParams& params);

    // Does what has changed. Throws as subdivide and check do.
    void run(App& app, const GpuScene& scene);
    // The same without an App: pass(name, scope, work), work saying whether there was anything to do.
    using RunPass = std::function<void(const char*, Scope, const std::function<bool()>&)>;
    void run(const RunPass& pass, const GpuScene& scene);

    const PatchMesh& mesh() const { return mesh_; }
    const PatchBuffers& buffers() const { return buffers_; }
    const RadiosityMap& map() const { return map_; }
    const SceneTracer& tracer() const { return *tracer_; }
    const std::vector<LightView>& views() const { return views_; }
    const std::vector<PickedLight>& second() const { return second_; }  // lights of step 2
    const std::vector<PickedLight>& third() const { return third_; }    // and of step 3, bounce by bounce
    std::size_t third_at_once() const { return third_at_once_; }        // of `third`, those of bounce 2
    int cells() const { return cells_; }                                // of each view
    // Draws a view again, for those who want to see it; none when there are no views.
    const LightPicker* look(const GpuScene& scene, int view);
    // Changes whenever the light does.
    Revision revision() const { return indirect_revision_; }

    std::vector<gl::Resource> resources() const;
    std::vector<Count> counts() const;
    std::vector<Need> needs() const;

private:
    bool mesh_step();
    bool direct_step(const GpuScene& scene);
    bool pick_step(const GpuScene& scene);
    int rays() const;  // of each light of step 2
    bool ray_step();
    bool indirect_step();

    const Scene& source_;
    const VertexRadiosityParams& params_;
    std::optional<SceneTracer> tracer_;  // made when first asked for
    PatchMesh mesh_;
    PatchBuffers buffers_;
    RadiosityMap map_;
    LightPicker picker_;
    std::vector<LightView> views_;
    std::vector<PickedLight> second_, third_;
    std::size_t third_at_once_ = 0;
    glm::dvec3 reflected_{0.0};  // W
    int cells_ = 0;
    MadeFrom<float> mesh_of_;
    MadeFrom<Revision, Revision, bool> direct_of_;
    MadeFrom<Revision, PickParams, int, bool, bool> second_of_;
    MadeFrom<Revision, FurtherLightParams, int> third_of_;
    MadeFrom<Revision, Revision, float, FormFactor, bool> indirect_of_;
    Revision mesh_revision_ = 0, direct_revision_ = 0, second_revision_ = 0, third_revision_ = 0,
             indirect_revision_ = 0;
};

}  // namespace conebook
