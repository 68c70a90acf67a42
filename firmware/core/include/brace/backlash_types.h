/* Types of the preload state machine; brace/backlash.h says what they are for. */
#ifndef BRACE_BACKLASH_TYPES_H
#define BRACE_BACKLASH_TYPES_H

#include <stdbool.h>
#include <stdint.h>

#define BRACE_BACKLASH_LEAST_GAP_RAD 1e-5f /* below it there is no play to watch */

typedef enum {
    BRACE_BACKLASH_UNKNOWN = 0,          /* no flank is known: no load has shown one yet, or none for 250 ms */
    BRACE_BACKLASH_TAKING_UP = 1,        /* a take-up moves the motor through the gap */
    BRACE_BACKLASH_ENGAGED_POSITIVE = 2, /* the positive side is loaded */
    BRACE_BACKLASH_ENGAGED_NEGATIVE = 3,
    BRACE_BACKLASH_CROSSING = 4, /* the link left its flank unloaded, the next is not known; UNKNOWN after 2 s */
    BRACE_BACKLASH_FAULT = 5,    /* samples were bad or late; left after 20 ms of good ones */
    BRACE_BACKLASH_STATE_COUNT = 6
} brace_backlash_state_t;

typedef enum {
    BRACE_TAKEUP_IDLE = 0,
    BRACE_TAKEUP_APPROACH = 1, /* the command moves to the flank */
    BRACE_TAKEUP_VERIFY = 2,   /* the command stands, and the load has to stay */
    BRACE_TAKEUP_HOLD = 3,     /* the flank is verified: measure now, and subtract the preload */
    BRACE_TAKEUP_LET_GO = 4,   /* the command goes back the way it came */
    BRACE_TAKEUP_PHASE_COUNT = 5
} brace_takeup_phase_t;

/* How the last take-up went; kept until the next request. */
typedef enum {
    BRACE_TAKEUP_NONE = 0,
    BRACE_TAKEUP_RUNNING = 1,
    BRACE_TAKEUP_DONE = 2,      /* the chosen flank was verified */
    BRACE_TAKEUP_E_TORQUE = -1, /* the motor torque passed its bound */
    BRACE_TAKEUP_E_TRAVEL = -2, /* the motor went further than the gap allows: nothing holds the link */
    BRACE_TAKEUP_E_REACH = -3,  /* the command went to its end without the load: the motor does not follow */
    BRACE_TAKEUP_E_TIME = -4,   /* the flank was not verified within time_max_us */
    BRACE_TAKEUP_E_VERIFY = -5, /* the load or the motor did not stay during verification */
    BRACE_TAKEUP_E_LOST = -6,   /* the flank was verified, and later the load went away */
    BRACE_TAKEUP_E_FAULT = -7   /* the joint went to FAULT during the take-up */
} brace_takeup_result_t;

typedef struct {
    float torque_max_n_mm;    /* bound of the motor torque [1e-3, torque_range]; above
                                 brace_takeup_preload_min_n_mm + friction_n_mm */
    float preload_n_mm;       /* load wanted on the flank; raised to what can be verified [0, torque_max] */
    float travel_max_rad;     /* bound of the motor's travel; more than the gap and its wind-up (0, 1] */
    float reach_max_rad;      /* bound of the command; more than travel and the servo's droop at torque_max (0, 2] */
    float rate_rad_per_s;     /* rate of the command (0, 10] */
    uint32_t time_max_us;     /* longest time from the request to a verified flank [1, 6e7] */
    uint32_t verify_us;       /* time for which the load has to stay [20 000, 1e7] */
} brace_takeup_bounds_t;

/* A joint and its drive, as in brace_joint_t and brace_drive_t. A member without a range here has its range in
 * brace/ranges.h. */
typedef struct {
    uint32_t tick_us;                 /* period of brace_backlash_tick [100, 5000] */
    float gap_rad;                    /* full width as the model has it, from 1e-5 on; 20 % error is expected */
    float friction_n_mm;              /* Coulomb friction of motor and gears, before the gap */
    float friction_tolerance_ratio;   /* how far friction_n_mm may be off; for gears use 1 (docs/backlash.md) */
    float inertia_n_mm_s2_per_rad;    /* inertia of motor and gears, joint side; trusted to 25 % */
    float torque_range_n_mm;          /* range of the motor's torque */
    float torque_noise_n_mm;          /* one sigma of a torque sample, white [0, torque_range] */
    float torque_bias_n_mm;           /* bound of the torque's offset [0, torque_range] */
    float angle_step_rad;             /* resolution of the motor's angle, joint side */
    brace_takeup_bounds_t takeup;
} brace_backlash_params_t;

/* One tick's measurements, joint side of the reduction. */
typedef struct {
    uint32_t now_us;
    float motor_rad;       /* encoder before the gearbox, divided by the ratio [+-1e3] */
    float torque_n_mm;     /* motor torque, from current [+-10 torque_range] */
    bool load_is_expected; /* someone knows the load from gravity or a contact plan, and expected_n_mm holds it */
    float expected_n_mm;   /* load that the joint should transmit [+-1e7] */
    float expected_off_n_mm; /* how far expected_n_mm may be off [0, 1e7] */
    bool stands;           /* a take-up stands where it is: its command and its phase stay, and its time */
} brace_backlash_sample_t;

typedef struct {
    brace_backlash_state_t state;
    int flank; /* side that is loaded: +1 or -1; 0: not known (UNKNOWN, CROSSING, TAKING_UP, FAULT) */
    bool valid; /* the load itself proves the flank, now. Never longer than
                                    brace_backlash_detection_us after the gap opened */
    float offset_rad; /* joint angle = motor angle + offset; the best estimate in every state */
    float offset_off_rad; /* half width of where the offset may lie if the gap is gap_rad */
    float load_n_mm; /* transmitted load, 10 ms */
    float load_off_n_mm; /* bound of load_n_mm's error: friction, inertia, bias, 6 sigma */
    brace_takeup_phase_t phase;
    brace_takeup_result_t takeup;
    float command_rad; /* add to the motor's setpoint; 0 when IDLE */
    bool limit_torque; /* the motor's torque has to be limited to +-takeup.torque_max_n_mm */
    float preload_n_mm; /* in HOLD: the load to subtract from a measurement; else 0. On a standing motor
                                    friction hides a part of it, so it is off by up to the friction */
} brace_backlash_out_t;

/* State. Private: it is public only so that a caller can place it without a heap. */
typedef struct {
    brace_backlash_params_t params;
    float fast_gain, slow_gain, speed_gain, ticks_per_s;
    float fast_sigma_n_mm, slow_sigma_n_mm, least_preload_n_mm;
    uint32_t detection_us;

    bool started; /* what is above follows from the parameters and stays, what is below is the state */
    uint32_t last_us;
    float motor_rad, anchor_rad, speed_rad_per_s;
    int direction;
    uint32_t same_way_us, standing_us;
    float fast_n_mm, fast_width_n_mm, slow_n_mm, slow_width_n_mm, slow_spread_n_mm, torque_n_mm;
    uint32_t positive_us, negative_us; /* how long the fast interval has been clear of zero */
    uint32_t undecided_us; /* how long no load has shown the flank */
    float play_low_rad, play_high_rad; /* where motor - link lies within the gap */

    uint8_t state, phase;
    uint32_t state_us, phase_us, takeup_us;
    int chosen_flank;
    bool requested, let_go;
    float start_rad, verify_rad, command_rad, preload_n_mm;
    int8_t result;
} brace_backlash_t;

#endif
