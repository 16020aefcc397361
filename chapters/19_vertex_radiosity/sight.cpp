#include "19_vertex_radiosity/sight.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

namespace conebook {
namespace {

// A point that is off its surface by what the rays' own rounding asks for.
glm::vec3 above(const SceneTracer& tracer, const glm::vec4& position, const glm::vec4& normal)
{
    return glm::vec3(position) + tracer.surface_offset() * glm::vec3(normal);
}

// `look(point, normal, see)` for every patch with area; see(light) sets a bit.
template <typename Look>
std::vector<std::uint32_t> bits_of(const SceneTracer& tracer, const std::vector<shared::Patch>& patches,
                                   std::size_t light_count, const Look& look)
{
    std::vector<std::uint32_t> bits((light_count + 31) / 32 * patches.size(), 0u);
    constexpr std::size_t kBlock = 64;  // patches that a thread takes at once
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t first; (first = next.fetch_add(kBlock)) < patches.size();)
            for (std::size_t i = first; i < std::min(first + kBlock, patches.size()); ++i)
                if (patches[i].position.w > 0.0f)
                    look(above(tracer, patches[i].position, patches[i].normal), glm::vec3(patches[i].normal),
                         [&](std::size_t light) { bits[light / 32 * patches.size() + i] |= 1u << (light % 32); });
    };
    {
        std::vector<std::jthread> others;
        for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) others.emplace_back(work);
        work();
    }  // all have ended
    return bits;
}

}  // namespace

std::vector<std::uint32_t> sight_of(const SceneTracer& tracer, const std::vector<shared::Patch>& patches,
                                    const std::vector<Light>& lights)
{
    const float beyond = 4.0f * glm::length(tracer.scene().bounds.extent());  // m, outside from any point inside
    const auto look = [&](const glm::vec3& point, const glm::vec3& normal, const auto& see) {
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const bool parallel = lights[i].type == LightType::directional;
            const glm::vec3 to = parallel ? point - beyond * lights[i].direction : lights[i].position;
            if (glm::dot(to - point, normal) > 0.0f && !tracer.occluded(point, to)) see(i);
        }
    };
    return bits_of(tracer, patches, lights.size(), look);
}

std::vector<std::uint32_t> sight_of(const SceneTracer& tracer, const std::vector<shared::Patch>& patches,
                                    std::span<const LightNode> lights, float near)
{
    const auto look = [&](const glm::vec3& point, const glm::vec3& normal, const auto& see) {
        // snippet: sees
        const auto ask = [&](const auto& self, std::size_t i) -> void {
            const LightNode& node = lights[i];
            const glm::vec3 to = above(tracer, node.light.position, node.light.normal), way = to - point;
            if (node.part_count > 0 && glm::dot(way, way) < near * near * node.light.position.w) {
                for (std::size_t k = 0; k < node.part_count; ++k) self(self, node.first_part + k);
                return;
            }
            const bool face_to_face =
                glm::dot(way, normal) > 0.0f && glm::dot(way, glm::vec3(node.light.normal)) < 0.0f;
            if (face_to_face && !tracer.occluded(point, to)) see(i);
        };
        // end snippet
        for (std::size_t i = 0; i < lights.size(); ++i)
            if (lights[i].is_root) ask(ask, i);
    };
    return bits_of(tracer, patches, lights.size(), look);
}

}  // namespace conebook
