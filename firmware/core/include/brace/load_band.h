/* An interval for a load where only the torque of the motor before its gear is measured, and for a sum of two.
 *
 * Friction in motor and gear stands between the motor's torque T and the load L behind the gear:
 *     |T - L| <= c + |a T + b L|.
 * c is constant, a and b are the shares that grow with torque and load. A joint that stands may have any L within it.
 * One that turns has all of the friction against it, less what sliding has taken off (Stribeck). The law is model M5 of
 * M. Duclusaud, G. Passault, V. Padois, O. Ly, Extended friction models for the physics simulation of servo actuators,
 * ICRA 2025, arXiv 2410.08650; with a = b it is their M4, with a = b = 0 dry friction alone.
 *
 * A load that may lie anywhere in a band is not normally distributed: 0.9 of the band holds 90 % of the loads. The sum
 * of two bands has a trapezoid's density, and its quantile is taken. Noise is normally distributed. It is added as a
 * root of squares; where noise and band are of one size, the interval is then a little too wide.
 *
 * Thread rule: pure functions of their arguments; any thread or interrupt that may use the FPU. The numbers of a gear
 * are those of a checked parameter set. A torque, a band's middle or a sum's middle of NaN gives an interval of NaN.
 */
#ifndef BRACE_LOAD_BAND_H
#define BRACE_LOAD_BAND_H

#include <stdbool.h>

#define BRACE_NORMAL_90_SIGMAS 1.6449f /* a normal distribution has 90 % within so many sigmas of its middle */

/* Friction between a motor's torque and the load, in [N mm] and ratios [0, 0.9]. */
typedef struct {
    float friction_n_mm;        /* c */
    float per_torque_ratio;     /* a */
    float per_load_ratio;       /* b */
    float tolerance_ratio;      /* the friction may be larger or smaller by this share of itself [0, 1] */
    float sliding_ratio;        /* the least share of the friction that is left while the joint moves [0, 1] */
    float joint_n_mm;           /* dry friction behind the gear, in the joint itself */
    float joint_per_load_ratio; /* what is added to it, as a share of the load */
} brace_gear_t;

/* A load: anywhere from middle - half to middle + half with the same probability, and noise added. */
typedef struct {
    float middle_n_mm, half_n_mm; /* half >= 0 */
    float noise_n_mm;             /* one sigma of the noise */
    float near_end; /* at which end the load stood when the joint moved last: +1 the high one, -1 the low one; 0: not
                     * known */
} brace_load_band_t;

/* An interval that holds 90 %. */
typedef struct {
    float low, high;
} brace_interval_t;

/* The load behind a gear.
 *   gear: not null. torque_n_mm: of the motor, in the joint's sense
 *   way: in which the joint turned last, +1 or -1; 0: not known. A motor that turns the joint its own way carries less
 *     load than its torque, one that is turned back carries more
 *   is_moving: it turns now
 *   band (out): noise_n_mm is 0
 * Cost on a Cortex-M4F: at most 90 instructions. */
void brace_load_band(const brace_gear_t *gear, float torque_n_mm, float way, bool is_moving, brace_load_band_t *band);

/* Where one load lies. Its band's end at which the joint came to stand counts whole, because loads that grow until the
 * joint slips gather there.
 * Cost: at most 40 instructions. */
brace_interval_t brace_load_band_alone(const brace_load_band_t *band);

/* Where the sum of one_ratio times one load and two_ratio times another lies with 90 %. The loads are independent.
 *   middle: the sum for both loads in the middle of their bands; it may have a constant added
 * Cost: at most 80 instructions. */
brace_interval_t brace_load_band_sum(const brace_load_band_t *one, float one_ratio, const brace_load_band_t *two,
                                     float two_ratio, float middle);

#endif
