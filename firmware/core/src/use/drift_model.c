#include "use/drift_model.h"
#include "use/unroll.h"

#include "base/trig.h"
#include "base/vec.h"

#define DOUBT_SIGMAS 1.0f
#define SQRT_2 1.41421356f /* two compliances, each known no better */

typedef struct {
    float xx, xz, zz;
} matrix_t;

static INLINED brace_vec_t times(const matrix_t *m, brace_vec_t v)
{
    return (brace_vec_t){m->xx * v.x + m->xz * v.z, m->xz * v.x + m->zz * v.z};
}

static INLINED brace_vec_t plus(brace_vec_t a, brace_vec_t b, float by)
{
    return (brace_vec_t){__builtin_fmaf(by, b.x, a.x), __builtin_fmaf(by, b.z, a.z)};
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

static INLINED void soften(matrix_t *c, brace_vec_t v, float by)
{
    const brace_vec_t scaled = vec_scaled(v, by);
    c->xx = __builtin_fmaf(scaled.x, v.x, c->xx);
    c->xz = __builtin_fmaf(scaled.x, v.z, c->xz);
    c->zz = __builtin_fmaf(scaled.z, v.z, c->zz);
}

/* What a symmetric matrix loses to rounding here comes back when it is inverted again. */
static INLINED void invert(matrix_t *m)
{
    const float per_det = 1.0f / (m->xx * m->zz - m->xz * m->xz);
    *m = (matrix_t){m->zz * per_det, -m->xz * per_det, m->xx * per_det};
}

/* e^x for the small: compliances as logarithms, so that what two estimates share stays a straight line between them
 * (or the filter would take its own steps along it for knowledge). */
static inline float factor(float x)
{
    return 1.0f + x * (1.0f + x * (0.5f + x * (1.0f / 6.0f)));
}

/* The elements that change: across the femur, the same with its moment, across the tibia, the femur joint's lever. */
enum { BEND, MOMENT, SHANK, HIP, ELEMENTS };

static INLINED void set_vectors(brace_vec_t vector[ELEMENTS], brace_vec_t bent, brace_vec_t across_femur,
                               brace_vec_t across_tibia, float femur_mm, float tibia_mm)
{
    vector[BEND] = bent;
    vector[MOMENT] = plus(bent, across_tibia, 2.0f * tibia_mm / femur_mm);
    vector[SHANK] = across_tibia;
    vector[HIP] = plus(vec_scaled(across_tibia, tibia_mm), across_femur, femur_mm);
}

void drift_expect(const brace_limb_t *limb, const brace_stiffness_t *stiffness, const brace_drift_reading_t *reading,
                  const float offset[DRIFT_OFFSETS], float per_degc, drift_expected_t *expected)
{
    const drift_compliances_t c = drift_compliances(limb);
    const float femur_mm = limb->femur_mm, tibia_mm = limb->tibia_mm;
    const uint32_t femur_turn = brace_turn(reading->theta1_rad);
    const brace_vec_t across_femur = vec_quarter(brace_direction(femur_turn));
    const brace_vec_t bent = vec_quarter(brace_direction(femur_turn + brace_turn(limb->link[BRACE_FEMUR].tilt_rad)));
    const brace_vec_t believed = brace_direction(femur_turn - brace_turn(reading->theta2_rad));
    const float turn = offset[DRIFT_TURN_KNEE]; /* some mrad: two terms of its sine and cosine */
    const brace_vec_t along_tibia = plus(believed, plus(vec_quarter(believed), believed, 0.5f * turn), -turn);
    const float coupled = 0.75f * limb->link[BRACE_FEMUR].moment_transfer_ratio;
    const brace_vec_t across_tibia = vec_quarter(along_tibia);
    brace_vec_t vector[ELEMENTS], before[ELEMENTS];
    set_vectors(vector, bent, across_femur, across_tibia, femur_mm, tibia_mm);
    set_vectors(before, bent, across_femur, vec_quarter(believed), femur_mm, tibia_mm);
    const float believed_warm = per_degc * reading->warmer_degc;
    const float warm = believed_warm * (1.0f + offset[DRIFT_THERMAL]); /* as a logarithm its square would show */
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

    /* both axial compliances scale as one: where they show, the links lie along one line */
    const float axial_femur = limb->link[BRACE_FEMUR].axial_mm_per_n;
    const float axial_tibia = limb->link[BRACE_TIBIA].axial_mm_per_n;
    const brace_vec_t along_femur = {bent.z, -bent.x};
    matrix_t k = {stiffness->k_xx_n_per_mm, stiffness->k_xz_n_per_mm, stiffness->k_zz_n_per_mm};
    invert(&k);
    UNROLLED
    for (int i = 0; i < ELEMENTS; i++) {
        const float stays = i == SHANK ? limb->link[BRACE_TIBIA].axial_mm_per_n : 0.0f; /* the same however it turns */
        soften(&k, vector[i], now[i] - stays);
        soften(&k, before[i], stays - unit[i]);
    }
    soften(&k, along_femur, axial_femur * offset[DRIFT_AXIAL]);
    soften(&k, along_tibia, axial_tibia * offset[DRIFT_AXIAL]);
    invert(&k);

    const brace_vec_t moved = {reading->dx_mm, reading->dz_mm};
    const brace_vec_t force = times(&k, moved);
    brace_vec_t slope[DRIFT_OFFSETS]; /* dC = w v v' makes dK = -w (Kv)(Kv)' */
    float load[ELEMENTS];
    brace_vec_t give[ELEMENTS];
    UNROLLED
    for (int i = 0; i < ELEMENTS; i++) {
        load[i] = vec_dot(vector[i], force);
        give[i] = vec_scaled(times(&k, vector[i]), -load[i]);
    }
    slope[BRACE_DRIFT_FEMUR] = plus(vec_scaled(give[MOMENT], unit[MOMENT]), give[BEND], unit[BEND]);
    slope[BRACE_DRIFT_TIBIA_OR_KNEE] = vec_scaled(give[SHANK], now[SHANK]);
    slope[BRACE_DRIFT_FEMUR_JOINT_OR_BASE] = vec_scaled(give[HIP], now[HIP]);
    slope[DRIFT_THERMAL] = plus(vec_scaled(slope[BRACE_DRIFT_FEMUR_JOINT_OR_BASE], hip_per_thermal),
                                slope[BRACE_DRIFT_TIBIA_OR_KNEE], shank_per_thermal);
    slope[DRIFT_AXIAL] = plus(vec_scaled(times(&k, along_femur), -axial_femur * vec_dot(along_femur, force)),
                              times(&k, along_tibia), -axial_tibia * vec_dot(along_tibia, force));

    /* K turned with the limb; the tibia turned at the knee, with the levers and ellipsoids that go with it */
    slope[DRIFT_TURN_LIMB] = vec_minus(vec_quarter(force), times(&k, vec_quarter(moved)));
    const float by_hip = now[HIP] * tibia_mm;
    const float by_shank = now[SHANK] - limb->link[BRACE_TIBIA].axial_mm_per_n;
    const float by_moment = now[MOMENT] * 2.0f * tibia_mm / femur_mm;
    const float along = by_hip * load[HIP] + by_shank * load[SHANK] + by_moment * load[MOMENT];
    const brace_vec_t by_levers = plus(vec_scaled(vector[HIP], by_hip), vector[SHANK], by_shank);
    const brace_vec_t across = plus(by_levers, vector[MOMENT], by_moment);
    slope[DRIFT_TURN_KNEE] =
        times(&k, plus(vec_scaled(along_tibia, -along), across, -vec_dot(along_tibia, force)));

    const brace_vec_t turned = plus(force, slope[DRIFT_TURN_LIMB], offset[DRIFT_TURN_LIMB]);
    expected->force_n[0] = turned.x;
    expected->force_n[1] = turned.z;
    /* what the calibration does not know and no estimate takes up: the base's translation, and how much of what was
     * found across the tibia is the knee's spring, which warms */
    const brace_base_t *base = &limb->base;
    const brace_vec_t based = times(&k, (brace_vec_t){base->x_mm_per_n * force.x, base->z_mm_per_n * force.z});
    const brace_vec_t warmed = vec_scaled(give[SHANK], knee_more * c.tibia_share * SQRT_2);
    const float doubt = DOUBT_SIGMAS * limb->uncertainty.compliance_rel;
    expected->doubt_n[0] = doubt * (__builtin_fabsf(based.x) + __builtin_fabsf(warmed.x));
    expected->doubt_n[1] = doubt * (__builtin_fabsf(based.z) + __builtin_fabsf(warmed.z));
    UNROLLED
    for (int i = 0; i < DRIFT_OFFSETS; i++) {
        expected->per_offset[0][i] = slope[i].x;
        expected->per_offset[1][i] = slope[i].z;
    }
}
