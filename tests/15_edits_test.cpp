// Any way to a scene ends in its picture: objects that came, went, moved, changed material and were switched between dynamic
// and static, frame by frame, against a program that begins with them.
#include <cmath>

#include "15_dynamic_scenes/scene_objects.hpp"
#include "chapter_15_frames.hpp"
#include "random_objects.hpp"

namespace conebook {
namespace {

MovingParams params_of_test()
{
    MovingParams params = MovingFrames::small();
    params.scene.bounces.warm_start = true;
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
    std::map<std::string, int> draw() { return frames_.draw(); }

private:
    ObjectParams params_;
    SceneObjects objects_;
    MovingFrames frames_;
};

// Largest difference of a value, over the mean of all.
double difference(const std::vector<float>& a, const std::vector<float>& b)
{
    double sum = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += double(b[i]);
        largest = std::max(largest, std::abs(double(a[i]) - double(b[i])));
    }
    return largest / (sum / double(a.size()));
}

TEST(Edits, AnyWayToASceneEndsInItsPicture)
{
    std::map<std::string, std::vector<float>> pictures;
    {
        EditedFrames edited("");
        RandomEdits random(15);
        std::vector<Object> objects;
        for (int i = 1; i <= 200; ++i) {
            random.edit(objects, {});
            for (Object& object : objects) {
                object.at += glm::dvec3(0.0, object.at.y < 0.0 ? 1.0 : 0.0, 0.0);
                // No more light than the lamp's: what shines is as dark as what it lights.
                if (object.material) object.material->emission = glm::min(object.material->emission, glm::vec3(1.0f));
            }
            const std::string text = text_of(objects);
            edited.edit(text);
            const std::vector<float> picture = edited.picture();
            if (i % 50 == 0) pictures[text] = picture;
        }
    }
    ASSERT_EQ(pictures.size(), 4u);
    for (const auto& [text, picture] : pictures) {
        EditedFrames fresh(text);
        const double apart = difference(picture, fresh.picture());
        RecordProperty("difference", std::to_string(apart));
        EXPECT_LT(apart, 0.01) << text;
    }
}

}  // namespace
}  // namespace conebook
