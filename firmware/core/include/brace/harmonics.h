/* A function of the knee angle theta2 alone: at_fold + per_cos2 cos^2 h + per_sincos sin h cos h with h = theta2/2.
 *
 * at_fold is its value at the folded knee, where cos h is zero. There the levers of the links nearly cancel, and a
 * small value has to keep its digits: in the form constant + a cos theta2 + b sin theta2 it would lose them.
 */
#ifndef BRACE_HARMONICS_H
#define BRACE_HARMONICS_H

typedef struct {
    float at_fold, per_cos2, per_sincos;
} brace_harmonic_t;

#endif
