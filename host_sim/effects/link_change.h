// A link changes during the record: until at_s its bending compliance is the limb's, which is today's, times a factor.
// Reads change.*; depends on time.
#pragma once

#include <cmath>

#include "effects/effect.h"

namespace brace::effects::link_change {

struct Change : NoChange {
    static bool acts(const Model &model) { return model.change.bending_factor != 1.0 && model.change.at_s < HUGE_VAL; }

    static void of_link(const Model &model, const Conditions &conditions, int link, Link &now)
    {
        if (conditions.t_s < model.change.at_s && link == static_cast<int>(model.change.link_index)) {
            now.bending_mm_per_n *= model.change.bending_factor;
        }
    }
};

} // namespace brace::effects::link_change
