/* The limb controller: sensors in, K out, once a tick; all else it does in bounded pieces, one per tick.
 *
 *     joint_read -> backlash (per joint) -> true angles -> K -> supervisor -> snapshot
 *                                              -> services (take-up, loading test, store, buses)
 *
 * One brace_app_t (16 kB, 12 of them the recorder) per limb, no global state: many limbs run in one
 * process. Knows the world through brace_hal_t only. No heap, no recursion, no stdio, no clock of its own;
 * one caller, not from an interrupt.
 *
 * When K is valid: the mode is MONITOR, TAKING_UP or LOADING_TEST; the newest sound sample of both joints
 * is no older than controller.age_limit_us; the posture is inside both drives' travel; parameters are in
 * force (safe defaults count, flagged UNCALIBRATED). A joint with play (gap_rad >= 1e-5) whose load does
 * not prove a flank carries nothing: K is then valid, flagged GAP_OPEN, with both bounds. So it is with one whose
 * newest sample is more than four ticks old (its drive answers AGAIN), and for 20 ms after: choose a tick no shorter
 * than a quarter of the drives' own. A flank is thus proven at most brace_backlash_detection_us
 * and four ticks after its gap has opened.
 */
#ifndef BRACE_APP_H
#define BRACE_APP_H

#include "brace/backlash.h"
#include "brace/can_messages.h"
#include "brace/drift.h"
#include "brace/gap_stiffness.h"
#include "brace/journal.h"
#include "brace/general.h"
#include "brace/kinematics.h"
#include "brace/loading.h"
#include "brace/measured.h"
#include "brace/parameters.h"
#include "brace/planar.h"
#include "brace/recorder.h"
#include "brace/stiffness.h"
#include "brace/store.h"
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

/* Faults that make every K invalid and the mode FAULT. A fault is over when its cause has been away for
 * 100 ms, TICK_LATE for 1 s; PARAMETERS and STORE last until a set is stored, MODEL_DRIFT and CRASHED
 * until cleared on request. */
#define BRACE_FAULTS_NO_K (BRACE_FAULT_SENSOR_FEMUR | BRACE_FAULT_SENSOR_TIBIA | BRACE_FAULT_ENCODER_STUCK)

/* What a tick says, whole: everything in it is from the same samples. */
typedef struct {
    uint32_t sequence;    /* counts snapshots; wraps */
    uint32_t taken_us;    /* when the joints were sampled, the older one */
    brace_mode_t mode;
    uint32_t faults;      /* BRACE_FAULT_... */
    bool k_is_valid;      /* stiffness may be used, with its flags; else flags say why, and what was not computed is
                             NaN */
    brace_gap_stiffness_t stiffness; /* now (GAP_OPEN counted) and once every gap has closed; both carry the flags */
    float theta_rad[BRACE_LINK_COUNT];       /* true joint angles, backlash and zero offset counted; NaN: not known */
    float motor_rad[BRACE_LINK_COUNT];
    float torque_n_mm[BRACE_LINK_COUNT];
    brace_backlash_out_t play[BRACE_LINK_COUNT]; /* [0] (coxa) stays UNKNOWN: the limb's plane has two joints */
    brace_point_t tip_mm;
    brace_point_t play_shift_mm; /* of the tip, by the joints' play: the zero-force shift */
    float force_x_n, force_z_n;  /* of the ground on the tip; NaN: not known */
    bool force_is_sensed;        /* by the tip's sensor, corrected; else from the joints' loads */
    float temp_degc;             /* of the joints, the warmer one; NaN: not measured */
    uint32_t parameter_crc;
    brace_parameter_origin_t parameter_origin;
} brace_snapshot_t;

/* Counters of what went wrong without a word; each stays at its largest value. */
typedef struct {
    uint32_t ticks_late;
    uint32_t samples_bad;     /* refused, not finite or out of range */
    uint32_t frames_refused;  /* by the bus: no room, bus off */
    uint32_t frames_unknown;  /* received, of no kind that is known, or a request of another length or form */
    uint32_t commands_failed; /* joint_command refused */
    uint32_t modbus_broken;   /* frames with a wrong CRC or length */
    uint32_t modbus_refused;  /* answered with an exception */
} brace_app_counters_t;

/* ---------------------------------------------------------------------------------------------- private --
 * The controller's memory; here so that it can be placed without a heap. Nothing in it is for others. */

enum { BRACE_APP_JOINTS = 2 }; /* femur and tibia: [0] and [1] wherever only the plane's joints count */

