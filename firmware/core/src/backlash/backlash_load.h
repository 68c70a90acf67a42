/* What a joint's motor tells of the load behind the gap: the two filtered intervals and the play operator. */
#ifndef BRACE_BACKLASH_LOAD_H
#define BRACE_BACKLASH_LOAD_H

#include "brace/backlash.h"

/* Sigmas between zero and a load that proves a flank, and one that only tells it. */
#define PROOF_SIGMAS 6.0f
#define HINT_SIGMAS 3.0f

/* A motor that has not advanced by its hysteresis for this long stands [us]. */
#define STANDING_US 8000u

/* How long the fast interval has to be clear of zero [us]. */
enum { CONFIRM_US = 12000 };

/* Forgets everything and takes the sample as the beginning. */
void backlash_load_start(brace_backlash_t *joint, const brace_backlash_sample_t *sample);

/* Takes a tick's sample in. */
void backlash_load_observe(brace_backlash_t *joint, const brace_backlash_sample_t *sample);

/* The sign of the load as proven by the fast interval (confirmed), 0 if it is not. */
int backlash_load_proven(const brace_backlash_t *joint);

/* The sign of the load as told by the slow interval, at its full or at a part of its width, and the expected load;
 * 0 if they do not tell. */
int backlash_load_told(const brace_backlash_t *joint, const brace_backlash_sample_t *sample, float share);

/* The motor has not advanced lately: it may have turned round, its friction may have either sign. */
static inline bool backlash_load_standing(const brace_backlash_t *joint)
{
    return joint->standing_us > STANDING_US;
}

/* Half width of the fast interval [N mm]. */
float backlash_load_off_n_mm(const brace_backlash_t *joint);

#endif
