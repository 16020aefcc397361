#include "16_only_what_is_needed/plan_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace conebook {

namespace {

// What belongs to one decision: names of passes and resources in the statistics.
struct Part {
    const char* kind;
    Need need;
    std::vector<std::string> passes, resources;
};

std::vector<Part> parts_of(const LightPlan& plan, const SceneLight& light)
{
    const Need emitters = light.emitters().need();
    const auto with_emitters = [&](const char* name, const Need& other) {
        const bool apart = plan.pyramid.used && light.emitters().are_apart();
        return Need{name, apart && other.used, !other.used ? other.reason : emitters.reason};
    };
    const Need always{"g-buffer", true, "the surfaces that the camera sees"};
    const Need sum{"sum", true, "of what there is"};
    return {
        {"volume", plan.shadow_maps, {"shadow maps"}, {"shadow maps"}},
        {"volume",
         plan.voxels,
         {"voxelize", "average", "voxel shading"},
         {"occupancy", "fragments", "large triangles", "face index", "voxel list", "face list", "face sums", "faces",
          "block counts", "face radiance", "face visibility"}},
        {"volume", {"walk volume", plan.pyramid.used, plan.pyramid.reason}, {"walk volume"}, {"walk volume"}},
        {"volume",
         with_emitters("emission pyramid", plan.pyramid),
         {"emitters"},
         {"emission pyramid", "emitter parts", "emitter triangles"}},
        {"volume",
         plan.further_bounces,
         {"coverage of voxels", "links", "further bounces"},
         {"links", "from emitters", "reflectance of faces", "radiance of faces between bounces", "reflected by faces"}},
        {"volume",
         plan.pyramid,
         {"light pyramid"},
         {"light pyramid", "coverage pyramid", "occupied voxels of all levels"}},
        {"volume", plan.visibility_volume, {"visibility volume"}, {"visibility volume"}},
        {"pass",
         always,
         {"g-buffer"},
         {"g-buffer depth", "g-buffer normal", "g-buffer geometric normal", "g-buffer base colour, metallic",
          "g-buffer f0, f90", "g-buffer emission, roughness"}},
        {"pass", plan.direct_light, {"direct light"}, {"softly shadowed light"}},
        {"pass",
         plan.diffuse_cones,
         {"diffuse cones"},
         {"points", "gathered light", "indirect diffuse light", "filtered along rows", "filtered light"}},
        {"pass",
         with_emitters("emitters' light", plan.diffuse_cones),
         {"emitters' light"},
         {"light arriving from emitters", "light of emitters, unshadowed", "indirect diffuse and emitters' light"}},
        {"pass",
         plan.specular_cones,
         {"specular cones"},
         {"light in the lobe", "specular light", "directional albedo"}},
        {"pass", sum, {"composite"}, {"mean of frames"}},
    };
}

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

// Which of the six directions have faces.
PlanLine directions_line(const SceneLight& light)
{
    const auto faces = light.voxels().faces().face_list().read<GLuint>();
    int held = 0;
    for (std::size_t i = 0; i < std::min(faces.size(), light.voxels().faces().face_count()); ++i)
        held |= 1 << (faces[i] >> 27);
    int count = 0;
    for (; held != 0; held &= held - 1) ++count;
    return {"choice", "directions", true, 0, 0.0, std::to_string(count) + " of 6 have faces"};
}

}  // namespace

