// What lets one header be read by both C++ and GLSL. std430/std140 lay out mat4, vec4 and groups of four scalars as
// C++ does; a bare vec3 they do not, so none is used. tests/shared_structs_test.cpp compares the offsets.
#ifdef __cplusplus
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
namespace conebook::shared {
using glm::mat4;
using glm::vec4;
using glm::ivec4;
using glm::uvec4;
using uint = std::uint32_t;
}
#define CONEBOOK_SHARED_BEGIN namespace conebook::shared {
#define CONEBOOK_SHARED_END }
#define CONEBOOK_CONSTANT inline constexpr
#else
#define CONEBOOK_SHARED_BEGIN
#define CONEBOOK_SHARED_END
#define CONEBOOK_CONSTANT const
#endif
