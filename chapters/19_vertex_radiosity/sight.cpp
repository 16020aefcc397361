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

// `sees(point, normal, light)` for every pair.
template <typename Sees>
std::vector<std::uint32_t> bits_of(const SceneTracer& tracer, const std::vector<shared::Patch>& patches,
                                   std::size_t light_count, const Sees& sees)
{
    const std::size_t words = (light_count + 31) / 32;
    std::vector<std::uint32_t> bits(words * patches.size(), 0u);
    constexpr std::size_t kBlock = 64;  // patches that a thread takes at once
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t first; (first = next.fetch_add(kBlock)) < patches.size();)
            for (std::size_t i = first; i < std::min(first + kBlock, patches.size()); ++i) {
                if (patches[i].position.w <= 0.0f) continue;
                const glm::vec3 point = above(tracer, patches[i].position, patches[i].normal);
                for (std::size_t light = 0; light < light_count; ++light)
                    if (sees(point, glm::vec3(patches[i].normal), light))
                        bits[light / 32 * patches.size() + i] |= 1u << (light % 32);
            }
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
    return bits_of(tracer, patches, lights.size(), [&](const glm::vec3& point, const glm::vec3& normal, std::size_t i) {
        const Light& light = lights[i];
        const bool parallel = light.type == LightType::directional;
        const glm::vec3 to = parallel ? point - beyond * light.direction : light.position;
        return glm::dot(to - point, normal) > 0.0f && !tracer.occluded(point, to);
    });
}

std::vector<std::uint32_t> sight_of(const SceneTracer& tracer, const std::vector<shared::Patch>& patches,
                                    const std::vector<shared::PatchLight>& lights)
{
    // snippet: sees
    return bits_of(tracer, patches, lights.size(), [&](const glm::vec3& point, const glm::vec3& normal, std::size_t i) {
        const glm::vec3 to = above(tracer, lights[i].position, lights[i].normal), way = to - point;
        return glm::dot(way, normal) > 0.0f && glm::dot(way, glm::vec3(lights[i].normal)) < 0.0f &&
               !tracer.occluded(point, to);
    });
    // end snippet
}

}  // namespace conebook
