// What a run cost and why: times a pass, bytes a resource, what the scene needed.
#pragma once

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "gl/handles.hpp"

namespace conebook {

// Something that a scene may need or not (a shadow map, specular cones, ...), and why: what the program did, not what
// it could have done.
struct Need {
    std::string name;
    bool used = false;
    std::string reason;
};

// A counted quantity, such as occupied voxels.
struct Count {
    std::string name;
    double value = 0.0;
    std::string unit;
};

// A part of a frame that was planned: what it took, and why it is there, or why not.
struct PlanLine {
    std::string kind;  // volume, pass, choice
    std::string name;
    bool used = false;
    std::size_t bytes = 0;
    double milliseconds = 0.0;
    std::string reason;
};

// What the result of a pass depends on: the geometry and materials of the scene; its lights too; the camera too.
enum class Scope { scene, light, camera };
const char* scope_name(Scope scope);

struct PassTime {
    std::string pass;
    Scope scope = Scope::camera;
    double milliseconds = 0.0;
};

class Statistics {
public:
    void add_time(const std::string& pass, Scope scope, double milliseconds);
    // Of each pass the last time, in the order in which they first ran.
    std::vector<PassTime> last_times() const;
    // What was never made has no bytes and is left out.
    void add_resources(const std::vector<gl::Resource>& resources)
    {
        std::copy_if(resources.begin(), resources.end(), std::back_inserter(resources_),
                     [](const gl::Resource& resource) { return resource.bytes > 0; });
    }
    void add_needs(const std::vector<Need>& needs) { needs_.insert(needs_.end(), needs.begin(), needs.end()); }
    void set_plan(std::vector<PlanLine> plan) { plan_ = std::move(plan); }
    void set_counts(std::vector<Count> counts) { counts_ = std::move(counts); }
    void set_run(std::string program, std::string driver, glm::ivec2 size)
    {
        program_ = std::move(program);
        driver_ = std::move(driver);
        size_ = size;
    }
    void write_json(const std::filesystem::path& file) const;  // throws std::runtime_error
    std::string table() const;

private:
    std::vector<std::string> pass_order_;
    struct Pass {
        Scope scope = Scope::camera;
        std::vector<double> times_ms;  // of each time that it ran
    };
    std::map<std::string, Pass> passes_;
    std::vector<gl::Resource> resources_;
    std::vector<Need> needs_;
    std::vector<Count> counts_;
    std::vector<PlanLine> plan_;
    std::string program_, driver_;
    glm::ivec2 size_{0};
};

}  // namespace conebook
