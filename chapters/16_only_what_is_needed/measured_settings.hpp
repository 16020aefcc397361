// What the settings that a plan may choose cost and bring, as measured (tools/plan_data.py), and what is to be expected of
// others.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "16_only_what_is_needed/frame_plan.hpp"

namespace conebook {

// The settings that a plan may choose, by the names of the parameters; formats by their number.
struct Choice {
    int voxels = 128, cones = 16, gather_scale = 2, bounces = -1, format = 0, shadow_map_size = 1024;
    bool operator==(const Choice&) const = default;
};
Choice choice_of(const SceneLightParams& scene, const CameraLightParams& camera);
void apply(const Choice& choice, SceneLightParams& scene, CameraLightParams& camera);
std::string text_of(const Choice& choice);  // "voxels=128 cones=16 ..."

// The fields of a Choice, for what is done with each of them.
struct ChoiceField {
    const char* name;
    int Choice::*value;
};
const std::vector<ChoiceField>& choice_fields();

struct Measured {
    Choice choice;
    double error = 0.0;                   // SMAPE of the final picture against the path tracer, blocks of 4 x 4 pixels
    std::map<std::string, double> ms;     // by pass
    std::map<std::string, Scope> scopes;  // the same passes
    std::size_t bytes = 0;
    double fragments = 0.0, faces = 0.0;
};
struct MeasuredScene {
    std::string name;  // of the file, without folder and extension
    Measured baseline;
    std::vector<Measured> alone;     // one field differs from the baseline's
    std::vector<Measured> together;  // more than one: for tests of what is expected of them
};
struct MeasuredSettings {
    glm::ivec2 size{0};  // of the pictures
    std::vector<MeasuredScene> scenes;
    // That scene, or the one that is most like it.
    const MeasuredScene& like(const std::string& name, const SceneTraits& traits) const;
};
// Throws std::runtime_error, "<file>: <fault>".
MeasuredSettings read_measured_settings(const std::filesystem::path& file);

// In ms, of passes of each scope.
struct ExpectedTimes {
    double scene_ms = 0.0, light_ms = 0.0, camera_ms = 0.0;
};

// Of settings that were measured one by one. What adds to the error is taken as independent, so squares add up; what
// takes from it, and what changes times, as factors.
double expected_error(const MeasuredScene& scene, const Choice& choice);
ExpectedTimes expected_times(const MeasuredScene& scene, const Choice& choice);
// Of the values of a field that were measured the one that is nearest by ratio.
Choice nearest_measured(const MeasuredScene& scene, const Choice& choice);

}  // namespace conebook
