/* Joints that are Dynamixel servos (Protocol 2.0) on one serial line: MX-106, MX-64, XM430, XM540, XH540.
 *
 * A board gives the line (brace_servo_line_t), calls brace_dynamixel_serve between its ticks, and puts
 * brace_dynamixel_read and brace_dynamixel_command behind the door's joint entries. Nothing here waits: a request
 * leaves in one call, and its answers are taken in later ones, while the tick runs or the line is busy. One caller,
 * as brace_hal.h says.
 *
 * These servos have one encoder, behind the gear, with 4096 steps a turn. So a sample has link_rad, and motor_rad is
 * NaN. taken_us is the time at which the request left; the servo read its encoder up to 0.2 ms later. The torque is
 * the current times the manual's stall torque over stall current, which has the gear in it, times torque_ratio.
 *
 * docs/joints.md says how to wire and set up the servos, and what a driver for another maker's has to do.
 */
#ifndef BRACE_DYNAMIXEL_H
#define BRACE_DYNAMIXEL_H

#include "brace_dxl_packet.h"
#include "brace_hal.h"

enum { BRACE_SERVO_JOINTS = 3, BRACE_SERVO_NO_ID = 255 };

/* A half-duplex line. Whoever provides it turns the direction round: sending from the first bit to the last, then
 * receiving. What is received while sending may be dropped or given: a line that hears itself disturbs nothing. */
typedef struct {
    void *context;
    /* Sends all bytes in one piece, and does not wait for their end. OK; AGAIN: it is still sending; E_DEVICE. The
     * bytes may change afterwards. */
    int32_t (*send)(void *context, const uint8_t *bytes, uint32_t count);
    /* Gives what has come, at most room bytes; the count, or E_DEVICE. */
    int32_t (*receive)(void *context, uint8_t *bytes, uint32_t room);
} brace_servo_line_t;

typedef struct {
    uint8_t id;         /* [0, 252]; BRACE_SERVO_NO_ID: the limb has no such joint */
    bool is_reversed;   /* the joint's angle grows while the servo's falls */
    float zero_rad;     /* joint angle where the servo reads 2048, the middle of its turn */
    float torque_ratio; /* true torque / torque by the manual's constant; 1 where nobody measured it */
} brace_servo_joint_t;

typedef struct {
    brace_servo_joint_t joint[BRACE_SERVO_JOINTS]; /* coxa, femur, tibia */
    uint32_t period_us;  /* between two requests [500, 100000] */
    uint32_t timeout_us; /* an answer that has not come by then is lost [300, 100000] */
    bool holds;          /* a servo found without torque is commanded to stand where it is, with its torque on */
} brace_servo_setup_t;

typedef enum {
    BRACE_SERVO_NONE = 0,     /* the limb has no such joint */
    BRACE_SERVO_SILENT = 1,   /* does not answer; asked again every 50 ms */
    BRACE_SERVO_STARTING = 2, /* answers, and is being identified */
    BRACE_SERVO_READY = 3,
    BRACE_SERVO_UNKNOWN = 4,  /* refused: no model of ours, or one that measures no current */
    BRACE_SERVO_MODE = 5,     /* refused: it is in no position mode (3, 4 or 5), or its drive mode is reversed, or it
                               * waits for more than a quarter of timeout_us before it answers, or it stands beyond its
                               * position limits in mode 3, or it refused ten times in a row what sets it up */
    BRACE_SERVO_FAILED = 6    /* has switched itself off: hardware_error says why. Only a reboot helps */
} brace_servo_state_t;

typedef struct {
    brace_servo_state_t state;
    uint16_t model;
    uint8_t firmware, operating_mode;
    uint8_t hardware_error; /* its register 70: 1 voltage, 4 heat, 8 encoder, 16 electrical shock, 32 overload */
    bool has_torque;        /* its torque is switched on */
    float velocity_rad_per_s, temp_degc;
    float goal_rad;         /* set-point that it has been sent; NaN before */
    uint32_t samples;       /* all counters saturate */
    uint32_t lost;          /* answers that did not come */
    uint32_t doubted;       /* samples that no servo can report, or that jumped and wait until the next one agrees */
    uint32_t refused;       /* answers with an error number */
    uint32_t restarts;      /* how often it has lost its set-up */
} brace_servo_report_t;

