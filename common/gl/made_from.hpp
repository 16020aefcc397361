// What lets a pass run only when something that its result depends on has changed.
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>

namespace conebook {

// Counts the changes of a thing; of two equal revisions of it nothing has changed between them. 0: never made.
using Revision = std::uint64_t;

// The inputs that a result was made from: revisions of what it reads, parameters by value.
template <typename... Inputs>
class MadeFrom {
public:
    // Whether these inputs differ from those of the last call; they are remembered. True at the first call.
    bool differs(const Inputs&... inputs)
    {
        std::tuple<Inputs...> now(inputs...);
        if (last_ && *last_ == now) return false;
        last_ = std::move(now);
        return true;
    }

    // The next call finds a difference.
    void forget() { last_.reset(); }

private:
    std::optional<std::tuple<Inputs...>> last_;
};

}  // namespace conebook
