/* What the controller says of one tick: the snapshot in which K travels, with the mode and the faults
 * (brace/codes.h). */
#ifndef BRACE_SNAPSHOT_H
#define BRACE_SNAPSHOT_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/backlash.h"
#include "brace/codes.h"
#include "brace/gap_stiffness.h"
#include "brace/kinematics.h"
#include "brace/load_band.h"
#include "brace/parameters.h"
#include "brace/stiffness.h"
#include "brace/uncertainty.h"

/* Faults that make every K invalid and the mode FAULT. */
#define BRACE_FAULTS_NO_K \
    (BRACE_FAULT_SENSOR_FEMUR | BRACE_FAULT_SENSOR_TIBIA | BRACE_FAULT_ENCODER_STUCK | BRACE_FAULT_MEMORY | \
     BRACE_FAULT_JUMP_COXA | BRACE_FAULT_JUMP_FEMUR | BRACE_FAULT_JUMP_TIBIA)

/* K in the robot's frame, of a limb whose coxa joint is fitted. A load couples the limb's plane with what is across it.
 * While a gap is open, that coupling is left out. */
typedef struct {
    bool is_fitted; /* the limb has a coxa joint */
    bool is_valid; /* now and engaged may be used, with their flags; else they are NaN */
    float across_n_per_mm; /* K across the limb's plane; 0 while the coxa joint's gap is open */
    float engaged_across_n_per_mm; /* the same once that gap has closed */
    brace_stiffness_spatial_t now; /* open gaps counted; flagged BRACE_FLAG_GAP_OPEN while one is open */
    brace_stiffness_spatial_t engaged; /* once every gap has closed */
} brace_space_stiffness_t;

/* The load that K counts, and what it does to the limb. The weight of the limb's parts counts with the force. */
typedef struct {
    bool is_counted; /* K, tip and the joint angles are those at the equilibrium under this load; else the
                                   next seven are NaN */
    float force_x_n, force_y_n, force_z_n; /* of the ground on the tip, as counted; y: to the left of the limb's plane;
                                              NaN: limb in its plane, as moved_y_mm */
    float moved_x_mm, moved_y_mm, moved_z_mm; /* how far the load has moved the tip */
    /* Of a limb in space the rest is worked out beside the tick: it belongs to a tick up to 240 ticks ago, and is NaN
     * until there is one. */
    float buckling_factor; /* brace/loaded.h; infinity: none */
    brace_stiffness_t unloaded; /* K in the limb's plane with neither force nor weight counted, every gap closed; NaN:
                                   not known */
    float unloaded_across_n_per_mm; /* the same across the plane; NaN: not known, or limb in its plane */
} brace_snapshot_load_t;

/* What one tick says. Everything in it comes from the same samples. */
typedef struct {
    uint32_t sequence; /* counts snapshots; wraps */
    uint32_t taken_us; /* when the joints were sampled; of several sound samples the oldest */
    brace_mode_t mode;
    uint32_t faults; /* BRACE_FAULT_... */
    bool k_is_valid; /* stiffness may be used, with its flags; else it is NaN and its flags say why */
    brace_gap_stiffness_t stiffness; /* K in the limb's plane: now (open gaps counted) and engaged (all gaps closed) */
    brace_space_stiffness_t space;
    brace_snapshot_load_t load;
    bool sigma_is_known; /* else sigma and sigma_space are NaN, and K may be off by anything */
    uint32_t sigma_age_us; /* since the samples that sigma was worked out from; 0 while it is not known */
    brace_stiffness_sigma_t sigma; /* one sigma of stiffness.engaged */
    brace_space_sigma_t sigma_space; /* of space.engaged; NaN of a limb in its plane */
    float theta_rad[BRACE_LINK_COUNT]; /* true joint angles, backlash, zero offset and, while it is counted, what
                                                the load turns counted; NaN: not known */
    float motor_rad[BRACE_LINK_COUNT];
    float torque_n_mm[BRACE_LINK_COUNT];
    brace_backlash_out_t play[BRACE_LINK_COUNT];
    brace_point_t tip_mm; /* where it stands, as far as the load is counted */
    brace_point_t play_shift_mm; /* shift of the tip at zero force by the joints' backlash */
    float force_x_n, force_z_n; /* of the ground on the tip, in the limb's plane; NaN: not known */
    float force_y_n; /* across it, to the left, from the coxa joint's load; NaN: not known */
    /* Intervals that hold these forces and the joints' loads with 90 %. A load's is of at most six ticks before, a
     * force's of at most eleven. A force that the motors measure may lie outside its own interval: while joints move,
     * the friction in their gears acts against the motion alone. */
    brace_interval_t force_x_interval_n, force_y_interval_n, force_z_interval_n; /* NaN: not known */
    brace_interval_t load_interval_n_mm[BRACE_LINK_COUNT]; /* behind the gears; NaN: not known */
    float gravity_direction_rad, gravity_lean_rad; /* where the weight pulls, as the parameters of these names */
    bool force_is_sensed; /* by the tip's sensor, corrected; else worked out from the joints' loads */
    float temp_degc; /* of femur and tibia joint the warmer one; NaN: not measured */
    uint32_t parameter_crc;
    brace_parameter_origin_t parameter_origin;
    uint32_t parameter_sequence; /* counts the sets stored; 0 for the defaults */
    uint32_t parameter_sequence_wanted; /* of the set stored last; another one while BRACE_FAULT_OLD_PARAMETERS stands,
                                           or did until it was cleared */
} brace_snapshot_t;

/* Troubles that are only counted. Every counter stays at its largest value. */
typedef struct {
    uint32_t ticks_late;
    uint32_t samples_bad; /* refused by the drive, not finite or out of range */
    uint32_t frames_refused; /* CAN frames that the bus refused: bus off, or a device that does not answer */
    uint32_t frames_unknown; /* CAN frames received that are of no known kind, or requests of a wrong length */
    uint32_t frames_lost; /* CAN frames to this node that found no room in the hardware layer's ring */
    uint32_t questions_busy; /* questions that found their asker's queue full, and were refused so */
    uint32_t requests_lost; /* requests, or answers to requests, that found no room */
    uint32_t commands_failed; /* joint_command was refused */
    uint32_t modbus_broken; /* Modbus frames with a wrong CRC or length */
    uint32_t modbus_refused; /* Modbus requests answered with an exception */
} brace_app_counters_t;

static inline void brace_count(uint32_t *counter)
{
    *counter += *counter < UINT32_MAX;
}

#endif
