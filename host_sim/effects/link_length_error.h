// The links' lengths set every lever; the effect of this name is a length other than the calibration's.
#pragma once

#include "effects/effect.h"

namespace brace::effects::link_length_error {

// The paper's limb.
inline void none(Model &model)
{
    model.geometry = {57.0, 185.0, 313.5};
}

inline constexpr Entry kEntries[] = {
    {"link_length_error", "geometry", "geometry.femur_mm geometry.tibia_mm",
     "levers follow the true lengths"},
};

} // namespace brace::effects::link_length_error
