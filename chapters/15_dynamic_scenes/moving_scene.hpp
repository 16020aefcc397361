// The scene at a time: its vertices, lights and cameras moved there, on the GPU and where the CPU needs them.
#pragma once

#include "app/parameters.hpp"
#include "gl/pose_pass.hpp"

namespace conebook {

struct MotionParams {
    float time = 0.0f;  // s, 0 .. 86400: the pose of everything that moves
    bool play = true;   // in a window time goes on, over and over again
};
void add_parameters(ParameterTable& table, MotionParams& params);

// For ProgramInfo::prepare: the scene's bounds hold all poses, so that the grid and the depths of cameras and lights
// stay.
void hold_all_poses(Scene& scene);

class MovingScene {
public:
    // `scene` must outlive this; what shines is found on the CPU (chapter 11), so where anything does, its vertices
    // follow.
    MovingScene(gl::Shaders& shaders, Scene& scene);

    // Puts all that moves where it is at that time, if it is not there; says whether anything had to move.
    // `gpu_scene` was made from the same scene.
    bool run(GpuScene& gpu_scene, double time_s);

    // The scene's cameras where their nodes are at the time of the last run().
    std::vector<Camera> cameras() const { return posed_cameras(scene_, nodes_); }
    bool moves() const { return duration_s_ > 0.0; }
    double duration_s() const { return duration_s_; }  // when all begins again; 0: nothing moves
    std::vector<gl::Resource> resources() const { return pose_.resources(); }

private:
    bool move_lights(GpuScene& gpu_scene) const;
    Scene& scene_;
    PosePass pose_;
    double duration_s_;
    std::vector<NodePose> nodes_;
    MadeFrom<double> made_from_;
};

}  // namespace conebook