std::vector<PlanLine> plan_lines(const LightPlan& plan, const SceneLight& scene_light, const CameraLight& camera_light,
                                 const SceneLightParams& scene_params, const CameraLightParams& camera_params, App& app)
{
    std::vector<gl::Resource> resources = scene_light.resources();
    for (const gl::Resource& resource : camera_light.resources()) resources.push_back(resource);
    std::vector<PlanLine> lines;
    for (const Part& part : parts_of(plan, scene_light)) {
        PlanLine line{part.kind, part.need.name, part.need.used, 0, 0.0, part.need.reason};
        for (const std::string& name : part.resources)
            for (gl::Resource& resource : resources)
                if (resource.name == name) line.bytes += std::exchange(resource.bytes, 0);
        for (const PassTime& pass : app.statistics().last_times())
            if (std::find(part.passes.begin(), part.passes.end(), pass.pass) != part.passes.end())
                line.milliseconds += pass.milliseconds;
        lines.push_back(line);
    }

    const VoxelGrid& grid = scene_light.voxels().grid();
    const auto choice = [&](const char* name, bool used, std::size_t bytes, const std::string& reason) {
        lines.push_back({"choice", name, used, bytes, 0.0, reason});
    };
    constexpr const char* kFormats[] = {"rgba16f, 8 bytes", "rgba8, 4 bytes", "r11g11b10f and r8, 5 bytes"};
    const int format = int(scene_params.voxels.pyramid.format);
    choice("format", plan.pyramid.used, 0, std::string(kFormats[format]) + " a texel of a pyramid");
    if (plan.voxels.used) lines.push_back(directions_line(scene_light));
    choice("levels", plan.pyramid.used, 0,
           std::to_string(grid.levels()) + " of the pyramids, all but the finest a seventh of its bytes");
    const glm::ivec3 size = grid.size();
    choice("voxels", plan.voxels.used, 0,
           std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z) + " of " +
               number(grid.voxel_size_m()) + " m");
    const bool shared = camera_params.cones.interleave == Interleave::on;
    const int scale = shared ? camera_params.diffuse.gather_scale : 1;
    choice("resolution", plan.diffuse_cones.used, 0,
           "one of " + std::to_string(scale * scale) + " pixels gathers, by " +
               std::to_string(camera_params.cones.cones) + " cones");
    choice("programs", true, 0, std::to_string(app.shaders().program_count()) + " made, each at its first use");
    return lines;
}

std::vector<PlanLine> demand_lines(const ChosenSettings& chosen)
{
    if (!chosen.expectation()) return {};
    const Expectation& e = *chosen.expectation();
    return {
        {"demand", "chosen", true, std::size_t(e.memory_mb * 1e6), e.time_ms, text_of(e.choice)},
        {"demand", "expected error", true, 0, 0.0, number(e.error) + ", as measured in " + chosen.measured_scene()}};
}

PlanLine brick_line(const std::vector<gl::Resource>& resources)
{
    PlanLine line{"volume", "index of bricks", true, 0, 0.0, "storage=bricks"};
    for (const gl::Resource& resource : resources) line.bytes += resource.bytes;
    return line;
}

std::vector<Count> plan_counts(const std::vector<PlanLine>& lines, App& app)
{
    double bytes = 0.0;
    for (const PlanLine& line : lines)
        if (line.kind != "demand") bytes += double(line.bytes);
    return {{"passes that ran", double(app.statistics().last_times().size()), ""},
            {"programs", double(app.shaders().program_count()), ""},
            {"memory of the frame", bytes * 1e-6, "MB"}};
}

std::string plan_text(const std::vector<PlanLine>& lines)
{
    std::string out = "plan                                    MB         ms  reason\n";
    std::size_t bytes = 0;
    double milliseconds = 0.0;
    char row[256];
    for (const PlanLine& line : lines) {
        std::snprintf(row, sizeof row, "%-7s %-19s %-8s %7.2f %10.2f  %s\n", line.kind.c_str(), line.name.c_str(),
                      line.used ? "" : "left out", double(line.bytes) * 1e-6, line.milliseconds, line.reason.c_str());
        out += row;
        if (line.kind == "demand") continue;  // no part of the frame
        bytes += line.bytes;
        milliseconds += line.milliseconds;
    }
    std::snprintf(row, sizeof row, "%-36s %7.2f %10.2f\n", "sum", double(bytes) * 1e-6, milliseconds);
    return out + row;
}

}  // namespace conebook
