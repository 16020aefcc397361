// The panel over a window's picture: the views, all parameters, the time of every pass.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "app/options.hpp"
#include "app/statistics.hpp"

struct GLFWwindow;

namespace conebook {

// A part of the panel that a chapter adds: widgets of Dear ImGui, and whether they have changed anything. It is drawn
// within frames too, between the slices of a pass, so what it changes is a copy, which the chapter takes when a frame
// begins.
struct PanelSection {
    std::string title;
    std::function<bool()> draw;
};

// What the panel shows.
struct PanelContents {
    const std::string& program;
    const std::string& doing;  // empty: nothing
    const std::string& fault;  // of the last change, empty: none
    const std::vector<View>& views;
    std::size_t view = 0;
    const ParameterTable& parameters;
    ParameterValues values;  // as they are wanted
    const Statistics& statistics;
    const std::vector<PanelSection>& sections;
};

// What the reader did in it.
struct PanelChanges {
    std::optional<std::size_t> view;
    std::optional<ParameterValues> values;
    bool section = false;                       // a section says so
};

// Dear ImGui has one context for all windows, so there is one panel at a time.
class Panel {
public:
    // After the window has its own callbacks: ImGui's pass on to them.
    explicit Panel(GLFWwindow* window);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    // Takes in what has happened since the last call.
    PanelChanges build(const PanelContents& contents);
    // Draws what was built into framebuffer 0.
    void draw() const;
    // Whether something that happens with the cursor there, in window units, or at the keyboard may change it.
    bool concerns(glm::dvec2 cursor) const;
    // Whether the last build found that the keyboard, or the mouse, is for it.
    bool has_keyboard() const;
    bool has_mouse() const;

private:
    glm::vec2 low_{0.0f}, high_{0.0f};  // corners, window units
};

}  // namespace conebook
