// What the limb stands on moves and turns: displacement = compliance * force, rotation = compliance * moment
// about the femur axis.
#pragma once

#include "effects/effect.h"

namespace brace::effects::base_compliance {

inline void none(Model &model)
{
    model.base = {0.0, 0.0, 0.0};
}

inline constexpr Entry kEntries[] = {
    {"base_compliance", "base", "base.x_mm_per_n base.z_mm_per_n base.rotation_rad_per_n_mm",
     "base displacement = compliance * force; base rotation = compliance * moment about the femur axis"},
};

} // namespace brace::effects::base_compliance
