/* Which flank of a joint's play carries: a preload state machine per joint, and the take-up of the play on request.
 *
 * Between motor and link lies a gap of full width g: the link stands at
 *     joint angle = motor angle + offset,   offset = -g/2 on the positive flank, +g/2 on the negative one,
 * less the elastic wind-up. On the positive flank the motor's torque on the link is positive.
 *
 * What decides is the load, not the direction of motion. The load the gap transmits lies in an interval:
 *     motor torque - inertia * acceleration - friction, +- what is not known of each,
 * where friction is known (to its tolerance) while the motor moves one way and only bounded while it stands. The
 * interval is filtered twice, 10 ms and 80 ms. Fast and clear of zero by six sigma for 12 ms: the flank is valid.
 * Slow and clear by 0.7 of its bounds and three sigma, or narrowed by an expected load: the flank is told, not valid,
 * and remembered for 250 ms. Where nothing tells, no flank is told; the offset still goes where the slow mean of a moving
 * motor leans to, or else follows the motor's travel through the gap, as a play operator: a guess, off by up to the gap.
 * What is reached, and what could not be by looking on from the motor's side: docs/backlash.md.
 *
 * A table of transitions (src/backlash_table.c) moves the state; a second one the phases of a take-up.
 *
 * Angles in the joint's own sense (theta1, theta2), joint side of the reduction. Time is the caller's microseconds,
 * which may wrap. One brace_backlash_t per joint, touched by one thread; different joints are independent.
 * No heap, no recursion, no libm; loops are over a state's rows, at most 7 (brace_backlash_init: at most 1000).
 * A refused call changes nothing, save that brace_backlash_tick goes to FAULT on a bad sample. Figures: docs/bench.md.
 */
#ifndef BRACE_BACKLASH_H
#define BRACE_BACKLASH_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/kinematics.h"
#include "brace/limb.h"
#include "brace/status.h"

typedef enum {
    BRACE_BACKLASH_UNKNOWN = 0,          /* no flank can be told: nothing has been seen, or not for 250 ms */
    BRACE_BACKLASH_TAKING_UP = 1,        /* a take-up moves the motor through the gap */
    BRACE_BACKLASH_ENGAGED_POSITIVE = 2, /* the positive flank carries */
    BRACE_BACKLASH_ENGAGED_NEGATIVE = 3,
    BRACE_BACKLASH_CROSSING = 4, /* the flank was left without a load, the next is not yet told; UNKNOWN after 2 s */
    BRACE_BACKLASH_FAULT = 5,    /* samples were bad or late; left after 20 ms of good ones */
    BRACE_BACKLASH_STATE_COUNT = 6
} brace_backlash_state_t;

typedef enum {
    BRACE_TAKEUP_IDLE = 0,
    BRACE_TAKEUP_APPROACH = 1, /* the command moves to the flank */
    BRACE_TAKEUP_VERIFY = 2,   /* the command stands, the load has to stay */
    BRACE_TAKEUP_HOLD = 3,     /* verified: measure now, subtract the preload */
    BRACE_TAKEUP_LET_GO = 4,   /* the command goes back the way it came */
    BRACE_TAKEUP_PHASE_COUNT = 5
} brace_takeup_phase_t;

/* How the last take-up went; kept until the next request. */
typedef enum {
    BRACE_TAKEUP_NONE = 0,
    BRACE_TAKEUP_RUNNING = 1,
    BRACE_TAKEUP_DONE = 2,      /* verified against the chosen flank */
    BRACE_TAKEUP_E_TORQUE = -1, /* the motor torque passed its bound */
    BRACE_TAKEUP_E_TRAVEL = -2, /* the motor went further than the gap allows: nothing holds the link */
    BRACE_TAKEUP_E_REACH = -3,  /* the command went to its end without the load: the motor does not follow */
    BRACE_TAKEUP_E_TIME = -4,
    BRACE_TAKEUP_E_VERIFY = -5, /* the load or the motor did not stay while it was verified */
    BRACE_TAKEUP_E_LOST = -6,   /* verified, and later the load went away */
    BRACE_TAKEUP_E_FAULT = -7   /* the joint went to FAULT meanwhile */
} brace_takeup_result_t;

typedef struct {
    float torque_max_n_mm;    /* bound of the motor torque (0, torque_range]; above brace_takeup_preload_min_n_mm */
    float preload_n_mm;       /* load wanted on the flank; raised to what can be verified [0, torque_max] */
    float travel_max_rad;     /* bound of the motor's travel; more than the gap and its wind-up (0, 1] */
    float reach_max_rad;      /* bound of the command; travel and the servo's droop at torque_max (0, 2] */
    float rate_rad_per_s;     /* of the command (0, 10] */
    uint32_t time_max_us;     /* from request to verified [1, 6e7] */
    uint32_t verify_us;       /* [20 000, 1e7] */
} brace_takeup_bounds_t;

typedef struct {
    uint32_t tick_us;                 /* period of brace_backlash_tick [100, 5000] */
    float gap_rad;                    /* full width as believed [1e-5, 0.5]; 20 % off is expected */
    float friction_n_mm;              /* Coulomb friction of motor and gears, before the gap [0, 1e6] */
    float friction_tolerance_ratio;   /* how far that may be off [0, 1]; gears stick and creep: 1 (docs/backlash.md) */
    float inertia_n_mm_s2_per_rad;    /* of motor and gears, joint side [0, 1e6]; trusted to 25 % */
    float torque_range_n_mm;          /* of the motor (0, 1e6] */
    float torque_noise_n_mm;          /* one sigma of a torque sample, white [0, torque_range] */
    float torque_bias_n_mm;           /* bound of its offset [0, torque_range] */
    float angle_step_rad;             /* resolution of the motor's angle, joint side [1e-7, 0.01] */
    brace_takeup_bounds_t takeup;
} brace_backlash_params_t;

