// A uniform beam's end deflection and rotation are coupled: bending compliance b and length L give
// [[b, 3b/2L], [3b/2L, 3b/L^2]] for [force; moment]. The moment is that of the tip force about the beam's
// end.
#pragma once

#include "effects/effect.h"

namespace brace::effects::moment_transfer {

// Deflection per moment, and rotation per force [1/N].
inline double coupling_per_n(double bending_mm_per_n, double length_mm, double strength)
{
    return length_mm > 0.0 ? 1.5 * bending_mm_per_n * strength / length_mm : 0.0;
}

// Rotation per moment [rad/(N mm)].
inline double rotation_rad_per_n_mm(double bending_mm_per_n, double length_mm, double strength)
{
    return length_mm > 0.0 ? 3.0 * bending_mm_per_n * strength / (length_mm * length_mm) : 0.0;
}

} // namespace brace::effects::moment_transfer
