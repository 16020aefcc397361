#include "app/panel.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace conebook {

namespace {

constexpr float kFontPixels = 13.0f;  // of ImGui's own font, at a scale of 1
constexpr std::size_t kLongestText = 4095;

// An entry of a list of words, if another one is chosen.
std::optional<std::size_t> choose(const char* id, const std::vector<std::string>& words, std::size_t now)
{
    std::optional<std::size_t> chosen;
    if (!ImGui::BeginCombo(id, words[now].c_str())) return chosen;
    for (std::size_t i = 0; i < words.size(); ++i)
        if (ImGui::Selectable(words[i].c_str(), i == now) && i != now) chosen = i;
    ImGui::EndCombo();
    return chosen;
}

// Names of choices, or numbers where only some are allowed.
std::vector<std::string> words_of(const Parameter& p)
{
    if (!p.choices.empty()) return p.choices;
    std::vector<std::string> words;
    for (const int value : p.values) words.push_back(std::to_string(value));
    return words;
}

bool edit_word(const Parameter& p, double& value)
{
    const std::vector<std::string> words = words_of(p);
    int at = int(std::find(words.begin(), words.end(), p.value_text(value)) - words.begin());
    const bool changed = ImGui::SliderInt("##value", &at, 0, int(words.size()) - 1, words[std::size_t(at)].c_str(),
                                          ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput);
    if (changed) value = p.choices.empty() ? double(p.values[std::size_t(at)]) : double(at);
    return changed;
}

bool edit_number(const Parameter& p, double& value)
{
    // Ranges over many sizes are spread evenly on a log scale; a click with Ctrl takes a number from the keyboard.
    constexpr double kWide = 200.0;
    ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
    if (p.max - p.min >= kWide || (p.min > 0.0 && p.max >= kWide * p.min)) flags |= ImGuiSliderFlags_Logarithmic;
    const std::string unit = p.unit.empty() ? "" : " " + p.unit;
    if (p.as_float != nullptr) {
        auto number = float(value);
        const bool changed =
            ImGui::SliderFloat("##value", &number, float(p.min), float(p.max), ("%.4g" + unit).c_str(), flags);
        if (changed) value = double(number);
        return changed;
    }
    auto number = int(value);
    const bool changed = ImGui::SliderInt("##value", &number, int(p.min), int(p.max), ("%d" + unit).c_str(), flags);
    if (changed) value = double(number);
    return changed;
}

bool edit_switch(double& value)
{
    bool on = value != 0.0;
    const bool changed = ImGui::Checkbox("##value", &on);
    if (changed) value = on ? 1.0 : 0.0;
    return changed;
}

// Takes the text when Enter is pressed.
bool edit_text(std::string& text)
{
    std::array<char, kLongestText + 1> buffer{};
    text.copy(buffer.data(), kLongestText);
    if (!ImGui::InputText("##value", buffer.data(), buffer.size(), ImGuiInputTextFlags_EnterReturnsTrue)) return false;
    text = buffer.data();
    return true;
}

void describe(const Parameter& p, const std::string& word)
{
    const float width = 28.0f * ImGui::GetFontSize(), beside = ImGui::GetWindowPos().x + ImGui::GetWindowWidth();
    if (beside + width < ImGui::GetIO().DisplaySize.x)  // where it hides no other parameter
        ImGui::SetNextWindowPos({beside, ImGui::GetItemRectMin().y});
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(width);
    ImGui::TextUnformatted(p.help.c_str());
    const std::string unit = p.unit.empty() ? "" : " " + p.unit;
    ImGui::TextDisabled("%s%s; default %s", p.range_text().c_str(), unit.c_str(), p.default_word().c_str());
    ImGui::TextDisabled("--set %s=%s", p.name.c_str(), word.c_str());
    ImGui::TextDisabled(p.as_text != nullptr ? "Right click: the default. Enter takes what is typed."
                                             : "Right click: the default. Ctrl and click: type a number.");
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool edit(const Parameter& p, double& value, std::string& text)
{
    ImGui::PushID(p.name.c_str());
    ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    bool changed = p.as_text != nullptr                      ? edit_text(text)
                   : !p.choices.empty() || !p.values.empty() ? edit_word(p, value)
                   : p.as_bool != nullptr                    ? edit_switch(value)
                                                             : edit_number(p, value);
    bool hovered = ImGui::IsItemHovered();
    ImGui::SameLine();
    const bool is_default = value == p.default_value && text == p.default_text;
    if (is_default)
        ImGui::TextUnformatted(p.name.c_str());
    else
        ImGui::TextColored(ImVec4(1.0f, 0.8f, 0.3f, 1.0f), "%s", p.name.c_str());
    hovered = hovered || ImGui::IsItemHovered();
    if (hovered) describe(p, p.as_text != nullptr ? text : p.value_text(value));
    if (hovered && !is_default && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        value = p.default_value;
        text = p.default_text;
        changed = true;
    }
    ImGui::PopID();
    return changed;
}

void edit_parameters(const PanelContents& contents, PanelChanges& changes)
{
    if (!ImGui::CollapsingHeader("parameters", ImGuiTreeNodeFlags_DefaultOpen)) return;
    ParameterValues values = contents.values;
    bool changed = false;
    for (std::size_t i = 0; i < values.numbers.size(); ++i)
        changed = edit(contents.parameters.all()[i], values.numbers[i], values.texts[i]) || changed;
    if (ImGui::Button("copy as --set")) ImGui::SetClipboardText(("--set" + contents.parameters.changed()).c_str());
    if (changed) changes.values = std::move(values);
}

void show_times(const Statistics& statistics)
{
    if (!ImGui::CollapsingHeader("time of each pass")) return;
    if (!ImGui::BeginTable("times", 3, ImGuiTableFlags_SizingStretchProp)) return;
    double sum_ms = 0.0;
    for (const PassTime& time : statistics.last_times()) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(time.pass.c_str());
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", scope_name(time.scope));
        ImGui::TableNextColumn();
        ImGui::Text("%9.2f ms", time.milliseconds);
        sum_ms += time.milliseconds;
    }
    ImGui::TableNextColumn();
    ImGui::TextUnformatted("all, once");
    ImGui::TableNextColumn();
    ImGui::TableNextColumn();
    ImGui::Text("%9.2f ms", sum_ms);
    ImGui::EndTable();
    ImGui::TextDisabled("Of the last picture of all pixels in which it ran.");
}

void show_keys()
{
    if (!ImGui::CollapsingHeader("keys")) return;
    ImGui::TextUnformatted(
        "W A S D Q E   move; Shift faster, wheel: speed\n"
        "right button  turn\n"
        "1 .. 9, Tab   view\n"
        "R             load the shaders again\n"
        "P             write the picture as PNG\n"
        "F1            this panel\n"
        "Escape        end");
}

}  // namespace