typedef struct {
    uint32_t requests, answers; /* packets sent that ask for an answer; packets of status that have come */
    uint32_t damaged;           /* packets with a wrong CRC or length */
    uint32_t skipped_bytes;     /* bytes of no sound packet */
    uint32_t foreign;           /* sound packets that nobody asked for, without our own echo */
    uint32_t line_busy;         /* requests that the line did not take */
} brace_servo_counters_t;

/* ------------------------------------------------------------------------------------------ the driver -- */

typedef struct {
    int32_t current, velocity, position;
    uint32_t taken_us;
} brace_servo_raw_t;

typedef struct {
    brace_servo_report_t report;
    uint8_t step;               /* of being identified */
    uint8_t misses;             /* in a row */
    bool is_new, state_is_due, temperature_is_next;
    uint8_t drive_mode, return_delay;
    uint8_t refusals;           /* in a row, while it is being identified */
    bool has_sample, has_wild, has_goal;
    bool has_limits;            /* the limits are what the servo has said, once */
    bool has_place;             /* goal_sent is where the servo has said that it stands or is to stand, once */
    brace_servo_raw_t sample, wild;
    uint32_t asked_us;          /* when it was last asked while silent */
    float torque_per_count_n_mm;
    float offset_rad, limit_n_mm;
    uint32_t commanded_us;
    bool is_commanded;
    bool goes_back;             /* nobody commands the offset any more */
    int32_t base, goal_sent;    /* set-point without the offset, and with it as sent */
    int32_t place_least;        /* goals that the servo takes in mode 3: from here */
    int32_t place_most;         /* to here */
    uint16_t current_limit, current_sent;
} brace_servo_t;

typedef struct {
    brace_servo_setup_t setup;
    brace_servo_line_t line;
    uint32_t now_us, began_us, refreshed_us, faded_us;
    bool has_begun;
    uint8_t pending;            /* what is asked for */
    uint8_t asked;              /* joints that have still to answer, as bits */
    uint8_t listed[BRACE_SERVO_JOINTS], listed_count; /* joints of a sync read, in order */
    uint8_t cared;              /* joint of a single request */
    uint8_t next_cared, until_care;
    bool is_plain, fast_has_worked; /* the servos do not know the fast sync read, as it seems */
    uint8_t silences;           /* sync reads in a row that nobody answered */
    brace_servo_t servo[BRACE_SERVO_JOINTS];
    brace_servo_counters_t counters;
    dxl_out_t out;
    dxl_receiver_t receiver;
} brace_dynamixel_t;

/* Forgets everything; the next call of serve asks the first servo who it is.
 * returns OK, or E_RANGE: an id twice, none at all for femur or tibia, or a number out of its range */
int32_t brace_dynamixel_start(brace_dynamixel_t *driver, const brace_servo_setup_t *setup,
                              const brace_servo_line_t *line);

/* Takes what has come and sends what is due. Call it between any two ticks, or as often as there is time. It reads at
 * most 128 bytes of the line. */
void brace_dynamixel_serve(brace_dynamixel_t *driver, uint32_t now_us);

/* As joint_read and joint_command in brace_hal.h. A finite torque limit needs operating mode 5 (current-based
 * position); in another mode it is E_UNSUPPORTED.
 *   read: E_DEVICE: the servo is silent or refused. AGAIN before the first sample leaves joint as it is
 *   command: E_DEVICE: the servo is silent, refused, or has no torque; or an offset that nobody has commanded for 100
 *   ms goes back, and the command is more than 0.02 rad away from it */
int32_t brace_dynamixel_read(brace_dynamixel_t *driver, int32_t joint_index, brace_hal_joint_t *joint);
int32_t brace_dynamixel_command(brace_dynamixel_t *driver, int32_t joint_index,
                                const brace_hal_joint_command_t *command);

/* The posture's set-point of a joint, to which command's offset is added. OK, E_RANGE, E_UNSUPPORTED, E_DEVICE */
int32_t brace_dynamixel_move(brace_dynamixel_t *driver, int32_t joint_index, float angle_rad);

void brace_dynamixel_report(const brace_dynamixel_t *driver, int32_t joint_index, brace_servo_report_t *report);
void brace_dynamixel_counters(const brace_dynamixel_t *driver, brace_servo_counters_t *counters);

/* The maker's name of a model; null: unknown. */
const char *brace_dynamixel_name(uint16_t model);

#endif
