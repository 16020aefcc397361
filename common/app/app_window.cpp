// The window's half of App: whose turn it is, the reader's or the picture's.
#include "app/app_window.hpp"

#include <chrono>
#include <iomanip>
#include <iostream>

namespace conebook {

namespace {

// Samples after which no further one is seen: the error of a mean of 64 is an eighth of one picture's.
constexpr int kMostSamples = 64;

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

glm::ivec2 divided(glm::ivec2 size, int divisor) { return (size + divisor - 1) / divisor; }

std::size_t view_after(const WindowRequests& requests, std::size_t view, std::size_t view_count)
{
    if (requests.view && *requests.view < view_count) view = *requests.view;
    return (view + std::size_t(requests.views_on)) % view_count;
}

}  // namespace

void App::start_window()
{
    std::cerr << info_.name << ": drawn by " << context_.driver() << "\n";
    // A GPU's first picture is a whole one; it works on while the CPU polls, so that slices would only make it wait.
    const bool software = context_.is_software();
    window_ = std::make_unique<Window>(context_.glfw_window(), camera_, scene_.bounds, software ? 4 : 1);
    window_->follows = !options_.frames_given;
    window_->meanwhile_divisor = software ? 2 : 1;
    window_->size = window_->input.framebuffer_size();
    if (!options_.trace_frames.empty()) window_->trace.open(options_.trace_frames);
    if (software && window_->follows) shaders_.set_between_slices([this] { look_after_window(); });
    if (window_->follows) window_->input.set_panel(&window_->panel.emplace(context_.glfw_window()));
    set_title("preparing");
}

void App::add_panel_section(PanelSection section)
{
    if (window_ != nullptr) window_->sections.push_back(std::move(section));
}

void App::on_input(std::function<bool(const InputEvent&)> handler)
{
    if (window_ != nullptr) window_->input.set_handler(std::move(handler));
}

// Builds the panel, and takes what the reader did in it for a request.
void App::build_panel()
{
    Window& w = *window_;
    if (!w.input.shows_panel()) return;
    // Once for what has happened, and again for what follows from it: a click is a press and a release, which may unfold
    // the panel, which then has another size.
    for (int pass = 0; pass < 3; ++pass) {
        const WindowRequests& requests = w.input.requests();
        w.input.add(w.panel->build({info_.name, w.doing_text, w.fault, info_.views,
                                    view_after(requests, view_index_, info_.views.size()), info_.parameters,
                                    requests.values.value_or(info_.parameters.values()), statistics_, w.sections}));
    }
}

void App::refresh_panel()
{
    if (!window_->input.take_panel_events()) return;
    build_panel();
    window_->input.present_again();
}

// After a fault in a frame: back to the parameters of the last picture, if there are any and they are others.
bool App::undo_values(const std::exception& fault)
{
    if (window_ == nullptr || dynamic_cast<const ExitRequest*>(&fault) != nullptr) return false;
    Window& w = *window_;
    if (!w.drawn_values || *w.drawn_values == info_.parameters.values()) return false;
    info_.parameters.set_values(*w.drawn_values);
    w.fault = fault.what();
    std::cerr << info_.name << ": " << w.fault << "\n";
    w.resolution.change();
    return true;
}

void App::set_title(const std::string& doing)
{
    window_->doing_text = doing;
    std::string title = info_.name;
    title.append(": ").append(view().name);
    if (!doing.empty()) title.append(", ").append(doing);
    window_->input.set_title(title);
    window_->title_s = now_s();
}

// Whether what was asked for changes the picture.
bool App::is_outdated() const
{
    const WindowRequests& requests = window_->input.requests();
    return requests.close || requests.reload_shaders || requests.world_from_camera || requests.section ||
           (requests.values && *requests.values != info_.parameters.values()) ||
           view_after(requests, view_index_, info_.views.size()) != view_index_ ||
           window_->input.framebuffer_size() != window_->size;
}

// Makes what was asked for this frame's; whether it changes the picture. Closing is left to the caller.
bool App::take_requests()
{
    const bool changed = is_outdated();
    const WindowRequests requests = window_->input.take();
    view_index_ = view_after(requests, view_index_, info_.views.size());
    if (requests.values && *requests.values != info_.parameters.values()) {
        info_.parameters.set_values(*requests.values);
        window_->values_changed = true;
        window_->fault.clear();
    }
    if (requests.world_from_camera) camera_.world_from_camera = *requests.world_from_camera;
    window_->size = window_->input.framebuffer_size();
    window_->closing = window_->closing || requests.close;
    window_->screenshot = window_->screenshot || requests.screenshot;
    window_->changes += int(changed);
    if (requests.reload_shaders) {
        try {
            shaders_.reload();
        } catch (const std::exception& error) {
            std::cerr << error.what() << "\n";  // the old programs go on, so the reader can correct the file
        }
    }
    return changed;
}

bool App::next_window_frame()
{
    Window& w = *window_;
    if (w.last) return false;
    w.doing = Window::Doing::preparing;
    w.input.poll();
    refresh_panel();
    // Nothing to refine: sleep until something happens.
    while (w.follows && w.resolution.done() && !is_outdated()) {
        const WindowRequests requests = w.input.take();
        if (requests.screenshot) save_screenshot();
        if (requests.show_again) w.input.present_again();
        constexpr double kLongest_s = 10.0;
        w.input.wait(kLongest_s);
        refresh_panel();
    }
    const bool changed = take_requests();
    if (w.screenshot && w.whole && (!changed || w.closing)) save_screenshot();
    if (w.closing && (w.whole || !w.follows || options_.output.empty())) return false;
    w.last = w.closing;
    if (changed) w.resolution.change();
    if (changed && w.meanwhile) show_meanwhile_again();
    size_ = divided(w.size, w.follows && !w.last ? w.resolution.divisor() : 1);
    w.doing = Window::Doing::drawing;
    w.may_give_up = true;
    w.worked = w.whole = false;
    w.not_for_camera_s = 0.0;
    w.frame_start_s = now_s();
    return true;
}

// Called between slices of work. May throw GivenUp.
void App::look_after_window()
{
    Window& w = *window_;
    if (w.doing == Window::Doing::showing_meanwhile) return;
    w.input.poll();
    refresh_panel();
    if (w.doing == Window::Doing::preparing) {
        if (w.meanwhile && is_outdated()) show_meanwhile_again();
        if (w.closing && options_.output.empty()) throw ExitRequest(EXIT_SUCCESS);
        return;
    }
    if (w.input.requests().screenshot) set_title("screenshot as soon as it is whole");
    if (w.last || !w.may_give_up || !is_outdated()) return;
    if (w.input.requests().close || !w.resolution.answers()) throw GivenUp();
}

void App::time_pass_in_window(const std::string& name, Scope scope, const std::function<bool()>& work)
{
    Window& w = *window_;
    if (!w.follows) {
        timer_.time(name, scope, work, statistics_);
        return;
    }
    const bool for_camera = scope == Scope::camera;
    if (w.meanwhile || (w.values_changed && !for_camera)) set_title(name);
    look_after_window();
    // What the passes before have made stays, so the first frame can begin again with the reader's newest wish.
    if (w.meanwhile && !for_camera && w.worked && !w.last && is_outdated()) throw GivenUp();

    const double start_s = now_s();
    bool ran = true;
    const auto watched_work = [&] { return ran = work(); };
    w.may_give_up = for_camera;
    if (for_camera && size_ != w.size)
        watched_work();  // its time says nothing of whole pictures
    else
        timer_.time(name, scope, watched_work, statistics_);
    w.may_give_up = true;
    if (for_camera || !ran) return;
    w.worked = true;
    w.not_for_camera_s += now_s() - start_s;
}

void App::show_meanwhile(std::function<const gl::Texture&()> draw)
{
    if (window_ == nullptr || !window_->follows) return;
    window_->meanwhile = std::move(draw);
    show_meanwhile_again();
}

void App::show_meanwhile_again()
{
    Window& w = *window_;
    w.input.poll();
    take_requests();
    w.doing = Window::Doing::showing_meanwhile;
    size_ = divided(w.size, w.meanwhile_divisor);
    const gl::Texture& display = w.meanwhile();
    w.doing = Window::Doing::preparing;
    set_title("preparing");
    build_panel();
    w.input.present(display);
    trace("meanwhile");
}

void App::show_in_window(const gl::Texture& display)
{
    Window& w = *window_;
    w.whole = size_ == w.size;
    const int divisor = w.resolution.divisor();
    const bool first = w.meanwhile != nullptr;
    w.meanwhile = {};
    w.drawn_values = info_.parameters.values();
    w.values_changed = false;
    w.resolution.shown(now_s() - w.frame_start_s - w.not_for_camera_s,
                       expects_more_ || (accumulates_ && sample_ + 1 < kMostSamples));
    // Samples are not counted faster than one can read.
    constexpr double kLegible_s = 0.25;
    if (w.resolution.done())
        set_title("");
    else if (divisor > 1)
        set_title("1/" + std::to_string(divisor) + " resolution");
    else if (first || now_s() - w.title_s > kLegible_s)
        set_title(accumulates_ ? "refining " + std::to_string(sample_ + 1) + "/" + std::to_string(kMostSamples) : "");
    build_panel();
    w.input.present(display);
    trace("frame");
}

void App::save_screenshot()
{
    const std::string file = info_.name + "_" + std::to_string(window_->screenshots++) + ".png";
    write_picture(file, *linear_, *display_);
    std::cout << "screenshot: " << std::filesystem::absolute(file).string() << std::endl;
    window_->screenshot = false;
}

// One line of --trace-frames, see docs of the option.
void App::trace(const char* what)
{
    Window& w = *window_;
    if (!w.trace.is_open()) return;
    w.trace << std::fixed << std::setprecision(6) << now_s() << " " << what << " " << size_.x << "x" << size_.y << " "
            << w.size.x << "x" << w.size.y << " " << view().name << " " << sample_ << " " << w.changes
            << info_.parameters.changed() << std::endl;
}

}  // namespace conebook
