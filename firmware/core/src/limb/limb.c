#include "brace/limb.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/check.h"
#include "brace/ranges.h"

/* Moment transfer divides by the link's length. The other links have a least length already. */
#define COXA_LEAST_MM 1.0f

typedef struct {
    uint32_t offset;
    float least, most;
} range_t;

#define RANGE_OF(member, least, most) {offsetof(brace_limb_t, member), least, most},
static const range_t ranges[] = {BRACE_LIMB_RANGES(RANGE_OF)};
#undef RANGE_OF

enum { FIELDS = sizeof ranges / sizeof *ranges };
_Static_assert(FIELDS * sizeof(float) == sizeof(brace_limb_t), "every field of the limb has a range");

/* BRACE_E_NOT_FINITE comes before BRACE_E_PARAMETER, whichever field is first. A limb that was never filled in is full
 * of NaN, and then BRACE_E_NOT_FINITE is the more useful answer. */
static brace_status_t check_ranges(const brace_limb_t *limb)
{
    brace_status_t status = BRACE_OK;
    for (size_t i = 0; i < FIELDS; i++) {
        float value;
        memcpy(&value, (const char *)limb + ranges[i].offset, sizeof value);
        if (!brace_is_finite(value)) {
            return BRACE_E_NOT_FINITE;
        }
        if (value < ranges[i].least || value > ranges[i].most) {
            status = BRACE_E_PARAMETER;
        }
    }
    return status;
}

/* Does C have an inverse at some posture? It does where the tip can move along two different lines of the plane. Each
 * yielding part moves the tip along one line. */
static bool yields_in_two_directions(const brace_limb_t *limb)
{
    const brace_link_t *femur = &limb->link[BRACE_FEMUR], *tibia = &limb->link[BRACE_TIBIA];
    const bool knee = limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm > 0.0f;
    const bool hip = limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm > 0.0f || limb->base.rotation_rad_per_n_mm > 0.0f;
    const bool femur_bends = femur->bending_mm_per_n > 0.0f, tibia_bends = tibia->bending_mm_per_n > 0.0f;
    const int32_t lines = femur_bends + (femur->axial_mm_per_n > 0.0f) + tibia_bends + (tibia->axial_mm_per_n > 0.0f) +
                          knee + hip + (limb->base.x_mm_per_n > 0.0f) + (limb->base.z_mm_per_n > 0.0f);
    if (lines == 1 && femur_bends) { /* a femur that passes moments on turns the tibia too: a second line */
        return femur->moment_transfer > 0.0f;
    }
    if (lines == 2 && tibia_bends && knee) { /* both move the tip across the tibia, unless its ellipsoid is tilted */
        return tibia->tilt_rad < 0.0f || tibia->tilt_rad > 0.0f;
    }
    return lines >= 2;
}

static bool coxa_is_long_enough(const brace_limb_t *limb)
{
    return !(limb->link[BRACE_COXA].moment_transfer > 0.0f) || limb->coxa_mm >= COXA_LEAST_MM;
}

brace_status_t brace_limb_check(const brace_limb_t *limb)
{
    if (limb == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check_ranges(limb);
    return status == BRACE_OK ? brace_limb_check_together(limb) : status;
}

brace_status_t brace_limb_check_together(const brace_limb_t *limb)
{
    if (limb == NULL) {
        return BRACE_E_NULL;
    }
    return yields_in_two_directions(limb) && coxa_is_long_enough(limb) ? BRACE_OK : BRACE_E_PARAMETER;
}

static bool is_within(float value, float least, float most)
{
    return brace_check_range(value, least, most) == BRACE_OK;
}

brace_status_t brace_limb_check_lengths(const brace_limb_t *limb)
{
    if (limb == NULL) {
        return BRACE_E_NULL;
    }
    const bool possible = is_within(limb->coxa_mm, BRACE_RANGE_LIMB_COXA_MM_MIN, BRACE_RANGE_LIMB_COXA_MM_MAX) &&
                          is_within(limb->femur_mm, BRACE_RANGE_LIMB_FEMUR_MM_MIN, BRACE_RANGE_LIMB_FEMUR_MM_MAX) &&
                          is_within(limb->tibia_mm, BRACE_RANGE_LIMB_TIBIA_MM_MIN, BRACE_RANGE_LIMB_TIBIA_MM_MAX);
    return possible ? BRACE_OK : BRACE_E_PARAMETER;
}

float brace_limb_true_angle(const brace_limb_t *limb, int index, float commanded_rad)
{
    return commanded_rad + limb->joint[index].zero_offset_rad;
}
