// A uniform beam's end deflection and rotation are coupled: bending compliance b and length L give
// [[b, 3b/2L], [3b/2L, 3b/L^2]] for [force; moment]. Two hinges at the Gauss points L (1/2 -+ 1/(2 sqrt 3)), each of
// compliance 3b/2L^2, give just this; so do two in each of any number of equal parts of the beam.
// Reads link.*.moment_transfer, link.*.bending_mm_per_n; depends on nothing else.
#pragma once

#include "effects/effect.h"

namespace brace::effects::moment_transfer {

// Of one of the beam's Gauss hinges [rad/(N mm)].
inline double hinge_rad_per_n_mm(double bending_mm_per_n, double length_mm, double strength, int hinges)
{
    return 3.0 * bending_mm_per_n * strength / (length_mm * length_mm * hinges);
}

} // namespace brace::effects::moment_transfer
