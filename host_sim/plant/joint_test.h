// One joint alone on the bench: its angle is imposed and its torque read, or the other way round.
#pragma once

#include "effects/effect.h"

namespace brace::plant {

// Inputs must be sound (see api/joint.cpp). Writes rows.count entries.
void play_joint(const effects::Model &model, const brace_joint_rows_t &rows, double *out);

} // namespace brace::plant
