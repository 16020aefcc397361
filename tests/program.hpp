// Runs a program of the book and keeps what it said. Header only.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

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
