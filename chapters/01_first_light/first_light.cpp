#include "01_first_light/first_light.hpp"

#include "01_first_light/forward_pass.hpp"

namespace conebook {

std::function<const gl::Texture&()> first_light(App& app, const GpuScene& scene, const DisplayParams& display)
{
    struct Passes {
        ForwardPass forward;
        ToneMapPass tone_map;
    };
    if (app.options().headless) return {};
    const auto passes = std::make_shared<Passes>(Passes{ForwardPass(app.shaders()), ToneMapPass(app.shaders())});
    return [&app, &scene, &display, passes]() -> const gl::Texture& {
        const std::optional<ForwardOutput> shown = forward_output(app.view().name);
        const gl::Texture& linear =
            passes->forward.run(scene, app.camera(), app.size(), shown.value_or(ForwardOutput::radiance));
        return passes->tone_map.run(linear, shown ? app.view().encoding : Encoding::radiance, display,
                                    data_scale(app.view(), scene.bounds()));
    };
}

}  // namespace conebook
