#include "use/drift_model.h"

#include "base/trig.h"
#include "base/vec.h"

#define DOUBT_SIGMAS 1.0f
#define SQRT_2 1.41421356f /* the difference of two compliances with equal sigmas */

typedef struct {
    float xx, xz, zz;
} matrix_t;

static inline brace_vec_t times(const matrix_t *m, brace_vec_t v)
{
    return (brace_vec_t){m->xx * v.x + m->xz * v.z, m->xz * v.x + m->zz * v.z};
}

drift_compliances_t drift_compliances(const brace_limb_t *limb)
{
    const float tibia = limb->link[BRACE_TIBIA].bending_mm_per_n;
    const float shank = tibia + limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm * limb->tibia_mm * limb->tibia_mm;
    return (drift_compliances_t){
        .femur_mm_per_n = limb->link[BRACE_FEMUR].bending_mm_per_n,
        .shank_mm_per_n = shank,
        .tibia_share = tibia > 0.0f ? tibia / shank : 1.0f,
        .hip_rad_per_n_mm = limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm + limb->base.rotation_rad_per_n_mm,
    };
}

static inline void soften(matrix_t *c, brace_vec_t v, float by)
{
    const brace_vec_t scaled = vec_scaled(v, by);
    c->xx = brace_fma(scaled.x, v.x, c->xx);
    c->xz = brace_fma(scaled.x, v.z, c->xz);
    c->zz = brace_fma(scaled.z, v.z, c->zz);
}

/* Inverting the result again restores the digits that a slender matrix loses in its determinant. */
static inline void invert(matrix_t *m)
{
    const float per_det = 1.0f / (m->xx * m->zz - m->xz * m->xz);
    *m = (matrix_t){m->zz * per_det, -m->xz * per_det, m->xx * per_det};
}

/* e^x for small x. Estimates of compliances are logarithms, so that the estimates which fit the readings equally well
 * lie on a straight line. On a curved line the filter would mistake its own steps along the curve for knowledge. */
static inline float factor(float x)
{
    return 1.0f + x * (1.0f + x * (0.5f + x * (1.0f / 6.0f)));
}

/* The shift of the force on a held tip when an element along v yields more. */
static inline brace_vec_t given(const matrix_t *k, brace_vec_t v, brace_vec_t force)
{
    return vec_scaled(times(k, v), -vec_dot(v, force));
}

/* The elements that can change: across the femur, the same with its moment, across the tibia, the femur joint's
 * lever. */
enum { BEND, MOMENT, SHANK, HIP, ELEMENTS };

static inline void set_vectors(brace_vec_t vector[ELEMENTS], brace_vec_t bent, brace_vec_t across_femur,
                               brace_vec_t across_tibia, float femur_mm, float tibia_mm)
{
    vector[BEND] = bent;
    vector[MOMENT] = vec_plus_scaled(bent, across_tibia, 2.0f * tibia_mm / femur_mm);
    vector[SHANK] = across_tibia;
    vector[HIP] = vec_plus_scaled(vec_scaled(across_tibia, tibia_mm), across_femur, femur_mm);
}

