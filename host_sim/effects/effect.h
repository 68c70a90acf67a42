// What the laws of all effects share: the limb's numbers, the conditions under which they are asked, and the indices of
// joints and links.
//
// A file of this folder has all that is known of one effect: its law, the law's derivative where the plant needs one,
// and whether it acts (`acts`) where a caller may save work if it does not. Its head has a line "Reads A, B; depends on
// C and D.". A and B are numbers of the model; firmware/interface/dictionary.toml has their units, ranges and defaults.
// C and D are "temperature", "time", "the load" (the reading is no straight line of the displacement), "what came
// before", or "nothing else". tests/tools/effects/test_what_laws_depend_on.py plays each law and compares.
// A law that reads Conditions is called by limb_now.h only; a law of a joint that reads a deflection or a torque by
// plant/joint_law.h; a law that depends on what came before is listed in memory.h.
#pragma once

extern "C" {
#include "api/brace_host.h"
}

namespace brace::effects {

using Model = brace_plant_model_t;
using Joint = brace_plant_joint_t;
using Link = brace_plant_link_t;

struct Conditions {
    double t_s;
    double temp_degc; // of the joints
};

// What an effect of time or temperature does to the limb's numbers. Its own struct `Change` is derived from this one,
// has of_joint or of_link or both in its place, and says whether the effect acts: where it does not, nobody calls it.
struct NoChange {
    static void of_joint(const Model &, const Conditions &, int /*joint*/, Joint & /*now*/) {}
    static void of_link(const Model &, const Conditions &, int /*link*/, Link & /*now*/) {}
};

inline constexpr int kCoxa = 0;
inline constexpr int kFemur = 1;
inline constexpr int kTibia = 2;

} // namespace brace::effects
