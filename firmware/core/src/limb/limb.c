#include "brace/limb.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/off_tick.h"

#define HALF_TURN_RAD_MAX 1.5707965f

/* What a field may be; every field of brace_limb_t has one of these ranges. */
enum { COXA_MM, LENGTH_MM, LINEAR, ANGULAR, RATIO, TILT, ANGLE, OFFSET, LENGTH_SIGMA };

static const struct {
    float low, high;
} range[] = {[COXA_MM] = {0.0f, 1e4f},     [LENGTH_MM] = {1.0f, 1e4f},
             [LINEAR] = {0.0f, 1e3f},      [ANGULAR] = {0.0f, 1.0f},
             [RATIO] = {0.0f, 1.0f},       [TILT] = {-HALF_TURN_RAD_MAX, HALF_TURN_RAD_MAX},
             [ANGLE] = {0.0f, 0.5f},       [OFFSET] = {-0.5f, 0.5f},
             [LENGTH_SIGMA] = {0.0f, 100.0f}};

#define LINK_FIELDS LINEAR, LINEAR, TILT, LINEAR, ANGULAR, RATIO
#define JOINT_FIELDS ANGULAR, ANGLE, OFFSET

/* The fields in the order of brace_limb_t. */
static const uint8_t kind[] = {COXA_MM,      LENGTH_MM,    LENGTH_MM,    LINK_FIELDS, LINK_FIELDS,
                               LINK_FIELDS,  JOINT_FIELDS, JOINT_FIELDS, JOINT_FIELDS, LINEAR,
                               LINEAR,       ANGULAR,      LENGTH_SIGMA, ANGLE,       RATIO,
                               RATIO};

_Static_assert(sizeof kind * sizeof(float) == sizeof(brace_limb_t), "one kind for each field of the limb");

#define PLACE(name) ((uint8_t)(offsetof(brace_limb_t, name) / sizeof(float)))

/* What yields along a line of its own. */
static const uint8_t source[] = {PLACE(link[BRACE_FEMUR].axial_mm_per_n), PLACE(link[BRACE_FEMUR].bending_mm_per_n),
                                 PLACE(link[BRACE_TIBIA].axial_mm_per_n), PLACE(link[BRACE_TIBIA].bending_mm_per_n),
                                 PLACE(joint[BRACE_TIBIA].compliance_rad_per_n_mm), PLACE(base.x_mm_per_n),
                                 PLACE(base.z_mm_per_n)};

/* Does C have an inverse at some posture: are there two sources of compliance that do not always act along
 * the same line? Tibia bending and knee joint do, unless the tibia's ellipsoid is tilted. */
BRACE_OFF_TICK
static bool yields_in_two_directions(const brace_limb_t *limb)
{
    const brace_link_t *femur = &limb->link[BRACE_FEMUR], *tibia = &limb->link[BRACE_TIBIA];
    const float *field = &limb->coxa_mm;
    int sources = (femur->bending_mm_per_n * femur->moment_transfer_ratio > 0.0f) +
                  (limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm + limb->base.rotation_rad_per_n_mm > 0.0f) -
                  (limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm * tibia->bending_mm_per_n > 0.0f &&
                   tibia->tilt_rad == 0.0f);
    for (size_t i = 0; i < sizeof source; i++) {
        sources += field[source[i]] > 0.0f;
    }
    return sources >= 2;
}

/* Moment transfer divides by the link's length; the other links have a least length anyway. */
static bool coxa_is_long_enough(const brace_limb_t *limb)
{
    return limb->coxa_mm >= 1.0f || !(limb->link[BRACE_COXA].moment_transfer_ratio > 0.0f);
}

BRACE_OFF_TICK
brace_status_t brace_limb_check(const brace_limb_t *limb)
{
    if (limb == NULL) {
        return BRACE_E_NULL;
    }
    const float *field = &limb->coxa_mm;
    bool inside = true;
    for (size_t i = 0; i < sizeof kind; i++) {
        if (!(__builtin_fabsf(field[i]) <= 3.4028234e38f)) {
            return BRACE_E_NOT_FINITE;
        }
        inside = inside && field[i] >= range[kind[i]].low && field[i] <= range[kind[i]].high;
    }
    return inside && yields_in_two_directions(limb) && coxa_is_long_enough(limb) ? BRACE_OK : BRACE_E_PARAMETER;
}

float brace_limb_true_angle(const brace_limb_t *limb, int index, float commanded_rad)
{
    return commanded_rad + limb->joint[index].zero_offset_rad;
}
