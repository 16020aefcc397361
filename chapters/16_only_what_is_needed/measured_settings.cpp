#include "16_only_what_is_needed/measured_settings.hpp"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace conebook {

namespace {

constexpr const char* kFormatNames[] = {"rgba16f", "rgba8", "r11g11b10f"};

int number_of(const std::string& name, const std::string& text)
{
    if (name != "format") return std::stoi(text);
    for (int i = 0; i < 3; ++i)
        if (text == kFormatNames[i]) return i;
    throw std::runtime_error("no format " + text);
}

Choice choice_of(const nlohmann::json& set, Choice choice)
{
    for (const auto& [name, value] : set.items()) {
        bool known = false;
        for (const ChoiceField& field : choice_fields())
            if (name == field.name) {
                choice.*field.value = number_of(name, value.get<std::string>());
                known = true;
            }
        if (!known) throw std::runtime_error("no setting " + name);
    }
    return choice;
}

Measured measured_of(const nlohmann::json& row, const Choice& baseline)
{
    Measured measured;
    measured.choice = choice_of(row.at("set"), baseline);
    measured.error = row.at("error");
    measured.bytes = row.at("bytes");
    measured.faces = row.at("counts").at("occupied faces");
    measured.fragments = row.at("counts").at("fragments");
    for (const auto& [pass, ms] : row.at("ms").items()) measured.ms[pass] = ms;
    for (const auto& [pass, scope] : row.at("scopes").items())
        measured.scopes[pass] = scope == "scene" ? Scope::scene : scope == "light" ? Scope::light : Scope::camera;
    return measured;
}

// For each field that differs from the baseline's: what was measured with that value alone.
template <typename Use>
void for_each_difference(const MeasuredScene& scene, const Choice& choice, Use use)
{
    for (const ChoiceField& field : choice_fields())
        for (const Measured& row : scene.alone)
            if (row.choice.*field.value != scene.baseline.choice.*field.value &&
                row.choice.*field.value == choice.*field.value)
                use(row);
}

}  // namespace

const std::vector<ChoiceField>& choice_fields()
{
    static const std::vector<ChoiceField> fields = {
        {"voxels", &Choice::voxels},   {"cones", &Choice::cones},   {"gather_scale", &Choice::gather_scale},
        {"bounces", &Choice::bounces}, {"format", &Choice::format}, {"shadow_map_size", &Choice::shadow_map_size}};
    return fields;
}

Choice choice_of(const SceneLightParams& scene, const CameraLightParams& camera)
{
    return {scene.voxels.grid.voxels,         camera.cones.cones,
            camera.diffuse.gather_scale,      scene.bounces.bounces,
            int(scene.voxels.pyramid.format), scene.shadow_maps.shadow_map_size};
}

void apply(const Choice& choice, SceneLightParams& scene, CameraLightParams& camera)
{
    scene.voxels.grid.voxels = choice.voxels;
    scene.bounces.bounces = choice.bounces;
    scene.voxels.pyramid.format = LightFormat(choice.format);
    scene.shadow_maps.shadow_map_size = choice.shadow_map_size;
    camera.cones.cones = choice.cones;
    camera.diffuse.gather_scale = choice.gather_scale;
}

std::string text_of(const Choice& choice)
{
    std::ostringstream out;
    for (const ChoiceField& field : choice_fields()) {
        out << (out.tellp() > 0 ? " " : "") << field.name << "=";
        if (field.value == &Choice::format)
            out << kFormatNames[choice.format];
        else
            out << choice.*field.value;
    }
    return out.str();
}

MeasuredSettings read_measured_settings(const std::filesystem::path& file)
{
    try {
        std::ifstream in(file);
        if (!in) throw std::runtime_error("cannot be read");
        const nlohmann::json json = nlohmann::json::parse(in);
        MeasuredSettings all;
        all.size = {json.at("size").at(0), json.at("size").at(1)};
        const Choice baseline = choice_of(json.at("baseline"), {});
        for (const auto& entry : json.at("scenes")) {
            MeasuredScene scene;
            scene.name = entry.at("name");
            for (const auto& row : entry.at("rows")) {
                const Measured measured = measured_of(row, baseline);
                if (measured.choice == baseline)
                    scene.baseline = measured;
                else
                    (row.at("together") ? scene.together : scene.alone).push_back(measured);
            }
            if (scene.baseline.ms.empty()) throw std::runtime_error("no baseline of " + scene.name);
            all.scenes.push_back(scene);
        }
        if (all.scenes.empty()) throw std::runtime_error("no scenes");
        return all;
    } catch (const std::exception& error) {
        const std::string fault = error.what();
        throw std::runtime_error(file.string() + ": " + fault.substr(0, fault.find('\n')) +
                                 "; tools/plan_data.py measures it again");
    }
}

const MeasuredScene& MeasuredSettings::like(const std::string& name, const SceneTraits& traits) const
{
    const MeasuredScene* most_alike = nullptr;
    int most = -1;
    for (const MeasuredScene& scene : scenes) {
        if (scene.name == name) return scene;
        const auto runs = [&](const char* pass) { return scene.baseline.ms.contains(pass); };
        // Emitters matter most, for they decide what the rays are aimed at; of the rest the less simple scene.
        const int alike = 4 * int(runs("emitters' light") == traits.shines) +
                          2 * int(runs("specular cones") == traits.specular_cones.used) +
                          int(runs("shadow maps") == traits.has_lights);
        if (alike > most || (alike == most && scene.baseline.error > most_alike->baseline.error)) {
            most = alike;
            most_alike = &scene;
        }
    }
    return *most_alike;
}

// snippet: expected_error
double expected_error(const MeasuredScene& scene, const Choice& choice)
{
    const double base = scene.baseline.error * scene.baseline.error;
    double less = 1.0, more = 0.0;
    for_each_difference(scene, choice, [&](const Measured& row) {
        const double square = row.error * row.error;
        (square < base ? less : more) = square < base ? less * square / base : more + square - base;
    });
    return std::sqrt(base * less + more);
}
// end snippet

ExpectedTimes expected_times(const MeasuredScene& scene, const Choice& choice)
{
    ExpectedTimes times;
    for (const auto& [pass, base_ms] : scene.baseline.ms) {
        double ms = base_ms;
        for_each_difference(scene, choice, [&](const Measured& row) {
            const auto found = row.ms.find(pass);
            ms *= base_ms > 0.0 ? (found != row.ms.end() ? found->second : 0.0) / base_ms : 1.0;
        });
        const Scope scope = scene.baseline.scopes.at(pass);
        (scope == Scope::scene ? times.scene_ms : scope == Scope::light ? times.light_ms : times.camera_ms) += ms;
    }
    return times;
}

Choice nearest_measured(const MeasuredScene& scene, const Choice& choice)
{
    Choice nearest = choice;
    for (const ChoiceField& field : choice_fields()) {
        const int wanted = choice.*field.value;
        int best = scene.baseline.choice.*field.value;
        const auto distance = [&](int value) {
            // All bounces are many.
            const auto scaled = [](int v) { return std::log(v < 0 ? 16.0 : v + 0.5); };
            return std::abs(scaled(value) - scaled(wanted));
        };
        for (const Measured& row : scene.alone)
            if (distance(row.choice.*field.value) < distance(best)) best = row.choice.*field.value;
        nearest.*field.value = best;
    }
    return nearest;
}

}  // namespace conebook
