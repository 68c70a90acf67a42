/* The force that the drift check expects of a reading, and how it shifts with each of the estimates. */
#ifndef BRACE_DRIFT_MODEL_H
#define BRACE_DRIFT_MODEL_H

#include "brace/drift_types.h"
#include "brace/limb.h"
#include "brace/stiffness.h"

/* The estimates: three compliances, each as a share of itself, in the order of brace_drift_cause_t; the turn of the
 * whole limb and of the knee [rad]; the thermal rate as a share of the model's; and the axial compliance of both links
 * as a share of itself, which shows only where the limb is stretched or folded. */
enum { DRIFT_TURN_LIMB = 3, DRIFT_TURN_KNEE = 4, DRIFT_THERMAL = 5, DRIFT_AXIAL = 6, DRIFT_OFFSETS = 7 };

/* The compliances that count as one at the tip. */
typedef struct {
    float femur_mm_per_n;         /* bending */
    float shank_mm_per_n;         /* across the tibia at the tip: the tibia's bending and the knee's spring */
    float tibia_share;            /* the bending's share of shank_mm_per_n; 1 if no tibia bends */
    float hip_rad_per_n_mm;       /* femur joint and base rotation */
} drift_compliances_t;

typedef struct {
    float force_n[2];
    float doubt_n[2]; /* bound of the force error that no estimate of the limb's own baseline can absorb */
    float per_offset[2][DRIFT_OFFSETS];
} drift_expected_t;

drift_compliances_t drift_compliances(const brace_limb_t *limb);

/* Force for a displacement (reading's dx, dz), and its slopes, at the estimates `offset`. */
void drift_expect(const brace_limb_t *limb, const brace_stiffness_t *stiffness, const brace_drift_reading_t *reading,
                  const float offset[DRIFT_OFFSETS], float per_degc, drift_expected_t *expected);

#endif
