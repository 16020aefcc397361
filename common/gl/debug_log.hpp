// Collects KHR_debug messages of the current context. A message of high severity makes the program fail.
#pragma once

#include <string>
#include <vector>

namespace conebook::gl {

class DebugLog {
public:
    DebugLog();  // installs itself as the callback of the current context
    ~DebugLog();
    DebugLog(const DebugLog&) = delete;
    DebugLog& operator=(const DebugLog&) = delete;

    // Messages that must end the program with a code above 0: high severity, errors, and glGetError; undefined behaviour
    // too when gl::strict().
    std::vector<std::string> faults() const;
    void add_fault(std::string message) { faults_.push_back(std::move(message)); }

private:
    std::vector<std::string> faults_;
};

}  // namespace conebook::gl
