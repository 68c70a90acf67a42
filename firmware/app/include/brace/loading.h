/* The paper's loading test, run by the limb's own motors in small steps against a contact.
 *
 * The tip stands on something that does not yield. A pass 0 -> +n -> 0 -> -n -> 0 displaces the limb's free
 * shape in steps along x or z; the tip stays, so the limb is deflected by as much, and the ground pushes back.
 * A row's displacement is that of the tip against the limb, minus what the motors moved, through the levers.
 * What is measured counts from the preload point, the first reading; play should be taken up before
 * (brace_app_take_up).
 *
 * The motors' movement is read from their encoders, so a servo that gives way under load is no part of the
 * measured K: the offsets are raised until the encoders stand where the step wants them. With
 * BRACE_LOADING_COMMANDED it is taken from the commanded offsets, and the servo's yielding is part of it,
 * as where joint compliance was identified with the servo in it.
 */
#ifndef BRACE_LOADING_H
#define BRACE_LOADING_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/contact.h"
#include "brace/kinematics.h"
#include "brace/slope.h"
#include "brace/stiffness.h"
#include "brace/uncertainty.h"
#include "brace/vec.h"

#define BRACE_LOADING_LEAST_STEP_MM 0.001f
#define BRACE_LOADING_MOST_STEP_MM 50.00001f /* CAN carries thousandths: 50 mm arrives as 50.000004 */
#define BRACE_LOADING_LEAST_WAY 1.2e-7f /* two of a float's last places: what is less would not move it */

typedef enum { BRACE_AXIS_X = 0, BRACE_AXIS_Z = 1 } brace_axis_t;

typedef enum { BRACE_LOADING_ENCODED = 0, BRACE_LOADING_COMMANDED = 1 } brace_loading_source_t;

typedef struct {
    brace_axis_t axis;
    uint32_t steps_per_side;      /* [2, 60] */
    float step_mm;                /* [0.001, 50] */
    uint32_t dwell_us;            /* at each step; the second half is averaged [20 000, 1e7] */
    float rate_mm_per_s;          /* of the tip's free shape [0.001, 1000]; in a tick at least BRACE_LOADING_LEAST_WAY
                                     of steps_per_side * step_mm: 0.002 mm/s for 16 mm and a tick of 1 ms */
    float force_max_n;            /* on the tip, change from the preload point (0, 1e6] */
    float torque_max_n_mm;        /* of each motor (0, 1e6]; never above the drive's range */
    brace_loading_source_t source;
} brace_loading_setup_t;

/* How the test stands or ended. Values never change. */
typedef enum {
    BRACE_LOADING_NONE = 0,
    BRACE_LOADING_RUNNING = 1,
    BRACE_LOADING_DONE = 2,
    BRACE_LOADING_STOPPED = 3,     /* on request */
    BRACE_LOADING_E_FORCE = -1,    /* the force passed its bound */
    BRACE_LOADING_E_TORQUE = -2,   /* a motor's torque passed 95 % of its bound */
    BRACE_LOADING_E_TRAVEL = -3,   /* a motor went beyond twice its command and 0.01 rad, or out of its travel */
    BRACE_LOADING_E_TIME = -4,     /* not done within twice its time, 3 s a step for the servos, and 2 s; nor
                                      within 3,002 s */
    BRACE_LOADING_E_NO_FORCE = -5, /* neither sensor nor joints report the force */
    BRACE_LOADING_E_LOST = -6,     /* a fault, or a flank that was taken up let go */
    BRACE_LOADING_E_FLAT = -7      /* too few steps with a displacement: the motors do not follow */
} brace_loading_outcome_t;

typedef struct {
    brace_loading_outcome_t outcome;
    brace_loading_setup_t setup;
    uint16_t run, config, rep;
    uint32_t rows;                 /* read so far */
    float theta1_rad, theta2_rad, temp_degc; /* at the preload point; angles as the motors stand, without what the load
                                                turns */
    float preload_x_n, preload_z_n;
    bool force_is_sensed;
    /* A column of K: force along x and z per displacement along the axis; with DONE only. */
    brace_slope_column_t least_squares, mean_of_ratios;
    float model_k_x_n_per_mm, model_k_z_n_per_mm; /* the model's at the preload point */
    float sigma_model_k_x_n_per_mm, sigma_model_k_z_n_per_mm;
    float z_x, z_z; /* (least squares - model) / sigma of both */
} brace_loading_result_t;

/* What a reading is averaged from, over the second half of a dwell: sums, or their means. */
typedef struct {
    float motor_rad[2]; /* from where the test began */
    float link_rad[2]; /* link's angle less the motor's; NaN without an encoder at the link */
    float force_x_n, force_z_n, temp_degc;
    uint32_t count;
} brace_loading_sums_t;

/* What outlives a test: how a dataset's rows number it. */
typedef struct {
    uint16_t run, config;
    uint16_t rep[2]; /* along each axis */
    float config_theta_rad[2];
} brace_loading_counts_t;

/* A test under way. Private. Arrays of two are of femur and tibia joint: BRACE_FEMUR + i. */
typedef struct {
    uint8_t phase;
    uint16_t step; /* being gone to or read */
    uint32_t phase_us, test_us, limit_us;
    uint32_t resting_us; /* how long the motors have stood where the step wants them */
    float along_mm; /* where the free shape is commanded to */
    float per_mm[2]; /* joint offsets for 1 mm of it */
    float give_rad_per_mm[2]; /* what the servos give way by, for 1 mm of it */
    float trim_rad[2]; /* correction of what friction holds back where the free shape is at its rest */
    float there_rad[2]; /* how near a motor has to come */
    bool rests[2]; /* the motor has come there at this step, and is left alone while it stays near */
    float torque_max_n_mm[2];
    brace_point_t lever_femur, lever_knee; /* shift of the tip's free shape for a unit of theta1, and of theta2 */
    brace_vec3_t lever_force_n; /* that the tip bears before they are worked out, the mean */
    float lever_rad[BRACE_LINK_COUNT]; /* the posture then, by the motors */
    float behind_rad[BRACE_LINK_COUNT]; /* how far the load turns a joint whose link's angle is measured */
    brace_displacement_t lever_moved_mm[4]; /* what the load moves the tip by, to both sides of it */
    uint8_t lever_step;
    float start_motor_rad[2], start_link_rad[2];
    float standing_rad[2]; /* true angles at the preload point, what the load turns counted */
    brace_loading_sums_t sums;
    float dx_mm, dz_mm, fx_n, fz_n; /* the last reading */
    brace_loading_counts_t counts;
    bool held[2]; /* the joint's backlash was taken up when the test began */
    brace_slope_t slope;
    brace_stiffness_t model, at_reference;
    brace_loading_result_t result;
} brace_loading_t;

#endif
