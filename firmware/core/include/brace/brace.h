/* The core of Brace. Read this header first: it names the other headers and says what each of them does. It includes
 * all that a controller or a robot's program uses.
 *
 * A program does three things:
 *
 *     brace_limb_check(&limb)                              once; brace/limb.h. `limb` is what calibration found
 *     brace_planar_collapse(&limb, &planar)                whenever the limb's parameters change
 *     brace_planar_stiffness(&planar, theta1_rad, theta2_rad, &k)       in every tick
 *
 * Units are mm, N and rad; each name carries its own. Every call that can refuse returns a brace_status_t, 0 or
 * negative, and leaves its outputs untouched when it refuses. No call keeps state of its own, waits, or uses heap.
 *
 * Everybody needs
 *     status.h           what a call returns, and the flags that a result carries
 *     limb.h             the limb: lengths, compliances, how far they are trusted. limb_fields.h has its members,
 *                        ranges.h what each may be; both are generated from the dictionary
 *     stiffness.h        K as a result: entries, eigenvalues, stiff axis, flags
 *     kinematics.h       joint angles to tip and back, levers of the joints
 *
 * K at a posture, no load on the tip; choose one
 *     planar.h           a planar limb with constant springs whose base yields equally in x and z: the fewest
 *                        instructions
 *     general.h          what planar.h refuses: any base, springs that change from tick to tick
 *     spatial.h          a limb with a coxa joint: K in space
 *     planar_fixed.h     as planar.h, on a controller without a floating-point unit
 *     chain.h            as general.h, every argument checked: for hosts and tests
 *
 * K at the equilibrium under a load
 *     loaded.h           in the limb's plane
 *     loaded_space.h     in space
 *     loaded_fixed.h     in the limb's plane, without a floating-point unit
 *
 * Backlash of the joints
 *     backlash.h         which side of the gap is loaded, a state machine per joint; taking the gap up
 *     play.h             which side a known load holds
 *     load_band.h        where a load lies that is known by a motor before a gear
 *     gap_stiffness.h    K while a gap is open
 *
 * What K and measurements are for
 *     contact.h          sag under a load, force from a displacement, whether a foot slides
 *     slope.h            K from the steps of a loading test
 *     uncertainty.h      how exactly K is known, in the plane at no load; uncertainty_causes.h under a load and in
 *                        space
 *     drift.h            whether it is still the limb that was calibrated
 *
 * Many postures at once, on a host; not included here and not in the two-file core
 *     planar_batch.h, chain_batch.h, loaded_batch.h, kinematics_batch.h
 *
 * The others hold the types of these and need not be read: backlash_types.h, buckling_search.h, drift_types.h,
 * element.h, fixed_harmonic.h, fixed_vec.h, harmonics.h, loaded_types.h, loaded_fixed_types.h, loaded_space_types.h,
 * vec.h.
 *
 * The controller around the core begins at brace/app.h, the client for the robot's computer at brace/client.h.
 */
#ifndef BRACE_BRACE_H
#define BRACE_BRACE_H

#include "brace/backlash.h"
#include "brace/chain.h"
#include "brace/contact.h"
#include "brace/drift.h"
#include "brace/gap_stiffness.h"
#include "brace/general.h"
#include "brace/kinematics.h"
#include "brace/limb.h"
#include "brace/load_band.h"
#include "brace/loaded.h"
#include "brace/loaded_fixed.h"
#include "brace/loaded_space.h"
#include "brace/planar.h"
#include "brace/planar_fixed.h"
#include "brace/play.h"
#include "brace/ranges.h"
#include "brace/slope.h"
#include "brace/spatial.h"
#include "brace/status.h"
#include "brace/stiffness.h"
#include "brace/uncertainty.h"
#include "brace/uncertainty_causes.h"

#endif
