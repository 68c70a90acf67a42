/* Which side of a joint's play a load takes up.
 *
 * One rule for the controller and the tools: a joint whose load, less how far that load may be off, still holds one
 * side is engaged there. The load is computed from a force on the tip, the levers and the weights. It may be off by the
 * joint's friction, the noise of the force and the trust in levers and sensor. brace/backlash.h proves a side by the
 * motor's torque; where it has not, brace_play_under_load assumes it.
 *
 * Thread rule: a pure function of its arguments; any thread or interrupt that may use the FPU.
 */
#ifndef BRACE_PLAY_H
#define BRACE_PLAY_H

#include <stdbool.h>

#include "brace/backlash_types.h"

#define BRACE_PLAY_SIGMAS 6.0f
#define BRACE_PLAY_LEVER_OFF_RATIO 0.02f /* how far levers and weights may be off, of the load */

/* What makes a joint's load uncertain. */
typedef struct {
    float coulomb_n_mm, coulomb_per_load_ratio; /* friction holds up to coulomb + ratio |load|; ratio [0, 1) */
    float noise_n;                              /* one sigma of the force on the tip */
    float gain_rel;                             /* one sigma of its gain, of 1 */
} brace_play_joint_t;

typedef struct {
    int flank;      /* the side that the load holds: +1, -1; 0: it holds none surely, the play counts as open */
    float off_n_mm; /* how far the load may be off */
} brace_play_t;

/* What counts of a joint with play. */
typedef struct {
    int flank;       /* the side where the joint stands, +1 or -1; 0: anywhere in its play */
    bool is_engaged; /* its side is proven, or the load says so; else its gap counts as open */
    bool is_assumed; /* only the load says so */
} brace_engagement_t;

/* joint: not null. load_n_mm: what the joint carries, in its own sense; NaN holds no side.
 * lever_mm: |x| + |z| of the tip's lever about the joint.
 * Cost on a Cortex-M4F: at most 60 instructions. */
brace_play_t brace_play_under_load(const brace_play_joint_t *joint, float load_n_mm, float lever_mm);

/* Is a joint engaged? Its motor's torque has proven the side, or names it and the load holds the same one. Where
 * nothing measures the load, the side that the torque names is assumed.
 *   named, is_proven: as brace_backlash_tick or brace_backlash_at_rest reported them
 *   is_expected: the load is computed from the force on the tip; held: the side that it holds
 * Cost: at most 20 instructions. */
brace_engagement_t brace_play_engagement(int named, bool is_proven, bool is_expected, int held);

/* The same for a joint that has long stood under one load, which its motor carries: what a controller settles at.
 *   machine: prepared by brace_backlash_init; null: the joint cannot be watched, and its gap counts as open
 *   is_expected: false for a joint whose load no force on the tip gives (the coxa joint)
 * Not for the tick. */
brace_engagement_t brace_play_at_rest(const brace_play_joint_t *joint, const brace_backlash_t *machine, float load_n_mm,
                                      float lever_mm, bool is_expected);

#endif
