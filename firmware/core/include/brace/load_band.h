/* Where a load lies that is only known by the torque of a motor before a gear, and sums of such loads.
 *
 * Friction in motor and gear stands between the motor's torque T and the load L behind the gear:
 *     |T - L| <= c + |a T + b L|.
 * c is constant, a and b are the shares that grow with torque and load. A joint that stands may have any L within it.
 * One that turns has all of the friction against it, less what sliding has taken off (Stribeck). The law is model M5 of
 * M. Duclusaud, G. Passault, V. Padois, O. Ly, Extended friction models for the physics simulation of servo actuators,
 * ICRA 2025, arXiv 2410.08650; with a = b it is their M4, with a = b = 0 dry friction alone.
 *
 * A load anywhere in a band is no normal distribution: 0.9 of a band holds 90 % of it, and of the sum of two bands the
 * trapezoid's quantile does. Noise, which is normal, is added as a root of squares, which is a little too wide where
 * both are of one size.
 *
 * Thread rule: pure functions of their arguments; any thread or interrupt that may use the FPU. Nothing is checked:
 * NaN in gives NaN out.
 */
#ifndef BRACE_LOAD_BAND_H
#define BRACE_LOAD_BAND_H

#include <stdbool.h>

/* Friction between a motor's torque and the load, in [N mm] and ratios [0, 0.9]. */
typedef struct {
    float friction_n_mm;             /* c */
    float per_torque_ratio;          /* a */
    float per_load_ratio;            /* b */
    float tolerance_ratio;           /* all of it may be off by so much of itself [0, 1] */
    float sliding_ratio;             /* the least share that is left while the joint moves [0, 1] */
    float joint_n_mm;                /* dry friction behind the gear, in the joint itself */
    float joint_per_load_ratio;      /* its share of the load */
} brace_gear_t;

/* A load: anywhere from middle - half to middle + half with the same chance, and noise on top. */
typedef struct {
    float middle_n_mm, half_n_mm; /* half >= 0 */
    float noise_n_mm;             /* one sigma of what is normally distributed */
    float near_end; /* the end at which the load stood when the joint moved last: +1 the high one, -1 the
                                     low one; 0: not known */
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

/* 90 % of one_ratio times one load and two_ratio times another, which know nothing of one another, added to a known
 * number.
 *   middle: the sum for both loads in the middle of their bands
 * Cost: at most 80 instructions. */
brace_interval_t brace_load_band_sum(const brace_load_band_t *one, float one_ratio, const brace_load_band_t *two,
                                     float two_ratio, float middle);

#endif
