// Points that are spread evenly, however many of them one takes.
#pragma once

namespace conebook {

// Van der Corput's radical inverse, 0 <= value < 1: the digits of i to this base behind the point, in reverse order.
// Those of bases 2 and 3 are Halton's points, i / n with that of base 2 is Hammersley's (pbrt 4ed, 8.6.1).
inline double radical_inverse(unsigned base, unsigned i)
{
    double value = 0.0;
    for (double digit = 1.0 / base; i > 0; i /= base, digit /= base) value += digit * (i % base);
    return value;
}

}  // namespace conebook
