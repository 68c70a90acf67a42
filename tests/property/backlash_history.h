/* Random load and motion histories of one joint, a millisecond at a time: what the limb does, what the world does to
 * it, and what the instruments read. The same for whoever estimates the flank from it. */
#ifndef BACKLASH_HISTORY_H
#define BACKLASH_HISTORY_H

#include "backlash_plant.h"
#include "brace/backlash.h"

enum { HISTORY_TICKS = 6000 };
#define HISTORY_TICK_S 1e-3

typedef enum { REST, MOVE, SWING, PRESS, DRIFT, IMPACTS, KINDS } kind_t;

typedef struct {
    kind_t kind;
    double t, length_s;
    double from_rad, to_rad, swing_rad, swing_hz;
    double torque_from, torque_to, pulse_at_s, pulse_s, pulse_n_mm;
    bool held;
} segment_t;

/* How far the gap is believed wrong: anything within 20 %, or exactly 20 % up or down. */
typedef enum { GAP_WITHIN_20_PERCENT, GAP_EXACTLY_20_PERCENT_OFF } gap_belief_t;

/* Friction at rest: no more than in motion; up to twice that, and nobody knows; or so, and the belief allows for it. */
typedef enum { SLIPS, STICKS_UNKNOWN, STICKS_ALLOWED } breakaway_t;

typedef struct {
    dice_t dice;
    plant_t plant;
    brace_backlash_params_t believed;
    double hold_stiffness, gravity_off;
    bool expecting; /* gravity (15 % off, and 2 % of range for friction) is given while nothing else touches the link
                       and it is at rest */
    world_t world;
    segment_t segment;
    uint32_t tick;
    double setpoint_rad, setpoint_before_rad;
    double sent_before_rad, astray_rad; /* how far off its setpoint the motor is sent by history_feel_for_flank */
} history_t;

/* gap_off: the belief's error as a ratio. */
brace_backlash_params_t joint_as_believed(const plant_t *plant, double gap_off, dice_t *dice, double hold_stiffness);

history_t history_begin(uint64_t seed, gap_belief_t belief, bool expecting, breakaway_t breakaway);

/* Before a tick: the motor may leave its setpoint, by reach_gaps of the gap as believed at most, to touch what cannot
 * be found from where it stands. While no flank is decided (0) it goes to the one that the offset lies nearer to; else
 * back. */
void history_feel_for_flank(history_t *history, int flank, double offset_rad, double reach_gaps);

/* Goes on by a millisecond and reads the instruments. */
brace_backlash_sample_t history_tick(history_t *history);

#endif
