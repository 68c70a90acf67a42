#include "brace/limb.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/check.h"
#include "base/off_tick.h"

#define HALF_TURN_RAD_MAX 1.5707965f

/* What a field may be; every field of brace_limb_t has one of these ranges. */
enum { COXA_MM, LENGTH_MM, LINEAR, ANGULAR, TILT, ANGLE, OFFSET, LENGTH_SIGMA, RATIO = ANGULAR };

static const struct {
    float low, high;
} range[] = {[COXA_MM] = {0.0f, 1e4f},
             [LENGTH_MM] = {1.0f, 1e4f},
             [LINEAR] = {0.0f, 1e3f},
             [ANGULAR] = {0.0f, 1.0f},
             [TILT] = {-HALF_TURN_RAD_MAX, HALF_TURN_RAD_MAX},
             [ANGLE] = {0.0f, 0.5f},
             [OFFSET] = {-0.5f, 0.5f},
             [LENGTH_SIGMA] = {0.0f, 100.0f}};

/* What of a limb decides whether its tip can yield: the lines in the plane along which it does. Tibia bending and knee joint
 * share theirs unless the tibia's ellipsoid is tilted; a bending femur that passes moments on has a second. */
enum { FEMUR_AXIAL = 1, FEMUR_BENDING, TIBIA_AXIAL, TIBIA_BENDING, KNEE, HIP, BASE_X, BASE_Z, TILTED, FEMUR_MOMENT, COXA_MOMENT };

#define BIT(what) (1 << ((what) - 1))
#define LINES (BIT(BASE_Z + 1) - 1)

/* A field's range, and what it says when it is not zero: one of those, or nothing. */
#define SAYS(what, range) ((range) | (what) << 3)
#define RANGE(kind) ((kind) & 7u)
#define SAID(kind) ((kind) >> 3)

#define LINK(axial, bending, tilt, moment)                                                                            \
    SAYS(axial, LINEAR), SAYS(bending, LINEAR), SAYS(tilt, TILT), LINEAR, ANGULAR, SAYS(moment, RATIO)
#define JOINT(compliance) SAYS(compliance, ANGULAR), ANGLE, OFFSET

/* The fields in the order of brace_limb_t. */
static const uint8_t kind[] = {
    COXA_MM, LENGTH_MM, LENGTH_MM,
    LINK(0, 0, 0, COXA_MOMENT),
    LINK(FEMUR_AXIAL, FEMUR_BENDING, 0, FEMUR_MOMENT),
    LINK(TIBIA_AXIAL, TIBIA_BENDING, TILTED, 0),
    JOINT(0), JOINT(HIP), JOINT(KNEE),
    SAYS(BASE_X, LINEAR), SAYS(BASE_Z, LINEAR), SAYS(HIP, ANGULAR),
    LENGTH_SIGMA, ANGLE, RATIO, RATIO};

_Static_assert(sizeof kind * sizeof(float) == sizeof(brace_limb_t), "one kind for each field of the limb");

/* Are the first fields finite and in their ranges?
 * returns BIT(what) for all that they say, nothing of lengths; or BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_PARAMETER */
BRACE_OFF_TICK
static int32_t read_fields(const brace_limb_t *limb, size_t count)
{
    if (limb == NULL) {
        return BRACE_E_NULL;
    }
    const float *field = &limb->coxa_mm;
    bool inside = true;
    int32_t said = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t magnitude = brace_magnitude_bits(field[i]);
        if (magnitude >= BRACE_INFINITE_BITS) {
            return BRACE_E_NOT_FINITE;
        }
        if (magnitude != 0u) {
            said |= 1 << SAID(kind[i]);
        }
        if (!(field[i] >= range[RANGE(kind[i])].low && field[i] <= range[RANGE(kind[i])].high)) {
            inside = false;
        }
    }
    return inside ? said >> 1 : BRACE_E_PARAMETER;
}

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
    const int32_t said = read_fields(limb, sizeof kind);
    if (said < 0) {
        return (brace_status_t)said;
    }
    return yields_in_two_directions(said) && coxa_is_long_enough(limb, said) ? BRACE_OK : BRACE_E_PARAMETER;
}

BRACE_OFF_TICK
brace_status_t brace_check_lengths(const brace_limb_t *limb)
{
    const int32_t said = read_fields(limb, BRACE_LINK_COUNT);
    return said == BRACE_E_NOT_FINITE ? BRACE_E_PARAMETER : (brace_status_t)said;
}

float brace_limb_true_angle(const brace_limb_t *limb, int index, float commanded_rad)
{
    return commanded_rad + limb->joint[index].zero_offset_rad;
}
