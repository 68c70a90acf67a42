/* Which side of a joint's play a load takes up.
 *
 * One rule for the controller and the tools: a joint whose load, less how far that load may be off, still holds one
 * side is engaged there. The load is told by a force on the tip, the levers and the weights. It may be off by the
 * joint's friction, the noise of the force and the trust in levers and sensor. brace/backlash.h proves a side by the
 * motor's torque; this function assumes it.
 *
 * Thread rule: a pure function of its arguments; any thread or interrupt that may use the FPU.
 */
#ifndef BRACE_PLAY_H
#define BRACE_PLAY_H

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

/* joint: not null. load_n_mm: what the joint carries, in its own sense; NaN holds no side.
 * lever_mm: |x| + |z| of the tip's lever about the joint.
 * Cost on a Cortex-M4F: at most 60 instructions. */
brace_play_t brace_play_under_load(const brace_play_joint_t *joint, float load_n_mm, float lever_mm);

#endif
