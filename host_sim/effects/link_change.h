// A link that changes during the record: from at_s on its bending compliance is multiplied.
#pragma once

#include <limits>

#include "effects/effect.h"

namespace brace::effects::link_change {

inline double bending_mm_per_n(const Model &model, int link, double t_s)
{
    const bool changed = t_s >= model.change.at_s && link == static_cast<int>(model.change.link_index);
    return model.link[link].bending_mm_per_n * (changed ? model.change.bending_factor : 1.0);
}

inline void none(Model &model)
{
    model.change = {std::numeric_limits<double>::infinity(), static_cast<double>(kTibia), 1.0};
}

inline constexpr const char *kLaw = "bending compliance times bending_factor from at_s on";
inline constexpr Entry kEntries[] = {
    {"link_change", "link.femur", "change.at_s change.bending_factor", kLaw},
    {"link_change", "link.tibia", "change.at_s change.bending_factor", kLaw},
};

} // namespace brace::effects::link_change
