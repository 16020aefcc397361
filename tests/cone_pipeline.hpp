// A scene made in code and what its cones gather: chapters 02 to 09 without a program around them. Header only.
//
//     ConePipeline pipeline(scene, camera, {128, 128}, 64);
//     const ImageF gathered = pipeline.gathered(cone_params);                    // E / pi
//     pipeline.look(other_camera);                                               // the same voxels
//     const ImageF reflected = pipeline.reflected(cone_params, specular_params); // radiance
#pragma once

#include <algorithm>
#include <cmath>

#include "09_specular_cones/specular_cones.hpp"
#include "image/image.hpp"
#include "lit_scene.hpp"
#include "scene_builder.hpp"

namespace conebook {

class ConePipeline {
public:
    ConePipeline(const Scene& scene, const Camera& camera, glm::ivec2 size, int voxels)
        : lit_(scene, voxels),
          g_buffer_(test_gl().shaders, size),
          walk_(test_gl().shaders),
          diffuse_(test_gl().shaders),
          specular_(test_gl().shaders)
    {
        walk_.run(lit_.grid, lit_.faces);
        look(camera);
    }

    void look(const Camera& camera)
    {
        g_buffer_.draw(lit_.scene, camera_data(camera, g_buffer_.size(), lit_.scene.bounds()));
    }

    // rgb: E / pi, the cosine-weighted mean radiance over the hemisphere, W/(sr m^2); a: ambient.
    ImageF gathered(const ConeParams& params, const DiffuseConeParams& diffuse_params = {}, int sample = 0)
    {
        ConeDirections directions;
        directions.update(params, sample);
        return read_picture(diffuse_.run(g_buffer_, volumes(), directions, params, diffuse_params, sample));
    }
    // rgb: radiance towards the camera, W/(sr m^2).
    ImageF reflected(const ConeParams& params, const SpecularConeParams& specular_params = {})
    {
        return read_picture(specular_.run(g_buffer_, volumes(), params, specular_params));
    }
    double voxel_size_m() const { return double(lit_.grid.voxel_size_m()); }
    ConeVolumes volumes() const { return {lit_.grid, lit_.pyramid, walk_}; }

private:
    LitScene lit_;
    GBuffer g_buffer_;
    WalkVolume walk_;
    DiffuseCones diffuse_;
    SpecularCones specular_;
};

// Of one channel, over all pixels.
struct Spread {
    double mean = 0.0, deviation = 0.0, low = INFINITY, high = -INFINITY;
};
inline Spread spread_of(const ImageF& image, int channel = 0)
{
    Spread s;
    double squares = 0.0;
    for (const glm::vec4& pixel : image.pixels) {
        const double v = double(pixel[channel]);
        s.mean += v;
        squares += v * v;
        s.low = std::min(s.low, v);
        s.high = std::max(s.high, v);
    }
    const auto count = double(image.pixels.size());
    s.mean /= count;
    s.deviation = std::sqrt(std::max(0.0, squares / count - s.mean * s.mean));
    return s;
}

// Looks at one point: 0.1 degrees wide, so that all pixels show the same place.
inline Camera at_point(const glm::vec3& eye, const glm::vec3& point) { return look_at(eye, point, 0.0017f); }

}  // namespace conebook
