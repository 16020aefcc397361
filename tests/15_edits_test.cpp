// Any way to a scene ends in its picture, bit for bit: objects that came, went, moved, changed material and were switched
// between dynamic and static, frame by frame, against a program that begins with them.
#include "15_dynamic_scenes/scene_objects.hpp"
#include "chapter_15_frames.hpp"
#include "random_objects.hpp"

namespace conebook {
namespace {

MovingParams params_of_test()
{
    MovingParams params = MovingFrames::small();
    params.scene.bounces.warm_start = false;  // which keeps what is within the solver's tolerance of the last light
    return params;
}

// The Cornell room with objects; its grid is the room's.
class EditedFrames {
public:
    explicit EditedFrames(const std::string& text)
        : objects_(params_), frames_(asset("cornell_box"), params_of_test(), [&](Scene& scene) {
              const Bounds room = scene.bounds;
              params_.objects = text;
              objects_.place_first(scene);
              scene.bounds = room;
          })
    {
    }
    ObjectChanges edit(const std::string& text)
    {
        params_.objects = text;
        return objects_.update(frames_.app(), frames_.scene);
    }
    std::vector<float> picture()
    {
        frames_.draw();
        return frames_.pixels();
    }

private:
    ObjectParams params_;
    SceneObjects objects_;
    MovingFrames frames_;
};

TEST(Edits, AnyWayToASceneEndsInItsPicture)
{
    std::map<std::string, std::vector<float>> pictures;
    {
        EditedFrames edited("");
        RandomEdits random(15);
        std::vector<Object> objects;
        for (int i = 1; i <= 60; ++i) {
            random.edit(objects, {});
            for (Object& object : objects) {
                object.at += glm::dvec3(0.0, object.at.y < 0.0 ? 1.0 : 0.0, 0.0);
                // No more light than the lamp's: what shines is as dark as what it lights.
                if (object.material) object.material->emission = glm::min(object.material->emission, glm::vec3(1.0f));
            }
            const std::string text = text_of(objects);
            edited.edit(text);
            const std::vector<float> picture = edited.picture();
            if (i % 20 == 0) pictures[text] = picture;
        }
    }
    ASSERT_EQ(pictures.size(), 3u);
    for (const auto& [text, picture] : pictures) {
        EditedFrames fresh(text);
        EXPECT_EQ(picture, fresh.picture()) << text;
    }
}

}  // namespace
}  // namespace conebook
