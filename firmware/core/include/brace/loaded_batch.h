/* K under a load at many postures at once, for maps, plans and tables on a host. */
#ifndef BRACE_LOADED_BATCH_H
#define BRACE_LOADED_BATCH_H

#include <stddef.h>

#include "brace/gap_stiffness.h"
#include "brace/loaded.h"
#include "brace/loaded_fixed.h"
#include "brace/loaded_space_types.h"
#include "brace/play.h"

/* K and rest at n postures, each with a force of its own. No argument is checked for null.
 * loaded: from brace_loaded_collapse. joints: direction of the weight and the joints' springs; its tip force is
 *   ignored.
 * theta1_rad, theta2_rad, x_n, z_n: n each, as brace_loaded_stiffness takes them.
 * results: n, flags with those of brace_loaded_flags. Where brace_loaded_stiffness refuses, every number is NaN; flags
 * are then as a controller has them without a rest, NEAR_SINGULAR and SOFTENED, and 0 where the inputs are refused.
 * returns how many were refused.
 * Cost: about 3 us a posture (one core of an Intel Xeon at 2.5 GHz, GCC 12; libm has the fused multiply-add).
 * Thread rule: a pure function of its arguments. */
size_t brace_loaded_batch(const brace_loaded_t *loaded, const brace_load_t *joints, size_t n, const float *theta1_rad,
                          const float *theta2_rad, const float *x_n, const float *z_n,
                          brace_loaded_stiffness_t *results);

/* The same by brace_loaded_fixed_stiffness. reach_mm: lengths of femur and tibia added. */
size_t brace_loaded_fixed_batch(const brace_loaded_fixed_t *fixed, float reach_mm, const brace_load_t *joints, size_t n,
                                const float *theta1_rad, const float *theta2_rad, const float *x_n, const float *z_n,
                                brace_loaded_stiffness_t *results);

/* Of a limb in space: result->flags with those of brace_loaded_flags. */
uint32_t brace_loaded_space_flags(const brace_space_result_t *result, float buckling_factor, float reach_mm);

/* Which play of femur and tibia joint the load of a rest takes up, and K with the other gaps open, as a controller
 * there that has settled (brace_play_at_rest).
 * angles: commanded true ones; load, rest: what brace_loaded_stiffness was given, and its result. joint, machine: of
 * femur and tibia joint; a machine is null where the joint cannot be watched. engaged (out): a joint without play is
 * engaged without a side. k (out): flags with PLAY_ASSUMED.
 * returns as brace_gap_stiffness_known */
brace_status_t brace_loaded_play(const brace_limb_t *limb, const brace_gravity_t *weights, float theta1_rad,
                                 float theta2_rad, const brace_load_t *load, const brace_loaded_stiffness_t *rest,
                                 const brace_play_joint_t joint[2], const brace_backlash_t *const machine[2],
                                 brace_engagement_t engaged[2], brace_gap_stiffness_t *k);

/* The same of a limb in space, and of its coxa joint, whose load a controller does not know from the force on the tip.
 * theta_rad: commanded true angles of coxa, femur, tibia joint; load, rest: what brace_loaded_space_settle was given,
 * and the result of brace_loaded_space_stiffness. joint, machine, engaged: of the three. k (out): K of now in the
 * robot's frame; while a gap is open, plane and across count apart, as in a controller.
 * returns as brace_loaded_space_in_plane, brace_gap_stiffness_known and brace_spatial_turn */
brace_status_t brace_loaded_space_play(const brace_limb_t *limb, const brace_gravity_t *weights,
                                       const float theta_rad[3], const brace_space_load_t *load,
                                       const brace_space_result_t *rest, const brace_play_joint_t joint[3],
                                       const brace_backlash_t *const machine[3], brace_engagement_t engaged[3],
                                       brace_stiffness_spatial_t *k);

#endif
