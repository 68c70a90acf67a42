// A link changes during the record: from at_s on its bending compliance is multiplied.
#pragma once

#include "effects/effect.h"

namespace brace::effects::link_change {

inline bool has_come(const Model &model, double t_s)
{
    return t_s >= model.change.at_s;
}

inline double bending_mm_per_n(const Model &model, int link, double t_s)
{
    const bool changed = has_come(model, t_s) && link == static_cast<int>(model.change.link_index);
    return model.link[link].bending_mm_per_n * (changed ? model.change.bending_factor : 1.0);
}

} // namespace brace::effects::link_change
