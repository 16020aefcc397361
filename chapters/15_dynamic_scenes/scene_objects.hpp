// Objects that the reader puts into the scene, by `objects=` and in the window: picked, dragged, given a material, made
// dynamic, removed. And a light that is brought to the camera.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/app.hpp"
#include "gl/gpu_scene.hpp"
#include "scene/objects.hpp"

namespace conebook {

struct ObjectParams {
    std::string objects;  // scene/objects.hpp has the grammar
};
void add_parameters(ParameterTable& table, ObjectParams& params);

// A ray in scene space.
struct PickRay {
    glm::dvec3 origin{0.0}, direction{0.0, 0.0, -1.0};  // m; unit
};
// Through a place of a camera's picture, 0 .. 1 from its top left corner.
PickRay ray_through(const Camera& camera, glm::dvec2 at, double aspect);

struct Picked {
    int object = -1;  // of PlacedObjects::objects()
    double distance_m = 0.0;
};
// The object that the ray meets first, if nothing else is before it. Nodes of the file are where Scene::vertices has
// them.
std::optional<Picked> pick(const Scene& scene, const PickRay& ray);

class SceneObjects {
public:
    // `params` must outlive this.
    explicit SceneObjects(ObjectParams& params) : params_(params) {}

    // For ProgramInfo::prepare: puts the objects into the scene, whose bounds then hold them.
    void place_first(Scene& scene);

    // In a window: what the reader does there from now on is taken by the next update(). Keys: arrows, Page Up and Down
    // move the object that was picked along the axes of the world; M makes it dynamic or static; Delete removes it;
    // Insert adds one; C brings the light to the camera.
    void follow_reader(App& app);

    // At the beginning of a frame: what the parameter and the reader ask for, in the app's scene and on the GPU, with
    // the revisions that passes compare. The parameter then says what there is. Throws std::runtime_error, and changes
    // nothing, where a file cannot be read. After `others` of the result, a MovingScene is to be made anew; after that
    // and after another material, what was found out about materials (traits_of).
    ObjectChanges update(App& app, GpuScene& gpu_scene);

    const std::vector<Object>& objects() const { return placed_->objects(); }

private:
    bool draw_panel(App& app);
    bool take(App& app, const InputEvent& event);
    bool take_key(App& app, int key);
    void add(App& app, const std::string& source);
    void remove(int object);

    ObjectParams& params_;
    std::optional<PlacedObjects> placed_;
    std::string text_;                           // the parameter as it was taken last
    std::vector<Object> wanted_;                 // by the reader
    int selected_ = -1, light_ = 0, shape_ = 2;  // in wanted_; of the scene's lights; of shape_names()
    std::optional<LightChoice> light_wanted_;
    struct Drag {
        glm::dvec3 grabbed, at;  // where the object was grabbed, scene space; its place then
        double depth_m;          // along the camera's axis
    };
    std::optional<Drag> drag_;
};

}  // namespace conebook
