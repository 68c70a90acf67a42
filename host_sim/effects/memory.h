// Which effects depend on what came before. Each one that does stands in one of these lists; the plant asks them
// before it takes a rest state that it has found earlier for the one that it needs now.
#pragma once

#include "effects/coulomb_friction.h"
#include "effects/creep.h"

namespace brace::effects {

// Within a run: a tip that is held where it was held before may rest otherwise. Contact play is not listed: it moves
// the place where the tip is held, and the plant sees the place. first_joint: kFemur of a limb in its plane.
inline bool remembers_readings(const Model &now, int first_joint)
{
    bool rubs = false;
    for (int joint = first_joint; joint <= kTibia; ++joint) {
        rubs = rubs || coulomb_friction::acts(now.joint[joint]);
    }
    return rubs || creep::acts(now);
}

// How long each reading took: the same displacements in another time lead to another rest.
inline bool remembers_pace(const Model &now)
{
    return creep::acts(now);
}

} // namespace brace::effects
