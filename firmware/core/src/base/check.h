/* The one way inputs are tested for being usable numbers. */
#ifndef BRACE_CORE_CHECK_H
#define BRACE_CORE_CHECK_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "brace/limb.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* What a public function is given: a run of numbers, each within plus and minus a limit of its own (check.c). A digit for
 * each, the first one last: 1 an angle of a joint, 2 a part of a normal or a friction, 3 a displacement, 4 a force or a
 * coordinate, 5 a distance, 6 a stiffness. */
typedef enum {
    BRACE_INPUT_STIFFNESS = 0x166666, /* what a brace_stiffness_t begins with: entries, eigenvalues, axis */
    BRACE_INPUT_ANGLES = 0x11,        /* of two joints [rad] */
    BRACE_INPUT_POLAR = 0x15,         /* distance [mm], direction [rad] */
    BRACE_INPUT_DISPLACEMENT = 0x33,  /* two components [mm] */
    BRACE_INPUT_READING = 0x443,      /* displacement [mm], two components of the force [N] */
    BRACE_INPUT_FORCE = 0x44,         /* two components [N] */
    BRACE_INPUT_POINT = 0x44,         /* two components [mm] */
    BRACE_INPUT_GRIP = 0x22244        /* two components of the force [N], two of the surface's normal, friction */
} brace_input_t;

/* Are those numbers what they may be? given: whatever the caller must have been given a pointer to.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE: of the first number that is not */
brace_status_t brace_check(const void *given, const float *value, brace_input_t what);

/* BRACE_OK for a value in [-limit, limit], BRACE_E_RANGE for a finite one outside, BRACE_E_NOT_FINITE. */
brace_status_t brace_check_magnitude(float value, float limit);

brace_status_t brace_check_two(float a, float b, float limit);

/* A limb with lengths that a limb can have.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER */
brace_status_t brace_check_lengths(const brace_limb_t *limb);

/* brace_check, and then brace_check_lengths; null before all else. */
brace_status_t brace_check_limb(const void *given, const float *value, brace_input_t what, const brace_limb_t *limb);

/* brace_check, and then whether a stiffness can be divided by: numbers within their limits, eigenvalues positive and in
 * order. */
brace_status_t brace_check_stiffness(const brace_stiffness_t *stiffness, const void *given, const float *value,
                                     brace_input_t what);

/* A float's bits. As integers they are in the floats' own order while these are not negative, NaN and infinity above
 * all: comparing them needs no FPU, and takes half the code where there is one. */
static inline int32_t brace_bits(float value)
{
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The same of the magnitude, twice over: the sign is gone, and nothing else. */
static inline uint32_t brace_magnitude_bits(float value)
{
    return (uint32_t)brace_bits(value) << 1;
}

/* Below zero; minus zero is not. */
static inline bool brace_is_negative(float value)
{
    return (uint32_t)brace_bits(value) > 0x80000000u;
}

#define BRACE_INFINITE_BITS 0xff000000u /* of infinity; of NaN more */

#endif
