/* A controller and its limb in one process: the firmware's application with a simulated limb. Any number of them share
 * one CAN bus. The caller gives the controller's parameter block and the true limb (the plant) separately.
 *
 * A limb has a servo with motor inertia and dry friction per joint. Behind the servos is the quasi-static limb of
 * host_sim/plant, whose tip a contact holds. Encoders, currents and a force sensor have their noise. A limb in which
 * something yields across its plane (joint.coxa's spring, a link's lateral compliance or torsion) has a coxa joint; of
 * any other limb, the coxa joint answers BRACE_HAL_E_UNSUPPORTED. host_sim/README.md says what is modelled and what is
 * not.
 *
 * Time is the simulation's own: brace_node_step advances it as fast as the machine can, brace_node_run keeps it in step
 * with the wall clock. The same arguments and seed give the same bits, as long as nobody talks to the limbs from
 * outside. One thread may be in brace_node_run while any other thread makes any other call. Two calls are exceptions:
 * call brace_node_destroy, and use brace_node_app directly, only while no brace_node_run is under way.
 */
#ifndef BRACE_NODE_H
#define BRACE_NODE_H

#include <stddef.h>
#include <stdint.h>

#include "brace/app.h"
#include "brace_host.h"

typedef struct brace_node brace_node_t;

enum { BRACE_NODE_LIMBS = 16 };

/* The true values of a joint's drive, on the joint's side of the reduction. */
typedef struct {
    double servo_n_mm_per_rad;       /* P gain: the droop under load is load / this (0, 1e9] */
    double servo_n_mm_s_per_rad;     /* D gain; NaN: critically damped */
    double inertia_n_mm_s2_per_rad;  /* inertia of motor and gears (0, 1e6] */
    double friction_n_mm;            /* Coulomb friction of motor and gears [0, 1e6] */
    double torque_range_n_mm;        /* (0, 1e6] */
    double torque_noise_n_mm;        /* one sigma of a sample [0, 1e6] */
    double torque_bias_n_mm;         /* offset of the samples */
    double angle_step_rad;           /* step of the motor's encoder [1e-9, 0.1] */
    double rate_rad_per_s;           /* rate at which the set-point moves (0, 100] */
    double friction_per_torque_ratio; /* share of the motor's torque that is added to friction_n_mm [0, 0.9] */
    double friction_per_load_ratio;  /* share of the load behind the gear that is added to it [0, 0.9] */
} brace_node_drive_t;

/* Where the contact holds the tip, relative to the tip of the unloaded limb: x and z in the limb's plane, y across it,
 * to the left when one looks outwards. Only limbs with a coxa joint have y. [-1e3, 1e3] each */
typedef struct {
    double x_mm, y_mm, z_mm;
} brace_node_press_t;

typedef struct {
    brace_plant_model_t plant;
    brace_node_drive_t drive[3];
    double theta_rad[3];             /* first set-points, commanded; the plant's zero offsets are added */
    double hold_n_per_mm;            /* stiffness of the contact; inf: the tip is held, 0: the tip is free */
    brace_node_press_t press;
    double force_noise_n;            /* one sigma of a reading [0, 1e6] */
    int32_t has_force_sensor;
    int32_t has_link_encoder;
    double temp_start_degc, temp_rise_degc, temp_time_constant_s; /* as the rig's */
    const uint8_t *block; /* the controller's parameter block; null: the controller finds an empty memory */
    uint32_t block_bytes;
    const char *nvm_path; /* file of its memory; null: the memory ends with the node */
    int32_t block_replaces; /* 0: the block is stored only if the file has none yet; 1: always */
    const char *console, *modbus_line, *slcan_line; /* URLs of serial ports, brace_hal_posix.h; null: no port */
    const char *modbus_tcp;
    /* Joints by Dynamixel servos, through the driver that boards use: "sim", simulated MX-106 between this limb and the
     * driver; or a serial device with real servos, /dev/ttyX@BAUD. Null: the joints are read without a line. Real
     * servos have no simulated limb behind them, and no force sensor; nobody moves them but the controller's own tests,
     * and only where their torque is on. */
    const char *servos;
    uint8_t servo_id[3]; /* of coxa, femur, tibia */
    int32_t servos_hold; /* real servos without torque are commanded to hold where they stand */
    const uint8_t *key; /* 16 bytes: the controller is guarded; null: it is a bench (docs/security.md) */
    /* how long whoever moves the limb may be silent, in the simulation's time; 0: 0.13 */
    double owner_silence_s;
} brace_node_limb_t;

