// Closed rooms cut into patches, and rows of their form factors by any method. Header only.
#pragma once

#include <functional>

#include "20_form_factor_radiosity/radiosity.hpp"
#include "scene_builder.hpp"
#include "test_gl.hpp"

namespace conebook {

// A scene, its patches, and rows by any method.
struct Rig {
    Scene scene;
    SceneTracer tracer;
    Patches patches;
    Hemicubes hemicubes;

    Rig(Scene source, const PatchParams& params)
        : scene(std::move(source)),
          tracer(scene),
          patches(make_patches(tracer, params, scene.lights)),
          hemicubes(test_gl().shaders, scene)
    {
        patches.light(scene.lights);
    }

    FormFactors factors(FormFactorParams params)
    {
        return params.form_factors == int(FormFactorMethod::embree) ? trace_form_factors(patches, params)
                                                                    : render_form_factors(hemicubes, patches, params);
    }

    // Mean over the patches of draw a of their form factors to draw b, weighted by area.
    double between(const FormFactors& factors, std::uint32_t a, std::uint32_t b) const
    {
        double sum = 0.0, area = 0.0;
        for (std::size_t i = 0; i < patches.size(); ++i) {
            if (patches[i].draw != a) continue;
            area += double(patches[i].area);
            for (const FormFactorEntry& f : factors.rows[i].direct)
                if (patches[f.patch].draw == b) sum += double(patches[i].area) * double(f.share);
        }
        return sum / area;
    }
};

inline PatchParams even(int patches)
{
    PatchParams params;
    params.patches = patches;
    params.adaptive = false;
    return params;
}

inline FormFactorParams by(FormFactorMethod method)
{
    FormFactorParams params;
    params.form_factors = int(method);
    params.samples = 4;
    params.rays = 1024;
    return params;
}

inline constexpr FormFactorMethod kMethods[] = {FormFactorMethod::hemicube, FormFactorMethod::embree,
                                                FormFactorMethod::hybrid};

// Unit cube seen from inside, a draw a face: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z.
inline SceneBuilder cube(const std::function<Material(int)>& material_of)
{
    SceneBuilder b;
    for (int face = 0; face < 6; ++face) b.box_face({0, 0, 0}, {1, 1, 1}, face, b.material(material_of(face)), true);
    return b;
}
inline SceneBuilder grey_cube()
{
    return cube([](int) { return lambert(0.5f); });
}

inline double row_sum(const FormFactorRow& row)
{
    double sum = 0.0;
    for (const FormFactorEntry& f : row.direct) sum += double(f.share);
    return sum;
}

// A room with a lamp, a mirror and walls of several greys.
inline SceneBuilder room_with_mirror()
{
    return cube([](int face) {
        if (face == 0) return metal(glm::vec3(0.8f), 0.0f);
        if (face == 3) return emitter(glm::vec3(2.0f), 0.3f);
        return lambert(0.15f + 0.15f * float(face));
    });
}

}  // namespace conebook