void drift_expect(const brace_limb_t *limb, const brace_stiffness_t *stiffness, const brace_drift_reading_t *reading,
                  const float offset[DRIFT_OFFSETS], float per_degc, drift_expected_t *expected)
{
    const drift_compliances_t c = drift_compliances(limb);
    const float femur_mm = limb->femur_mm, tibia_mm = limb->tibia_mm;
    const brace_vec_t femur = brace_direction(reading->theta1_rad);
    const brace_vec_t across_femur = vec_quarter(femur);
    const brace_vec_t bent = vec_turned(across_femur, brace_direction(limb->link[BRACE_FEMUR].tilt_rad));
    const brace_vec_t believed = vec_turned_back(femur, brace_direction(reading->theta2_rad));
    const float turn = offset[DRIFT_TURN_KNEE]; /* some mrad, so two terms of its sine and cosine suffice */
    const brace_vec_t turned_by = vec_plus_scaled(vec_quarter(believed), believed, 0.5f * turn);
    const brace_vec_t along_tibia = vec_plus_scaled(believed, turned_by, -turn);
    const float coupled = 0.75f * limb->link[BRACE_FEMUR].moment_transfer;
    const brace_vec_t across_tibia = vec_quarter(along_tibia);
    brace_vec_t vector[ELEMENTS], before[ELEMENTS];
    set_vectors(vector, bent, across_femur, across_tibia, femur_mm, tibia_mm);
    set_vectors(before, bent, across_femur, vec_quarter(believed), femur_mm, tibia_mm);
    const float believed_warm = per_degc * reading->warmer_degc;
    const float warm = believed_warm * (1.0f + offset[DRIFT_THERMAL]); /* not a logarithm: its square would show */
    const float knee = c.shank_mm_per_n - limb->link[BRACE_TIBIA].bending_mm_per_n;
    const float hip = limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    const float hip_more = warm * hip, knee_more = warm * knee;
    const float hip_warm = c.hip_rad_per_n_mm + hip_more, shank_warm = c.shank_mm_per_n + knee_more;
    const float hip_per_thermal = hip_warm > 0.0f ? believed_warm * hip / hip_warm : 0.0f;
    const float shank_per_thermal = shank_warm > 0.0f ? believed_warm * knee / shank_warm : 0.0f;
    const float unit[ELEMENTS] = {
        [BEND] = c.femur_mm_per_n * (1.0f - coupled),
        [MOMENT] = c.femur_mm_per_n * coupled,
        [SHANK] = c.shank_mm_per_n,
        [HIP] = c.hip_rad_per_n_mm,
    };
    const float softer = 1.0f + offset[BRACE_DRIFT_FEMUR];
    const float now[ELEMENTS] = {
        [BEND] = unit[BEND] * softer,
        [MOMENT] = unit[MOMENT] * softer,
        [SHANK] = shank_warm * factor(offset[BRACE_DRIFT_TIBIA_OR_KNEE]),
        [HIP] = hip_warm * factor(offset[BRACE_DRIFT_FEMUR_JOINT_OR_BASE]),
    };

    /* One factor scales both axial compliances: they show only where the links lie along one line. */
    const float axial_femur = limb->link[BRACE_FEMUR].axial_mm_per_n;
    const float axial_tibia = limb->link[BRACE_TIBIA].axial_mm_per_n;
    const brace_vec_t along_femur = {bent.z, -bent.x};
    matrix_t k = {stiffness->k_xx_n_per_mm, stiffness->k_xz_n_per_mm, stiffness->k_zz_n_per_mm};
    invert(&k); /* to C: its elements change from the model's values to those now estimated */
    const float tibia_axial = limb->link[BRACE_TIBIA].axial_mm_per_n; /* the same in every direction of the tibia */
    soften(&k, vector[BEND], now[BEND] - unit[BEND]); /* it turns with the femur only: no new direction */
    soften(&k, vector[MOMENT], now[MOMENT]);
    soften(&k, before[MOMENT], -unit[MOMENT]);
    soften(&k, vector[SHANK], now[SHANK] - tibia_axial);
    soften(&k, before[SHANK], tibia_axial - unit[SHANK]);
    soften(&k, vector[HIP], now[HIP]);
    soften(&k, before[HIP], -unit[HIP]);
    soften(&k, along_femur, axial_femur * offset[DRIFT_AXIAL]);
    soften(&k, along_tibia, axial_tibia * offset[DRIFT_AXIAL]);
    invert(&k);

    const brace_vec_t moved = {reading->dx_mm, reading->dz_mm};
    const brace_vec_t force = times(&k, moved);
    /* How the force shifts with each estimate. dC = w v v' makes dK = -w (K v)(K v)', so the force shifts by w times
     * give = -(v . force) K v. */
    brace_vec_t slope[DRIFT_OFFSETS];
    const brace_vec_t give[ELEMENTS] = {
        [BEND] = given(&k, vector[BEND], force),
        [MOMENT] = given(&k, vector[MOMENT], force),
        [SHANK] = given(&k, vector[SHANK], force),
        [HIP] = given(&k, vector[HIP], force),
    };
    slope[BRACE_DRIFT_FEMUR] = vec_plus_scaled(vec_scaled(give[MOMENT], unit[MOMENT]), give[BEND], unit[BEND]);
    slope[BRACE_DRIFT_TIBIA_OR_KNEE] = vec_scaled(give[SHANK], now[SHANK]);
    slope[BRACE_DRIFT_FEMUR_JOINT_OR_BASE] = vec_scaled(give[HIP], now[HIP]);
    slope[DRIFT_THERMAL] = vec_plus_scaled(vec_scaled(slope[BRACE_DRIFT_FEMUR_JOINT_OR_BASE], hip_per_thermal),
                                           slope[BRACE_DRIFT_TIBIA_OR_KNEE], shank_per_thermal);
    slope[DRIFT_AXIAL] = vec_plus_scaled(vec_scaled(times(&k, along_femur), -axial_femur * vec_dot(along_femur, force)),
                                         times(&k, along_tibia), -axial_tibia * vec_dot(along_tibia, force));

    /* K turns with the limb. The tibia turns at the knee, and so do its ellipsoid and the levers that end at the
     * tip. */
    slope[DRIFT_TURN_LIMB] = vec_minus(vec_quarter(force), times(&k, vec_quarter(moved)));
    const float by_hip = now[HIP] * tibia_mm;
    const float by_shank = now[SHANK] - limb->link[BRACE_TIBIA].axial_mm_per_n;
    const float by_moment = now[MOMENT] * 2.0f * tibia_mm / femur_mm;
    const float along = by_hip * vec_dot(vector[HIP], force) + by_shank * vec_dot(vector[SHANK], force) +
                        by_moment * vec_dot(vector[MOMENT], force);
    const brace_vec_t by_levers = vec_plus_scaled(vec_scaled(vector[HIP], by_hip), vector[SHANK], by_shank);
    const brace_vec_t across = vec_plus_scaled(by_levers, vector[MOMENT], by_moment);
    slope[DRIFT_TURN_KNEE] =
        times(&k, vec_plus_scaled(vec_scaled(along_tibia, -along), across, -vec_dot(along_tibia, force)));

    const brace_vec_t turned = vec_plus_scaled(force, slope[DRIFT_TURN_LIMB], offset[DRIFT_TURN_LIMB]);
    expected->force_n[0] = turned.x;
    expected->force_n[1] = turned.z;
    /* No estimate covers two unknowns of the calibration: the base's translation, and the share of the knee's spring,
     * which warms, in the compliance that was found across the tibia. */
    const brace_base_t *base = &limb->base;
    const brace_vec_t based = times(&k, (brace_vec_t){base->x_mm_per_n * force.x, base->z_mm_per_n * force.z});
    const brace_vec_t warmed = vec_scaled(give[SHANK], knee_more * c.tibia_share * SQRT_2);
    const float doubt = DOUBT_SIGMAS * limb->uncertainty.compliance_rel;
    expected->doubt_n[0] = doubt * (fabsf(based.x) + fabsf(warmed.x));
    expected->doubt_n[1] = doubt * (fabsf(based.z) + fabsf(warmed.z));
    for (int i = 0; i < DRIFT_OFFSETS; i++) {
        expected->per_offset[0][i] = slope[i].x;
        expected->per_offset[1][i] = slope[i].z;
    }
}
