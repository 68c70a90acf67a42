// K of the limb that is there, by host_sim/reference at the rest state of host_sim/plant; and what a controller says of
// it. No code of the controller works out the truth; its own figure for its uncertainty is what it is held to.
#pragma once

#include <cstdint>

#include "limbs.h"

extern "C" {
#include "brace/app.h"
#include "brace/snapshot.h"
}

namespace soak {

// How a K that is called valid agrees with the limb.
struct Agreement {
    bool is_reported = false; // there was a valid K to judge
    bool is_judged = false; // and the reference has an answer
    // K's largest sigma / its norm; and what the parameters alone make of it
    double reported = 0.0, by_parameters = 0.0;
    bool is_sensed = false; // a sensor at the tip measures the load
    double share = 0.0; // error of the worst entry / allowed error; K is wrong above 1
    double share_by_parameters = 0.0; // the same, were no more allowed than for what the parameters leave open
};

// Allowed for an entry of K: three of the sigmas that its snapshot has of it, and 0.6 % of K's norm, which
// brace/loaded.h promises for a load.
Agreement agreement(const Limb &limb, const brace_node_truth_t &truth, brace_app_t *app);

// Is a gap open, and no flag says so?
bool denies_gap(const Limb &limb, const brace_node_truth_t &truth, const brace_snapshot_t &reported);

} // namespace soak