typedef struct {
    brace_hal_joint_t sample; /* the last sound one; NaN before the first */
    uint8_t seen;             /* samples since there was none for too long; counts to 3 */
    bool sound, stuck;
    bool proves;              /* sound, and new enough to prove a flank */
    float still_rad;          /* where the angle has stayed, for how long, and what torque and link did meanwhile */
    float torque_n_mm, torque_low_n_mm, torque_high_n_mm, link_low_rad, link_high_rad;
    uint32_t still_us;
} brace_app_joint_t;

typedef struct {
    brace_backlash_t backlash;
    bool watched;             /* the joint has play, and its state machine is set up */
    bool unwatchable;         /* it has, and its drive can not be set up for it: taken as open */
} brace_app_play_t;

typedef struct {
    brace_planar_t planar;    /* when the limb collapses and nothing changes its springs */
    bool collapsed;
    brace_general_t general;  /* else */
    float spring_rad_per_n_mm[BRACE_APP_JOINTS], rotation_rad_per_n_mm;
    float warm_per_degc, reference_degc;
    float hardening_n_mm_per_rad3[BRACE_APP_JOINTS];
    float deflection_rad[BRACE_APP_JOINTS];
} brace_app_model_t;

/* K of the samples in snapshot[next], on its way. */
typedef struct {
    uint8_t done;             /* pieces; 0: none is on its way */
    bool inside, posed, sound; /* within travel; where there are levers; the samples */
    uint8_t waits;            /* ticks since there was one */
    bool is_fresh, told;      /* of the last samples; this tick ends it */
    bool blind;               /* the last tick took no samples: this one does */
    bool advances;            /* the loading test has yet to go on with the newest */
    float spring_rad_per_n_mm[BRACE_APP_JOINTS]; /* hip, with the base's rotation, and knee, at the moment */
    brace_status_t status;
    brace_stiffness_t engaged;
} brace_app_k_t;

typedef struct {
    bool fitted;              /* there is a sensor, and its matrix has an inverse */
    bool known;               /* x_n, z_n are no older than controller.age_limit_us */
    uint32_t age_us;          /* since the sensor last gave a new reading */
    float x_n, z_n;
    float inverse[4];
} brace_app_sensor_t;

typedef struct {
    uint32_t away_us[9];      /* how long the cause of each fault has been away */
    uint32_t latched;         /* faults that only a request clears */
} brace_app_supervisor_t;

typedef struct {
    uint8_t order[BRACE_APP_JOINTS]; /* joints in the order of taking up */
    uint8_t count;                   /* taken up or being taken up */
    bool begun;                      /* the last one has left IDLE */
    bool letting_go;
} brace_app_takeup_t;

enum { BRACE_APP_LINE_BYTES = 32, BRACE_APP_IN_BYTES = 24, BRACE_APP_ANSWERS = 8 };

/* CAN as text over a serial port (LAWICEL's SLCAN). */
typedef struct {
    bool fitted;
    bool open, listen_only;   /* the channel, as whoever is at the other end wants it */
    bool too_long, heard;     /* the line; and something has come in this tick */
    uint8_t line[BRACE_APP_LINE_BYTES], in[BRACE_APP_IN_BYTES], out[BRACE_APP_LINE_BYTES];
    uint8_t line_count, in_first, in_count, out_first, out_count;
} brace_app_slcan_t;

typedef struct {
    bool listens, speaks;     /* CAN is there; the node's number is set */
    uint8_t node_id;
    uint32_t bit_rate, fd_bit_rate; /* as they were set up; 0: no CAN FD */
    bool bus_off;
    uint32_t health_us, recover_us, recover_wait_us;
    brace_app_slcan_t slcan;
} brace_app_bus_t;

typedef struct {
    bool speaks;              /* in this tick, besides answering */
    uint8_t frames;           /* of process data, at most, in this tick */
    uint8_t lines;            /* of answers over SLCAN, at most, in this tick */
    uint8_t left_out;         /* ticks in a row without a piece of K, or of other work */
    uint8_t test_waits;       /* how often a loading test's piece has waited for a question */
    uint8_t waited;           /* ticks, for answers to leave over SLCAN */
    uint32_t beat_us;         /* when the heart beat last */
    uint32_t faults_told;
    brace_mode_t mode_told;
} brace_app_report_t;

/* Process data: the frames of one snapshot, and when the next is due. */
typedef struct {
    uint32_t parameter_crc;   /* of the set that periods were worked out from */
    uint32_t period_us, next_us;
    uint32_t stiffness_every, posture_every, stiffness_in, posture_in; /* snapshots; every 0: never */
    uint32_t frames_per_tick;
    uint8_t due;              /* frames of this snapshot still to be sent */
    bool fd;                  /* periods are those of CAN FD's frame */
    uint32_t taken_us;
    brace_can_snapshot_fd_t whole;
    brace_can_stiffness_a_t stiffness_a;
    brace_can_stiffness_b_t stiffness_b;
    brace_can_eigenvalues_t eigenvalues;
    brace_can_posture_t posture;
} brace_app_cyclic_t;