/* One tick's measurements, joint side of the reduction. */
typedef struct {
    uint32_t now_us;
    float motor_rad;       /* encoder before the gearbox, divided by the ratio [+-1e3] */
    float torque_n_mm;     /* motor torque, from current [+-10 torque_range] */
    bool load_is_expected; /* gravity, contact plan: what the joint should transmit, if anyone knows */
    float expected_n_mm;   /* [+-1e7] */
    float expected_off_n_mm; /* how far that may be off [0, 1e7] */
} brace_backlash_sample_t;

typedef struct {
    brace_backlash_state_t state;
    int flank;                   /* which one carries: +1, -1; 0: not told (UNKNOWN, CROSSING, TAKING_UP, FAULT) */
    bool valid;                  /* the load itself proves the flank, now. Never longer than
                                    brace_backlash_detection_us after the gap opened */
    float offset_rad;            /* joint angle = motor angle + offset; the best known in every state */
    float offset_off_rad;        /* half width of where the offset may lie, the gap being as believed */
    float load_n_mm;             /* transmitted load, 10 ms */
    float load_off_n_mm;         /* its bound: friction, inertia, bias, 6 sigma */
    brace_takeup_phase_t phase;
    brace_takeup_result_t takeup;
    float command_rad;           /* add to the motor's setpoint; 0 when IDLE */
    bool limit_torque;           /* the motor's torque has to be limited to +-takeup.torque_max_n_mm */
    float preload_n_mm;          /* HOLD: the load to subtract from what is measured; else 0. What friction hides of
                                    it on the standing motor is not known: off by up to the friction */
} brace_backlash_out_t;

/* State. Private; here so that it can be placed without a heap. */
typedef struct {
    brace_backlash_params_t params;
    float fast_gain, slow_gain, speed_gain, ticks_per_s;
    float fast_sigma_n_mm, slow_sigma_n_mm, least_preload_n_mm;
    uint32_t detection_us;

    bool started;
    uint32_t last_us;
    float motor_rad, anchor_rad, speed_rad_per_s;
    int direction;
    uint32_t same_way_us, standing_us;
    float fast_n_mm, fast_width_n_mm, slow_n_mm, slow_width_n_mm, slow_spread_n_mm, torque_n_mm;
    uint32_t positive_us, negative_us; /* how long the fast interval has been clear of zero */
    uint32_t untold_us;                /* how long no load has told the flank */
    float play_low_rad, play_high_rad; /* where motor - link lies within the gap */

    uint8_t state, phase;
    uint32_t state_us, phase_us, takeup_us;
    int chosen_flank;
    bool requested, let_go;
    float start_rad, verify_rad, command_rad, preload_n_mm;
    int8_t result;
} brace_backlash_t;

/* Prepares a joint, in UNKNOWN, with the play anywhere.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE (a parameter outside its range),
 *   BRACE_E_PARAMETER (torque_max does not exceed what a take-up needs to be seen)
 * cost: 1,200 instructions on a Cortex-M4F with a tick of 1 ms, up to 10,000 with one of 0.1 ms; stack at most 300
 * bytes. Not for the tick. */
brace_status_t brace_backlash_init(brace_backlash_t *joint, const brace_backlash_params_t *params);

/* One tick. Call once every tick_us; a gap of more than four ticks is a FAULT (the filters know nothing of it).
 *   out: always written but for BRACE_E_NULL; in FAULT: not valid, flank 0
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE (a sample out of range: FAULT)
 * cost on a Cortex-M4F: 490 instructions in the mean, at most 700 (take-up running); stack at most 100 bytes. */
brace_status_t brace_backlash_tick(brace_backlash_t *joint, const brace_backlash_sample_t *sample,
                                   brace_backlash_out_t *out);

/* After this long with the gap open the flank is not valid [us]; what brace_backlash_init worked out. 0 for null. */
uint32_t brace_backlash_detection_us(const brace_backlash_t *joint);

/* The least preload of a take-up, whatever is wished: friction, bias, eighteen sigma of the fast filter [N mm]; with
 * noise of 5 % of range, 21 % of range and the friction. 0 for null. */
float brace_takeup_preload_min_n_mm(const brace_backlash_t *joint);

/* Asks for the play to be taken up against a flank. The motor's setpoint then has to follow out.command_rad, and its
 * torque has to be limited while out.limit_torque says so. Something has to hold the link.
 *   flank: +1 or -1
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_RANGE (another flank, a take-up is under way, FAULT) */
brace_status_t brace_takeup_request(brace_backlash_t *joint, int flank);

/* Ends a take-up at any phase: the command goes back at its rate, then IDLE. With several joints let go in the reverse
 * order of taking up, each when the one before is IDLE.
 * returns BRACE_OK, BRACE_E_NULL */
brace_status_t brace_takeup_let_go(brace_backlash_t *joint);

/* Shift of the tip by two joints' offsets, and how far it can be shifted by their gaps: gap times lever.
 *   pose: levers at the posture
 *   offset1_rad, offset2_rad [+-0.5]: of theta1 and theta2 (out.offset_rad). theta2 is flexion: a positive offset
 *     turns the tibia clockwise.
 *   shift (out) [mm]: displacement of the tip from where the motor angles alone would put it
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE
 * cost: 60 instructions */
brace_status_t brace_backlash_tip_shift(const brace_pose_t *pose, float offset1_rad, float offset2_rad,
                                        brace_point_t *shift);

#endif
