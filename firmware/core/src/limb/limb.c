#include "brace/limb.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/check.h"
#include "base/off_tick.h"

#define HALF_TURN_RAD_MAX 1.5707965f

/* What a field may be: at most so much, and not negative but for the first two. Lengths have a least one, too. */
enum { TILT, OFFSET, ANGLE, LENGTH_MM, LENGTH_SIGMA, LINEAR, ANGULAR, RATIO = ANGULAR };

static const float most[] = {[TILT] = HALF_TURN_RAD_MAX, [OFFSET] = 0.5f,  [ANGLE] = 0.5f,  [LENGTH_MM] = 1e4f,
                             [LENGTH_SIGMA] = 100.0f,    [LINEAR] = 1e3f, [ANGULAR] = 1.0f};

/* What of a limb decides whether its tip can yield: the lines in the plane along which it does. Tibia bending and knee joint
 * share theirs unless the tibia's ellipsoid is tilted; a bending femur that passes moments on has a second. */
enum { FEMUR_AXIAL = 1, FEMUR_BENDING, TIBIA_AXIAL, TIBIA_BENDING, KNEE, HIP, BASE_X, BASE_Z, TILTED, FEMUR_MOMENT, COXA_MOMENT };

#define BIT(what) (1 << (what))
#define LINES (BIT(BASE_Z + 1) - BIT(FEMUR_AXIAL))

/* A field's range, and what it says when it is not zero: one of those, or nothing. */
#define SAYS(what, range) ((range) | (what) << 3)
#define RANGE(kind) ((kind) & 7u)
#define SAID(kind) ((kind) >> 3)

#define LINK(axial, bending, tilt, moment)                                                                            \
    SAYS(axial, LINEAR), SAYS(bending, LINEAR), SAYS(tilt, TILT), LINEAR, ANGULAR, SAYS(moment, RATIO)
#define JOINT(compliance) SAYS(compliance, ANGULAR), ANGLE, OFFSET

/* The fields in the order of brace_limb_t. */
static const uint8_t kind[] = {
    LENGTH_MM, LENGTH_MM, LENGTH_MM,
    LINK(0, 0, 0, COXA_MOMENT),
    LINK(FEMUR_AXIAL, FEMUR_BENDING, 0, FEMUR_MOMENT),
    LINK(TIBIA_AXIAL, TIBIA_BENDING, TILTED, 0),
    JOINT(0), JOINT(HIP), JOINT(KNEE),
    SAYS(BASE_X, LINEAR), SAYS(BASE_Z, LINEAR), SAYS(HIP, ANGULAR),
    LENGTH_SIGMA, ANGLE, RATIO, RATIO};

_Static_assert(sizeof kind * sizeof(float) == sizeof(brace_limb_t), "one kind for each field of the limb");

/* Does C have an inverse at some posture: does the tip yield along two lines? */
static bool yields_in_two_directions(int32_t said)
{
    const int32_t lines = said & LINES;
    int32_t second = lines & (lines - 1);
    if (lines == BIT(FEMUR_BENDING)) {
        second = said & BIT(FEMUR_MOMENT);
    }
    if (lines == (BIT(TIBIA_BENDING) | BIT(KNEE))) {
        second = said & BIT(TILTED);
    }
    return second != 0;
}

/* Moment transfer divides by the link's length; the other links have a least length anyway. */
static bool coxa_is_long_enough(const brace_limb_t *limb, int32_t said)
{
    return (said & BIT(COXA_MOMENT)) == 0 || brace_bits(limb->coxa_mm) >= brace_bits(1.0f);
}

BRACE_OFF_TICK
brace_status_t brace_limb_check(const brace_limb_t *limb)
{
    brace_status_t status = brace_check_lengths(limb);
    if (status == BRACE_E_NULL) {
        return status;
    }
    const float *field = &limb->coxa_mm;
    int32_t said = 0;
    for (size_t i = 0; i < sizeof kind; i++) {
        uint32_t bits = (uint32_t)brace_bits(field[i]);
        const uint32_t magnitude = brace_magnitude_bits(field[i]);
        if (magnitude >= BRACE_INFINITE_BITS) {
            return BRACE_E_NOT_FINITE;
        }
        if (magnitude == 0u) {
            continue;
        }
        said |= BIT(SAID(kind[i]));
        if (RANGE(kind[i]) <= OFFSET) {
            bits = magnitude / 2u;
        }
        if (bits > (uint32_t)brace_bits(most[RANGE(kind[i])])) { /* as is all that is negative */
            status = BRACE_E_PARAMETER;
        }
    }
    if (!yields_in_two_directions(said) || !coxa_is_long_enough(limb, said)) {
        status = BRACE_E_PARAMETER;
    }
    return status;
}

float brace_limb_true_angle(const brace_limb_t *limb, int index, float commanded_rad)
{
    return commanded_rad + limb->joint[index].zero_offset_rad;
}