typedef struct {
    bool waiting;             /* request holds one to be answered */
    bool serves, refuses;     /* this tick answers it; there is no time for it */
    uint8_t request[8];
    uint8_t answer[BRACE_APP_ANSWERS][8];
    uint8_t answer_first, answer_count;
    uint8_t storing, storing_token; /* the request that is answered when the store is done; 0: none */
    bool upload_open;
    uint32_t upload_next, upload_crc; /* words so far; the CRC that it will end with */
    uint32_t upload_sum;      /* CRC of all but the last word */
    uint8_t upload[BRACE_BLOCK_BYTES];
    uint32_t download_next, download_crc, download_set; /* words so far, of the set with that CRC */
} brace_app_requests_t;

typedef struct {
    uint32_t fed_us;          /* when CONFIGURATION was last asked for anything */
    bool begun;               /* set holds what is written; begun as a copy of what is in force */
    brace_parameters_t set;
} brace_app_staging_t;

/* What the drift check knows, as it is kept. */
typedef struct {
    brace_journal_t journal;
    bool look;                /* the check has learned something since last asked, or a record is being written */
    uint8_t ticks;            /* since the last piece */
    uint8_t state;            /* of the check, in the newest record */
    uint32_t steps;
    float evidence[BRACE_DRIFT_CAUSE_COUNT + 1];
} brace_app_keeping_t;

enum { BRACE_APP_ADU_BYTES = 260, BRACE_APP_ASKED = 11 };

typedef struct {
    bool begun, checked;
    uint8_t area;
    uint16_t start, count, done; /* values */
    bool half_known;             /* of a value written in two requests, one after the other on this port: */
    uint16_t half, half_place;   /* the high one, and its register */
} brace_app_modbus_work_t;

typedef struct {
    bool there, drop;
    uint8_t phase;
    uint16_t count, checked, sent, crc;
    uint32_t heard_us;
    brace_app_modbus_work_t work;
    uint8_t bytes[BRACE_APP_ADU_BYTES]; /* the request, then its answer */
} brace_app_modbus_link_t;

typedef struct {
    brace_app_modbus_link_t line, tcp;
    bool polls_tcp, turn;
    uint8_t address;
    uint16_t messages, broken, refused, served, unanswered, busy; /* function 08's counters; wrap */
    uint16_t waited;              /* ticks since its last turn */
    bool polls, serves, all;      /* in this tick; all steps of a request at once */
    uint32_t silence_us, take_up, asked[BRACE_APP_ASKED];
    brace_answered_t answered;
} brace_app_modbus_t;

typedef struct {
    const brace_hal_t *hal;
    brace_parameters_t parameters;
    uint32_t parameter_crc;
    brace_parameter_origin_t origin;
    brace_store_t store;
    bool storing;            /* the store is at work */
    uint8_t configure_piece; /* 0: nothing is to be put in force */
    bool configures_fresh;   /* what is put in force has just been written */
    brace_app_staging_t staging;

    brace_mode_t mode;
    uint32_t faults, lasting_faults, last_us, tick_us, start_us, sequence;
    float torque_share;    /* that a sample has in its joint's mean torque */
    int joint_of_tick;     /* the joint that this tick looks after: one a tick is enough */
    bool ticked;
    bool told;               /* the drives hold a command of ours */
    bool posed;
    brace_pose_t pose;       /* of the newest posture */

    brace_app_joint_t joint[BRACE_APP_JOINTS];
    brace_app_play_t play[BRACE_APP_JOINTS];
    brace_app_model_t model;
    brace_app_sensor_t sensor;
    brace_app_supervisor_t supervisor;
    brace_app_takeup_t takeup;
    brace_app_bus_t bus;
    brace_app_report_t report;
    brace_app_modbus_t modbus;
    brace_app_cyclic_t cyclic;
    brace_app_requests_t requests;
    brace_loading_t loading;
    brace_drift_t drift;
    brace_app_keeping_t keeping;
    brace_recorder_t recorder;
    brace_app_counters_t counters;

    brace_app_k_t k;
    brace_snapshot_t snapshot[3]; /* the newest; the next, and what is sensed while that one waits for its K */
    uint8_t newest, next;
} brace_app_t;

/* ---------------------------------------------------------------------------------------------- running -- */