/* The paper's limb, an MX-106 per joint, planted and unloaded at theta 0, 1.0, 1.4; 22 degC. Null is ignored. */
void brace_node_limb_default(brace_node_limb_t *limb);

typedef enum {
    BRACE_NODE_PART_NONE = 0,
    BRACE_NODE_PART_LIMB = 1, /* detail: a brace_host_status_t */
    BRACE_NODE_PART_BLOCK = 2, /* detail: a brace_status_t */
    BRACE_NODE_PART_MEMORY = 3, /* from here on, detail: a BRACE_POSIX_E_... */
    BRACE_NODE_PART_CAN = 4,
    BRACE_NODE_PART_CONSOLE = 5,
    BRACE_NODE_PART_MODBUS_LINE = 6,
    BRACE_NODE_PART_SLCAN_LINE = 7,
    BRACE_NODE_PART_MODBUS_TCP = 8,
    BRACE_NODE_PART_SERVOS = 9
} brace_node_part_t;

/* Why a node could not be made. */
typedef struct {
    brace_node_part_t part;
    int32_t detail;
    int32_t limb;
    int32_t system; /* errno of the refused call */
} brace_node_failure_t;

/* Makes the limbs and starts their controllers. The caller may free limbs[i] and all they point to afterwards.
 *   can: the bus' outside, as for brace_posix_bus_open; null: there is no CAN
 *   failure (out, may be null)
 * returns null when something is refused; then nothing stays open. */
brace_node_t *brace_node_create(const brace_node_limb_t *limbs, int32_t count, const char *can, uint64_t seed,
                                brace_node_failure_t *failure);
void brace_node_destroy(brace_node_t *node);

/* Where the outside connects; empty when there is no such port. Valid until the node is destroyed. port:
 * BRACE_SERIAL_... */
const char *brace_node_can_place(const brace_node_t *node);
const char *brace_node_serial_place(const brace_node_t *node, int32_t limb, int32_t port);

/* One line of English for a BRACE_POSIX_E_... */
const char *brace_node_posix_text(int32_t status);

/* Advances by a time [0, 1e9 us], as fast as possible. returns the simulation's time [us]. */
uint64_t brace_node_step(brace_node_t *node, uint64_t time_us);

/* Runs in step with the wall clock until the simulation's time is until_us or brace_node_stop is called. Blocks all
 * signals in its thread. brace_node_stop ends every later run, too; brace_node_step goes on working.
 * returns the time of the last tick, at most until_us. */
uint64_t brace_node_run(brace_node_t *node, uint64_t until_us);
void brace_node_stop(brace_node_t *node);

/* The calls below that return int32_t return 0, or -3: no such limb, a null pointer, or a value out of its range. */

/* From a time on, the set-points move to these values at the drives' rate. If the time lies before the last one of the
 * limb's script, the last one is used. */
int32_t brace_node_posture(brace_node_t *node, int32_t limb, double at_s, double theta1_rad, double theta2_rad);

/* Renews the contact: it holds the tip where the tip is now. Backlash and friction begin from their middle. */
int32_t brace_node_contact(brace_node_t *node, int32_t limb, double hold_n_per_mm, const brace_node_press_t *press);

