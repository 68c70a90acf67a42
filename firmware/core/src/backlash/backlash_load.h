/* What a joint's motor shows about the load behind the gap: the two filtered intervals and the play operator. */
#ifndef BRACE_BACKLASH_LOAD_H
#define BRACE_BACKLASH_LOAD_H

#include "brace/backlash_types.h"

/* How many sigmas the load must be from zero: the larger number proves a flank, the smaller one only names it. */
#define PROOF_SIGMAS 6.0f
#define HINT_SIGMAS 3.0f

/* A motor that has not advanced by its hysteresis for this long counts as standing [us]. */
#define STANDING_US 8000u

/* How long the fast interval has to be clear of zero [us]. */
enum { CONFIRM_US = 12000 };

/* Forgets everything and begins with this sample. */
void backlash_load_start(brace_backlash_t *joint, const brace_backlash_sample_t *sample);

/* Takes in the sample of a tick. */
void backlash_load_observe(brace_backlash_t *joint, const brace_backlash_sample_t *sample);

/* As backlash_load_observe leaves it after standing for long under one torque. */
void backlash_load_settle(brace_backlash_t *joint, float torque_n_mm);

/* The sign of the load that the fast interval proves for CONFIRM_US; 0 if it proves none. */
int backlash_load_proven(const brace_backlash_t *joint);

/* The sign of the load that the slow interval shows, at a share of its full width and with the expected load; 0 if it
 * shows none. */
int backlash_load_decided(const brace_backlash_t *joint, const brace_backlash_sample_t *sample, float share);

/* The motor has not advanced lately. It may have turned round, so its friction may have either sign. */
static inline bool backlash_load_standing(const brace_backlash_t *joint)
{
    return joint->standing_us > STANDING_US;
}

/* Half width of the fast interval [N mm]. */
float backlash_load_off_n_mm(const brace_backlash_t *joint);

#endif
