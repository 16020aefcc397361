// Picking: what a click meets, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "15_dynamic_scenes/scene_objects.hpp"
#include "program.hpp"

namespace conebook {
namespace {

// A camera at `eye` that looks along -z, 90 degrees high, in a scene whose origin is the world's.
Camera camera_at(const glm::dvec3& eye)
{
    Camera camera;
    camera.world_from_camera = glm::translate(glm::mat4(1.0f), glm::vec3(eye));
    camera.y_fov = glm::radians(90.0f);
    return camera;
}

// The Cornell room with these objects; scene space is the world less (0, 1, 0).
Scene room_with(const std::string& objects)
{
    Scene scene = load_scene(asset("cornell_empty"));
    PlacedObjects(scene).set(scene, parse_objects(objects));
    return scene;
}

TEST(Picking, RaysGoThroughTheirPixels)
{
    const Camera camera = camera_at({1.0, 2.0, 3.0});
    const PickRay middle = ray_through(camera, {0.5, 0.5}, 2.0);
    EXPECT_LT(glm::distance(middle.direction, glm::dvec3(0.0, 0.0, -1.0)), 1e-12);
    EXPECT_LT(glm::distance(middle.origin, glm::dvec3(1.0, 2.0, 3.0)), 1e-12);
    // The upper right corner of a picture twice as wide as high: (2, 1, -1) before the camera.
    const PickRay corner = ray_through(camera, {1.0, 0.0}, 2.0);
    EXPECT_LT(glm::distance(corner.direction, glm::normalize(glm::dvec3(2.0, 1.0, -1.0))), 1e-7);

    Camera parallel = camera;
    parallel.orthographic = true;
    parallel.x_mag = 4.0f;
    parallel.y_mag = 2.0f;
    const PickRay side = ray_through(parallel, {0.75, 0.25}, 2.0);
    EXPECT_LT(glm::distance(side.origin, glm::dvec3(3.0, 3.0, 3.0)), 1e-7);
    EXPECT_LT(glm::distance(side.direction, glm::dvec3(0.0, 0.0, -1.0)), 1e-12);
}

TEST(Picking, MeetsWhatIsFirst)
{
    const Scene scene = room_with("cube:at=0,1,-0.5:scale=0.4+cube:at=0,1,0.3:scale=0.2+cube:at=0.6,1,0:scale=0.2");
    const PickRay ahead{{0.0, 0.0, 5.0}, {0.0, 0.0, -1.0}};
    const std::optional<Picked> near = pick(scene, ahead);
    ASSERT_TRUE(near);
    EXPECT_EQ(near->object, 1);
    EXPECT_NEAR(near->distance_m, 5.0 - 0.4, 1e-6);
    const std::optional<Picked> beside = pick(scene, {{0.15, 0.0, 5.0}, {0.0, 0.0, -1.0}});
    ASSERT_TRUE(beside);
    EXPECT_EQ(beside->object, 0);
    EXPECT_NEAR(beside->distance_m, 5.0 + 0.3, 1e-6);
}

TEST(Picking, TheFilesOwnWallsAreNoObjectsAndHideThem)
{
    const Scene scene = room_with("sphere:at=0,1,0:scale=0.4");
    EXPECT_FALSE(pick(scene, {{0.8, 0.0, 5.0}, {0.0, 0.0, -1.0}}));  // the back wall
    EXPECT_FALSE(pick(scene, {{0.0, 0.0, -5.0}, {0.0, 0.0, 1.0}}));  // the sphere is behind the wall
    EXPECT_FALSE(pick(scene, {{0.0, 0.0, 5.0}, {0.0, 0.0, 1.0}}));   // behind the ray
    EXPECT_TRUE(pick(scene, {{0.0, 0.0, 5.0}, {0.0, 0.0, -1.0}}));
}

}  // namespace
}  // namespace conebook