Panel::Panel(GLFWwindow* window)
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigInputTextCursorBlink = false;  // the panel is drawn when something happens, not all the time
    float scale = 1.0f, unused = 1.0f;
    glfwGetWindowContentScale(window, &scale, &unused);
    ImFontConfig font;
    font.SizePixels = std::round(kFontPixels * scale);
    io.Fonts->AddFontDefault(&font);
    ImGui::GetStyle().ScaleAllSizes(scale);
    ImGui::GetStyle().WindowRounding = 0.0f;
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

Panel::~Panel()
{
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

PanelChanges Panel::build(const PanelContents& contents)
{
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float margin = 0.75f * ImGui::GetFontSize(), room = screen.x - 2.0f * margin;
    const float wanted = 25.0f * ImGui::GetFontSize(), width = std::max(std::min(wanted, room), 1.0f);
    ImGui::SetNextWindowPos({margin, margin}, ImGuiCond_Once);
    ImGui::SetNextWindowSizeConstraints({width, 0.0f}, {FLT_MAX, std::max(screen.y - 2.0f * margin, 1.0f)});
    ImGui::SetNextWindowSize({width, std::max(screen.y - 2.0f * margin, 1.0f)}, ImGuiCond_Once);
    ImGui::SetNextWindowCollapsed(screen.x < 2.0f * wanted, ImGuiCond_Once);  // the picture is to be seen first
    PanelChanges changes;
    ImGui::Begin(contents.program.c_str());
    // In one line, so that nothing below moves.
    if (contents.fault.empty())
        ImGui::TextDisabled("%s", contents.doing.empty() ? "done" : contents.doing.c_str());
    else
        ImGui::Text("undone: %s", contents.fault.c_str());
    std::vector<std::string> names;
    for (const View& view : contents.views) names.push_back(view.name);
    ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    changes.view = choose("view", names, contents.view);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", contents.views[contents.view].help.c_str());
    for (const PanelSection& section : contents.sections)
        if (ImGui::CollapsingHeader(section.title.c_str(), ImGuiTreeNodeFlags_DefaultOpen))
            changes.section = section.draw() || changes.section;
    edit_parameters(contents, changes);
    show_times(contents.statistics);
    show_keys();
    const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    low_ = {low.x, low.y};
    high_ = low_ + glm::vec2(size.x, size.y);
    ImGui::End();
    ImGui::Render();
    return changes;
}

void Panel::draw() const { ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData()); }

bool Panel::concerns(glm::dvec2 cursor) const
{
    const glm::vec2 at(cursor);
    const bool inside = glm::all(glm::greaterThanEqual(at, low_)) && glm::all(glm::lessThan(at, high_));
    return inside || has_mouse() || has_keyboard();
}

bool Panel::has_keyboard() const { return ImGui::GetIO().WantTextInput; }

bool Panel::has_mouse() const { return ImGui::GetIO().WantCaptureMouse; }

}  // namespace conebook
