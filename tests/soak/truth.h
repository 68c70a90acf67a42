// K of the limb that is there, by host_sim/reference at the rest state of host_sim/plant; and what a controller says of
// it. No code of the controller works out the truth; its own figure for its uncertainty is what it is held to.
#pragma once

#include <cstdint>

#include "limbs.h"

extern "C" {
#include "brace/snapshot.h"
}

namespace soak
{

// How a K that is called valid agrees with the limb.
struct Agreement {
    bool is_told = false;         // there was a valid K to judge
    bool is_judged = false;       // and the reference has an answer
    double share = 0.0;           // error of the worst entry / allowed error; K is wrong above 1
};

// Allowed for an entry of K: three of the sigmas that brace_uncertainty_stiffness tells of it, and 0.6 % of K's norm,
// which brace/loaded.h promises for a load. Where a flank is not known, the joint may stand anywhere in its gap: half
// of it is added to the angles' sigma.
Agreement agreement(const Limb &limb, const brace_node_truth_t &truth, const brace_snapshot_t &told);

// Is a gap open, and no flag says so?
bool denies_gap(const Limb &limb, const brace_node_truth_t &truth, const brace_snapshot_t &told);

} // namespace soak
