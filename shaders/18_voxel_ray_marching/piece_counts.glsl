// What is found out of all pieces together.
#include "common/bindings.glsl"

layout(std430, binding = kPieceCountBinding) buffer PieceCountBuffer {
    uint largest_radiance;  // s, W/(sr m^2), bits of a float
    uint occupied_voxels;
};
