// Scenes made in code with all steps of chapter 19 done. Header only.
#pragma once

#include "19_vertex_radiosity/vertex_radiosity.hpp"
#include "scene_builder.hpp"
#include "test_gl.hpp"

namespace conebook {

struct Lit {
    Lit(Scene source, const VertexRadiosityParams& params)
        : gl(test_gl()), scene(std::move(source)), p(params), gpu(scene), radiosity(gl.shaders, scene, p)
    {
        radiosity.run([](const char*, Scope, const std::function<bool()>& work) { work(); }, gpu);
    }
    std::vector<glm::vec3> irradiance(const gl::Texture& map) const
    {
        const std::vector<float> values = gl::read_floats(map, 0, 4);
        std::vector<glm::vec3> of_patches;
        for (std::size_t i = 0; i < radiosity.mesh().patches.size(); ++i)
            of_patches.emplace_back(values[4 * i], values[4 * i + 1], values[4 * i + 2]);
        return of_patches;
    }
    std::vector<glm::vec3> direct() const { return irradiance(radiosity.map().direct()); }
    std::vector<glm::vec3> indirect() const { return irradiance(radiosity.map().indirect()); }

    TestGl& gl;  // first: there must be a context
    Scene scene;
    VertexRadiosityParams p;
    GpuScene gpu;
    VertexRadiosity radiosity;
};

inline VertexRadiosityParams with(float max_edge, int bounces = 1)
{
    VertexRadiosityParams params;
    params.mesh.max_edge = max_edge;
    params.bounces = bounces;
    return params;
}

// A closed cube, its walls turned inwards.
inline SceneBuilder room(float rho, float half = 1.0f)
{
    SceneBuilder b;
    b.box(glm::vec3(-half), glm::vec3(half), b.material(lambert(rho)), true);
    return b;
}

}  // namespace conebook
