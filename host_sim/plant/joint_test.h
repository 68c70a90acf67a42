// One joint alone on the bench: its angle is imposed and its torque read, or the other way round.
#pragma once

#include "effects/effect.h"

namespace brace::plant {

// How a record of an imposed angle reads: no part of the limb.
struct JointReading {
    double reversal_rad;       // length of the turn over which friction changes its sign
    double torque_offset_n_mm; // reading of no torque
};

// Inputs must be sound (see api/joint.cpp). The reading takes the place of rows.reversal_rad. Writes rows.count
// entries.
void play_joint(const effects::Model &model, const brace_joint_rows_t &rows, const JointReading &reading, double *out);

} // namespace brace::plant
