// The tip's ball joint has clearance: along each axis the tip slips freely within half of it to either side.
#pragma once

#include "effects/effect.h"

namespace brace::effects::contact_play {

inline double half_mm(const Model &model)
{
    return 0.5 * model.contact.play_mm;
}

inline void none(Model &model)
{
    model.contact = {0.0};
}

inline constexpr Entry kEntries[] = {
    {"contact_play", "contact", "contact.play_mm", "free slip of the tip within +-play/2 along each axis"},
};

}  // namespace brace::effects::contact_play