typedef enum {
    BRACE_NODE_FAULT_ENCODER_STUCK = 0, /* joint: the motor's angle keeps its last reading */
    BRACE_NODE_FAULT_SENSOR_DEAD = 1, /* joint: no sample comes */
    BRACE_NODE_FAULT_SENSOR_NAN = 2, /* joint: samples are NaN */
    BRACE_NODE_FAULT_CURRENT_OFFSET = 3, /* joint; value [N mm] is added to the torque samples */
    BRACE_NODE_FAULT_FORCE_DEAD = 4, /* the force sensor does not answer */
    BRACE_NODE_FAULT_FORCE_OFFSET = 5, /* value [N] is added to both axes */
    BRACE_NODE_FAULT_NVM_FAILS = 6, /* the memory refuses to write and to erase */
    BRACE_NODE_FAULT_NVM_FORGETS = 7, /* writing and erasing do nothing */
    BRACE_NODE_FAULT_BUS_OFF = 8,
    BRACE_NODE_FAULT_TICK_LATE = 9, /* value [ms]: the time between ticks */
    BRACE_NODE_FAULT_TIP_LOST = 10, /* the contact lets go, and afterwards holds the tip where it then is */
    BRACE_NODE_FAULT_CRASH = 11, /* the controller crashes once when the fault begins, and starts again */
    BRACE_NODE_FAULT_JOINT_SOFT = 12, /* joint; value [0.001, 1000]: its stiffness, as a share of what it is without */
    BRACE_NODE_FAULT_COUNT = 13
} brace_node_fault_t;

/* The fault's name as on the command line; null for no fault. */
const char *brace_node_fault_name(int32_t fault);

/* A fault from at_s on for a while (inf: for good). joint: 0-2 where the fault is that of a joint; 0 only if the limb
 * has a coxa joint. Returns 0, or -3 for a limb, fault or joint that does not exist. */
int32_t brace_node_fault(brace_node_t *node, int32_t limb, int32_t fault, int32_t joint, double value, double at_s,
                         double for_s);

/* The snapshot of the newest tick. */
int32_t brace_node_snapshot(brace_node_t *node, int32_t limb, brace_snapshot_t *snapshot);

/* The true state, which no controller sees. In the joints' own senses: coxa, femur, tibia. */
typedef struct {
    double set_rad[3]; /* set-points, with the controller's offsets */
    double motor_rad[3];
    double link_rad[3]; /* true joint angles: motor, zero offset, deflection and play */
    double torque_n_mm[3]; /* torque of the motor */
    double load_n_mm[3]; /* load that the gap transmits: the motor's torque on the link */
    int32_t flank[3]; /* flank that carries, +1 or -1; 0: the gap is open, or there is no load */
    double force_x_n, force_y_n, force_z_n; /* force of the contact on the tip; y across the limb's plane */
    int32_t has_coxa_joint;
    double temp_degc;
    int32_t solved; /* the solver found the rest state */
} brace_node_truth_t;
int32_t brace_node_truth(brace_node_t *node, int32_t limb, brace_node_truth_t *truth);

typedef struct {
    uint64_t time_us;
    uint64_t ticks; /* ticks of all limbs */
    uint32_t watchdog_resets; /* watchdog resets of all limbs */
    uint32_t late_wakes; /* how often brace_node_run woke more than 1 ms late */
    uint64_t worst_late_us;
    uint64_t slipped_us; /* time given up after having been late by more than 50 ms */
    uint32_t can_clients;
    uint64_t can_sent, can_received; /* frames of all limbs */
} brace_node_stats_t;
void brace_node_stats(brace_node_t *node, brace_node_stats_t *stats);

/* A servo of a limb whose joints are servos, as its driver knows it, and what the driver has counted. joint: 0-2.
 * Returns 0, or -3: no such limb, or its joints are no servos. */
typedef struct {
    int32_t state; /* a brace_servo_state_t */
    uint32_t model, hardware_error;
    uint32_t samples, lost, doubted, refused, restarts; /* of this servo */
    uint32_t requests, answers, damaged, skipped_bytes, foreign; /* of the line */
} brace_node_servo_t;
int32_t brace_node_servo(brace_node_t *node, int32_t limb, int32_t joint, brace_node_servo_t *servo);

/* The controller itself, for its own requests (brace/app.h), and the number of limbs. Null for a limb that does not
 * exist. */
brace_app_t *brace_node_app(brace_node_t *node, int32_t limb);
int32_t brace_node_limbs(const brace_node_t *node);

/* Power off and on: the memory stays, everything else starts anew. */
int32_t brace_node_restart(brace_node_t *node, int32_t limb);

#endif
