// Runs a program of the book and keeps what it said; which programs and scenes there are. Header only.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/wait.h>

namespace conebook {

struct ProgramRun {
    int code = -1;       // exit code; above 128 when a signal ended it
    std::string output;  // stdout and stderr together
};

// Folder of the programs, or "" when $CONEBOOK_BIN is not set.
inline std::string program_folder()
{
    const char* folder = std::getenv("CONEBOOK_BIN");
    return folder ? folder : "";
}

// The repository, or the working directory when $CONEBOOK_ROOT is not set.
inline std::filesystem::path repository_folder()
{
    const char* folder = std::getenv("CONEBOOK_ROOT");
    return folder ? folder : ".";
}

// assets/NAME.glb
inline std::filesystem::path asset(const std::string& name) { return repository_folder() / "assets" / (name + ".glb"); }

// Names of the chapters' programs, in order.
inline std::vector<std::string> chapters()
{
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(repository_folder() / "chapters", error))
        if (std::filesystem::exists(entry.path() / "main.cpp")) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

// Whether a chapter has the parameter voxels. 19 and 20 have patches instead.
inline bool has_voxels(const std::string& chapter)
{
    const int number =
        chapter.size() > 1 && std::isdigit(chapter[0]) && std::isdigit(chapter[1]) ? std::stoi(chapter) : 0;
    return number >= 4 && number <= 18;
}

// Few voxels, or few patches: for tests that ask of every chapter what does not depend on how fine it is.
inline std::string coarse_settings(const std::string& chapter)
{
    if (has_voxels(chapter)) return " --set voxels=16 ";
    return chapter.rfind("20_", 0) == 0 ? " --set patches=500 rays=64 " : "";
}

// `arguments` as in a shell.
inline ProgramRun run_program(const std::string& name, const std::string& arguments)
{
    ProgramRun run;
    std::string command = "'";
    command += program_folder() + "/" + name + "' " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return run;
    std::array<char, 4096> buffer;
    for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) run.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return run;
}

}  // namespace conebook
