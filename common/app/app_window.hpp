// What App keeps of its window; for app.cpp and app_window.cpp alone.
#pragma once

#include <fstream>
#include <optional>

#include "app/app.hpp"
#include "app/panel.hpp"
#include "app/window.hpp"
#include "app/window_resolution.hpp"

namespace conebook {

struct App::Window {
    enum class Doing { preparing, showing_meanwhile, drawing };
    Window(GLFWwindow* window, const Camera& camera, const Bounds& bounds, int first_divisor)
        : input(window, camera, bounds), resolution(first_divisor)
    {
    }

    WindowInput input;
    std::optional<Panel> panel;  // with `follows` alone
    std::vector<PanelSection> sections;
    std::string doing_text;            // as the title says it
    std::string fault;                 // of the last change of parameters
    std::optional<ParameterValues> drawn_values;  // of the last picture that was finished
    bool values_changed = false;       // since then
    WindowResolution resolution;
    bool follows = true;        // frames follow the reader; not with --frames, where each is whole and is finished
    int meanwhile_divisor = 1;  // of what show_meanwhile draws
    std::function<const gl::Texture&()> meanwhile;  // until the first frame is done
    Doing doing = Doing::preparing;
    glm::ivec2 size{0};       // of the window, in pixels, as the picture has it
    bool may_give_up = true;  // not while a pass works whose result later frames use
    bool worked = false;      // in this frame a pass has made something that stays
    bool whole = false;       // the last picture is one of all pixels, and its textures are as they were shown
    bool closing = false;     // was asked for
    bool last = false;        // this frame is the last one: the whole picture for --output
    bool screenshot = false;  // is to be written as soon as a picture is whole
    int screenshots = 0;      // written so far
    int changes = 0;          // requests that changed what is to be seen
    double frame_start_s = 0.0;
    double not_for_camera_s = 0.0;  // in this frame
    double title_s = 0.0;           // when the title was last set
    std::ofstream trace;            // --trace-frames
};

}  // namespace conebook
