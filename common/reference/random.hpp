// Random numbers that depend on (seed, pixel, sample) alone, never on threads or on the order of work.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace conebook {

// The finalizer of SplitMix64 (Steele, Lea & Flood 2014, "Fast splittable pseudorandom number generators").
inline std::uint64_t mix_bits(std::uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

// PCG-XSH-RR 64/32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient ... Algorithms", 6.3.1).
class Pcg32 {
public:
    Pcg32(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
        : state_(mix_bits(mix_bits(mix_bits(seed + 0x9e3779b97f4a7c15ull) + pixel) + sample)),
          increment_(mix_bits(pixel * 0x9e3779b97f4a7c15ull + sample + seed) | 1u)
    {
        next_uint();
    }

    std::uint32_t next_uint()
    {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ull + increment_;
        const auto xorshifted = std::uint32_t(((old >> 18u) ^ old) >> 27u);
        const auto rotation = std::uint32_t(old >> 59u);
        return (xorshifted >> rotation) | (xorshifted << ((32u - rotation) & 31u));
    }

    float next() { return float(next_uint() >> 8) * 0x1p-24f; }  // [0, 1)
    glm::vec2 next_2d()
    {
        const float u = next();
        return {u, next()};
    }

private:
    std::uint64_t state_, increment_;
};

}  // namespace conebook