/* Starts a controller: reads the parameters in force from the store, sets up CAN (listen only while the
 * node's number is unset), and is in START until the first ticks have brought sound samples.
 *   hal: lives as long as app; entries that are not optional must be there
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER (a mandatory entry is missing). Not for the tick: some
 * 10^4 instructions, and can_setup's 20 ms. */
brace_status_t brace_app_start(brace_app_t *app, const brace_hal_t *hal);

/* One tick; to be called every parameters.controller.tick_us.
 *   now_us: the HAL's clock; may wrap
 * cost on a Cortex-M4F: at most 4,000 instructions in every mode, HAL excluded; measured by the bench. */
void brace_app_tick(brace_app_t *app, uint32_t now_us);

/* The newest snapshot, whole: everything in it is of one tick's samples. Never null; its content stays until the
 * tick after next. Its sequence counts snapshots: a tick that works on a loading test's reading leaves the
 * one before; where a tick has no room for all of K it comes some ticks after its samples, and taken_us says when they
 * were taken. */
const brace_snapshot_t *brace_app_snapshot(const brace_app_t *app);

/* The parameters in force. */
const brace_parameters_t *brace_app_parameters(const brace_app_t *app);

const brace_app_counters_t *brace_app_counters(const brace_app_t *app);

/* --------------------------------------------------------------------------------------------- requests --
 * Between ticks or from a service within one. Each answers at once; what it starts goes on in the ticks.
 * All return BRACE_OK, BRACE_E_NULL, BRACE_E_MODE (not in this mode), and what is named. */

/* Takes up the play of one joint against a flank; when its take-up holds, the other joint may follow. From
 * MONITOR, or in TAKING_UP with every joint asked before holding. How it went: snapshot.play[].takeup. If
 * one fails, every joint is let go in the reverse order.
 *   joint_index: BRACE_FEMUR or BRACE_TIBIA; flank: +1 or -1
 * returns also BRACE_E_RANGE (joint, flank), BRACE_E_UNSUPPORTED (no play, or no joint_command) */
brace_status_t brace_app_take_up(brace_app_t *app, int32_t joint_index, int32_t flank);

/* Lets every joint go, last taken up first; MONITOR when the last is back. Ends a loading test too. */
brace_status_t brace_app_let_go(brace_app_t *app);

/* A loading test, from MONITOR or with the play taken up: brace/loading.h.
 * returns also BRACE_E_RANGE (setup), BRACE_E_UNSUPPORTED (no joint_command), BRACE_E_SINGULAR (the joints
 * cannot move the tip along the axis at this posture) */
brace_status_t brace_app_loading_start(brace_app_t *app, const brace_loading_setup_t *setup);

/* Ends it; the limb goes back to where it began. The rows so far stay. */
brace_status_t brace_app_loading_stop(brace_app_t *app);

/* The last loading test, or the one under way. Never null for a started app. */
const brace_loading_result_t *brace_app_loading_result(const brace_app_t *app);

/* Rows of the recorder, oldest first; BRACE_E_RANGE past the end. */
uint32_t brace_app_row_count(const brace_app_t *app);
brace_status_t brace_app_row(const brace_app_t *app, uint32_t index, brace_row_t *row);

/* Configuration: only here may parameters be stored; nothing moves the limb, K is not valid. Entered from
 * MONITOR or FAULT, left to START; by itself after BRACE_CONFIGURATION_PATIENCE_US in which nothing was written,
 * uploaded, stored, nor the mode asked for again: what was staged is forgotten, the set in force stays. */
enum { BRACE_CONFIGURATION_PATIENCE_US = 10000000 };
brace_status_t brace_app_configuration_enter(brace_app_t *app);
brace_status_t brace_app_configuration_leave(brace_app_t *app);

/* Stores a set and puts it in force once it has read back; in CONFIGURATION only. How it goes:
 * brace_app_store. What concerns buses (node, bit rates) takes effect at the next start.
 * returns also what brace_store_begin does, at its cost: for hosts, not within a tick */
brace_status_t brace_app_parameters_commit(brace_app_t *app, const brace_parameters_t *parameters);

/* Puts the set before the one in force back; in CONFIGURATION only.
 * returns also what brace_store_rollback does */
brace_status_t brace_app_parameters_rollback(brace_app_t *app);

/* The store and its state: brace_store_status. */
const brace_store_t *brace_app_store(const brace_app_t *app);

/* Clears MODEL_DRIFT (its detector watches on from the baseline it holds) and CRASHED. faults:
 * BRACE_FAULT_... bits
 * returns also BRACE_E_RANGE: a fault that is not cleared by request */
brace_status_t brace_app_clear(brace_app_t *app, uint32_t faults);

#endif
