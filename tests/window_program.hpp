// A program of the book in a window of a virtual X server, with events sent to it and what it shows traced. Header only.
#pragma once

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "program.hpp"
#include "temporary_folder.hpp"

namespace conebook {

inline bool is_installed(const std::string& command)
{
    return std::system(("command -v " + command + " > /dev/null").c_str()) == 0;
}

// Whether `holds` does at last. It gives up after two minutes, so that a test which fails ends.
inline bool in_the_end(const std::function<bool()>& holds)
{
    for (int i = 0; i < 6000; ++i) {
        if (holds()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return holds();
}

// A process that ends with its owner.
class Process {
public:
    // `before_it_runs` is called in the new process.
    Process(const std::vector<std::string>& command, const std::function<void()>& before_it_runs)
    {
        id_ = fork();
        if (id_ != 0) return;
        before_it_runs();
        std::vector<char*> argv;
        for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
        argv.push_back(nullptr);
        execvp(argv[0], argv.data());
        _exit(127);
    }
    ~Process()
    {
        if (code_) return;
        kill(id_, SIGKILL);
        waitpid(id_, nullptr, 0);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    // The exit code, above 128 when a signal ended it; nothing while it runs.
    std::optional<int> code()
    {
        int status = 0;
        if (!code_ && waitpid(id_, &status, WNOHANG) == id_)
            code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return code_;
    }

private:
    pid_t id_ = -1;
    std::optional<int> code_;
};

// An X server without a screen to look at.
class VirtualScreen {
public:
    VirtualScreen()
    {
        int ends[2];
        if (pipe(ends) != 0) throw std::runtime_error("no pipe");
        server_.emplace(std::vector<std::string>{"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0",
                                                 "1400x1024x24", "-nolisten", "tcp"},
                        [] { dup2(open("/dev/null", O_WRONLY), STDERR_FILENO); });
        close(ends[1]);
        FILE* number = fdopen(ends[0], "r");
        int display = -1;
        if (fscanf(number, "%d", &display) == 1) name_ = ":" + std::to_string(display);
        fclose(number);
    }
    const std::string& name() const { return name_; }  // for $DISPLAY; empty: it did not start

    // See man xdotool. Words for the shell.
    void xdotool(const std::string& words) const
    {
        if (std::system(("DISPLAY=" + name_ + " xdotool " + words + " > /dev/null").c_str()) != 0)
            throw std::runtime_error("xdotool " + words);
    }

private:
    std::optional<Process> server_;
    std::string name_;
};

// A line of --trace-frames.
struct ShownPicture {
    double time_s = 0.0;
    std::string what, size, window_size, view;
    int sample = 0, changes = 0;
    std::string parameters;  // NAME=VALUE of those that are not the default
    bool is_whole() const { return what == "frame" && size == window_size; }
};

class WindowProgram {
public:
    WindowProgram(const VirtualScreen& screen, const std::string& name, const std::vector<std::string>& arguments)
        : screen_(screen), name_(name)
    {
        std::vector<std::string> command = {program_folder() + "/" + name, "--trace-frames", file("trace").string()};
        command.insert(command.end(), arguments.begin(), arguments.end());
        process_.emplace(command, [&] {
            setenv("DISPLAY", screen.name().c_str(), 1);
            unsetenv("WAYLAND_DISPLAY");
            std::filesystem::current_path(folder_.path());
            const int out = open(file("said").c_str(), O_WRONLY | O_CREAT, 0644);
            dup2(out, STDOUT_FILENO);
            dup2(out, STDERR_FILENO);
        });
        screen.xdotool("search --sync --onlyvisible --name '^" + name + "'");
        screen.xdotool("mousemove 100 60");  // no window manager: keys go to where the pointer is
    }
    std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    std::string said() const
    {
        std::stringstream all;
        all << std::ifstream(file("said")).rdbuf();
        return all.str();
    }
    std::vector<ShownPicture> shown() const
    {
        std::vector<ShownPicture> pictures;
        std::ifstream lines(file("trace"));
        for (std::string line; std::getline(lines, line) && !lines.eof();) {
            std::istringstream words(line);
            ShownPicture p;
            words >> p.time_s >> p.what >> p.size >> p.window_size >> p.view >> p.sample >> p.changes;
            std::getline(words, p.parameters);
            pictures.push_back(p);
        }
        return pictures;
    }
    // Waits until such a picture is the last one that was shown.
    bool shows(const std::function<bool(const ShownPicture&)>& wanted) const
    {
        return in_the_end([&] {
            const std::vector<ShownPicture> all = shown();
            return !all.empty() && wanted(all.back());
        });
    }
    // Waits for a picture that answers so many changes, of all the window's pixels or of any.
    bool shows_whole(int changes, int sample = 0) const
    {
        return shows([=](const ShownPicture& p) { return p.is_whole() && p.changes >= changes && p.sample >= sample; });
    }
    int changes() const
    {
        const std::vector<ShownPicture> all = shown();
        return all.empty() ? 0 : all.back().changes;
    }
    void key(const std::string& names) const { screen_.xdotool("key --delay 20 " + names); }

    // Presses P and waits for the file; empty when none comes.
    std::filesystem::path screenshot()
    {
        const std::filesystem::path picture = file(name_ + "_" + std::to_string(screenshots_++) + ".png");
        key("p");
        // It is named after it has been written.
        const bool there = in_the_end([&] { return said().find(picture.filename().string()) != std::string::npos; });
        return there ? picture : std::filesystem::path();
    }
    // Waits for its end; -1 when it does not end.
    int code()
    {
        in_the_end([&] { return process_->code().has_value(); });
        return process_->code().value_or(-1);
    }

private:
    TemporaryFolder folder_;
    const VirtualScreen& screen_;
    std::string name_;
    std::optional<Process> process_;
    int screenshots_ = 0;
};

}  // namespace conebook
