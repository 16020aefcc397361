// $CONEBOOK_STRICT: what a driver warns of, though it goes on, ends the program. The tests set it.
#pragma once

#include <cstdlib>

namespace conebook::gl {

inline bool strict()
{
    const char* value = std::getenv("CONEBOOK_STRICT");
    return value != nullptr && value[0] == '1';
}

}  // namespace conebook::gl
