/* The limb controller: sensors in, K out, once a tick; everything it does besides, it does a bounded piece of per tick.
 *
 *     joint_read -> backlash (per joint) -> true angles -> K -> supervisor -> snapshot
 *                                                            -> services (take-up, loading test, store, buses)
 *
 * One brace_app_t per limb, no global state: many limbs run in one process. Knows the world through brace_hal_t only.
 * No heap, no recursion, no stdio, no clock of its own; one caller, not from an interrupt.
 */
#ifndef BRACE_APP_H
#define BRACE_APP_H

#include "brace/backlash.h"
#include "brace/gap_stiffness.h"
#include "brace/kinematics.h"
#include "brace/parameters.h"
#include "brace/stiffness.h"
#include "brace_hal.h"

typedef enum {
    BRACE_MODE_START = 0,
    BRACE_MODE_MONITOR = 1,       /* K every tick; the limb is moved by others */
    BRACE_MODE_CONFIGURATION = 2, /* parameters may be written; nothing moves the limb, K is flagged */
    BRACE_MODE_TAKING_UP = 3,     /* play is being taken up or let go */
    BRACE_MODE_LOADING_TEST = 4,
    BRACE_MODE_FAULT = 5          /* a fault that makes every K invalid; left by itself when the fault is over */
} brace_mode_t;

/* Faults, as bits; each stays while its cause does. */
enum {
    BRACE_FAULT_SENSOR_FEMUR = 1u << 0,   /* no sound sample of the joint */
    BRACE_FAULT_SENSOR_TIBIA = 1u << 1,
    BRACE_FAULT_ENCODER_STUCK = 1u << 2,  /* torque works and the angle does not follow */
    BRACE_FAULT_TICK_LATE = 1u << 3,      /* the tick came more than two periods late */
    BRACE_FAULT_PARAMETERS = 1u << 4,     /* no valid set in either slot: safe defaults, UNCALIBRATED */
    BRACE_FAULT_STORE = 1u << 5,          /* the non-volatile memory does not keep what is written */
    BRACE_FAULT_CAN_BUS_OFF = 1u << 6,
    BRACE_FAULT_MODEL_DRIFT = 1u << 7,    /* measurement and model have drifted apart */
    BRACE_FAULT_CRASHED = 1u << 8         /* the last start was after a crash; see the record */
};

/* Where the parameters in force come from. */
typedef enum {
    BRACE_PARAMETERS_DEFAULT = 0,
    BRACE_PARAMETERS_SLOT_A = 1,
    BRACE_PARAMETERS_SLOT_B = 2
} brace_parameter_origin_t;

/* What a tick says, whole: everything in it is from the same samples. */
typedef struct {
    uint32_t sequence;    /* of the tick; wraps */
    uint32_t taken_us;    /* when the joints were sampled */
    brace_mode_t mode;
    uint32_t faults;      /* BRACE_FAULT_... */
    bool k_is_valid;      /* stiffness may be used, with its flags; else it holds the last one or zeroes */
    brace_gap_stiffness_t stiffness; /* now (GAP_OPEN counted) and once every gap has closed; both carry the flags */
    float theta_rad[BRACE_LINK_COUNT];       /* true joint angles, backlash and zero offset taken into account */
    float motor_rad[BRACE_LINK_COUNT];
    float torque_n_mm[BRACE_LINK_COUNT];
    brace_backlash_out_t play[BRACE_LINK_COUNT]; /* [0] (coxa) stays UNKNOWN: the limb's plane has two joints */
    brace_point_t tip_mm;
    brace_point_t play_shift_mm; /* of the tip, by the joints' play: the zero-force shift */
    float force_x_n, force_z_n;  /* on the tip: sensor, or from the joints' loads */
    float temp_degc;
    uint32_t parameter_crc;
    brace_parameter_origin_t parameter_origin;
} brace_snapshot_t;

#endif
