/* What the drift check expects of a reading, and how that shifts with each of its estimates. */
#ifndef BRACE_DRIFT_MODEL_H
#define BRACE_DRIFT_MODEL_H

#include "brace/drift.h"

/* The estimates: three compliances, each as a share of itself, in the order of brace_drift_cause_t; turn of the whole
 * limb and of the knee [rad]; the thermal rate as a share of the believed one; and the axial compliance of both links as
 * a share of itself: it shows where the limb is stretched or folded, and only there. */
enum { DRIFT_TURN_LIMB = 3, DRIFT_TURN_KNEE = 4, DRIFT_THERMAL = 5, DRIFT_AXIAL = 6, DRIFT_OFFSETS = 7 };

/* The compliances that count as one at the tip. */
typedef struct {
    float femur_mm_per_n;         /* bending */
    float shank_mm_per_n;         /* across the tibia at the tip: the tibia's bending and the knee's spring */
    float tibia_share;            /* of the former in it; 1 for a knee without a tibia that bends */
    float hip_rad_per_n_mm;       /* femur joint and base rotation */
} drift_compliances_t;

typedef struct {
    float force_n[2];
    float doubt_n[2]; /* bound of what the limb's own baseline cannot take up */
    float per_offset[2][DRIFT_OFFSETS];
} drift_expected_t;

drift_compliances_t drift_compliances(const brace_limb_t *limb);

/* Force for a displacement (reading's dx, dz), and its slopes, at the estimates `offset`. */
void drift_expect(const brace_limb_t *limb, const brace_stiffness_t *stiffness, const brace_drift_reading_t *reading,
                  const float offset[DRIFT_OFFSETS], float per_degc, drift_expected_t *expected);

#endif
