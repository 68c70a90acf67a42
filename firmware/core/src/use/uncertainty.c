/* Everything here lives in K's principal frame, x along the stiff axis. There C and K are diagonal, so the
 * eigenvalues' shifts are dK's diagonal and the axis's turn its corner over the eigenvalues' difference; and
 * the small component of a lever along the stiff axis is computed, not left over from a subtraction.
 */
#include "brace/uncertainty.h"

#include <stddef.h>

#include "brace/kinematics.h"
#include "base/check.h"
#include "base/off_tick.h"
#include "base/trig.h"
#include "base/vec.h"

/* pi / sqrt(12): an axis that may point anywhere. */
#define UNKNOWN_AXIS_RAD 0.906899682f

#define HALF_TURN 0x80000000u

/* The vectors that C and its derivatives are made of: five, */
enum { BASE, FEMUR, TIBIA, HIP, TIP, DIRECTION_COUNT };

/* each followed by itself turned by +90 degrees. */
enum {
    BASE_X = 2 * BASE, /* unit, as the next five */
    BASE_Z,
    FEMUR_AXIAL = 2 * FEMUR, /* the ellipsoids' principal axes, tilt included */
    FEMUR_BENDING,
    TIBIA_AXIAL = 2 * TIBIA,
    TIBIA_BENDING,
    THIGH = 2 * HIP, /* knee to femur joint [mm] */
    LEVER_THIGH,     /* the femur joint's shift for a unit turn about the knee */
    SHANK = 2 * TIP, /* knee to tip [mm] */
    LEVER_TIBIA,     /* the tip's shift for the same */
    LEVER_FEMUR,     /* and for a unit turn about the femur's joint */
    VECTOR_COUNT
};

/* The compliances that weigh them: what follows from the limb's, */
enum {
    BEND_PER_MOMENT, /* the femur's shift and turn per moment of the tip force about the knee */
    TURN_PER_MOMENT,
    TIBIA_SLENDERNESS, /* what shows of an ellipsoid's turning: bending - axial */
    BASE_SLENDERNESS,
    WEIGHT_COUNT
};

/* and the limb's own, by their place among its floats from the femur's on. */
#define PLACE(name) (offsetof(brace_limb_t, name) / sizeof(float))
#define FIRST link[BRACE_FEMUR].axial_mm_per_n
#define FIELD(name) (WEIGHT_COUNT + PLACE(name) - PLACE(FIRST))
#define SPRING_FEMUR FIELD(joint[BRACE_FEMUR].compliance_rad_per_n_mm)
#define SPRING_TIBIA FIELD(joint[BRACE_TIBIA].compliance_rad_per_n_mm)
#define SPRING_BASE FIELD(base.rotation_rad_per_n_mm)

/* What one sigma of a cause is: of its own dimension, or as a fraction of the cause's own size; or that the
 * cause has more terms. */
enum { ANGLE, FEMUR_LENGTH, TIBIA_LENGTH, COMPLIANCE, TRUST_COUNT, MORE = TRUST_COUNT };

/* One term of dC: (u v' + v u') weight. A cause is a run of terms; the last of them says how well the cause
 * is known. What is a compliance times u u' comes out doubled, so its causes are spelt doubled and known to
 * half. */
typedef struct {
    uint8_t u : 4, v : 4, weight : 5, known_to : 3;
} term_t;

static const term_t terms[] = {
    /* theta1 turns all of C, from which the sum starts, but the base */
    {BASE_X, BASE_Z, BASE_SLENDERNESS, ANGLE},
    /* theta2 moves the tip across the shank, so the levers along it, and turns the tibia's ellipsoid */
    {SHANK, LEVER_FEMUR, SPRING_FEMUR, MORE},
    {SHANK, LEVER_FEMUR, SPRING_BASE, MORE},
    {SHANK, LEVER_TIBIA, SPRING_TIBIA, MORE},
    {SHANK, LEVER_TIBIA, TURN_PER_MOMENT, MORE},
    {SHANK, FEMUR_BENDING, BEND_PER_MOMENT, MORE},
    {TIBIA_AXIAL, TIBIA_BENDING, TIBIA_SLENDERNESS, ANGLE},
    /* a longer femur grows the levers about its joint, and yields less (here with the sign turned) */
    {LEVER_THIGH, LEVER_FEMUR, SPRING_FEMUR, MORE},
    {LEVER_THIGH, LEVER_FEMUR, SPRING_BASE, MORE},
    {FEMUR_BENDING, LEVER_TIBIA, BEND_PER_MOMENT, MORE},
    {LEVER_TIBIA, LEVER_TIBIA, TURN_PER_MOMENT, FEMUR_LENGTH},
    /* a longer tibia grows all levers */
    {LEVER_TIBIA, LEVER_FEMUR, SPRING_FEMUR, MORE},
    {LEVER_TIBIA, LEVER_FEMUR, SPRING_BASE, MORE},
    {LEVER_TIBIA, LEVER_TIBIA, SPRING_TIBIA, MORE},
    {LEVER_TIBIA, LEVER_TIBIA, TURN_PER_MOMENT, MORE},
    {LEVER_TIBIA, FEMUR_BENDING, BEND_PER_MOMENT, TIBIA_LENGTH},
    /* the compliances */
    {FEMUR_BENDING, FEMUR_BENDING, FIELD(link[BRACE_FEMUR].bending_mm_per_n), MORE},
    {FEMUR_BENDING, LEVER_TIBIA, BEND_PER_MOMENT, MORE},
    {FEMUR_BENDING, LEVER_TIBIA, BEND_PER_MOMENT, MORE},
    {LEVER_TIBIA, LEVER_TIBIA, TURN_PER_MOMENT, COMPLIANCE},
    {FEMUR_AXIAL, FEMUR_AXIAL, FIELD(link[BRACE_FEMUR].axial_mm_per_n), COMPLIANCE},
    {TIBIA_AXIAL, TIBIA_AXIAL, FIELD(link[BRACE_TIBIA].axial_mm_per_n), COMPLIANCE},
    {TIBIA_BENDING, TIBIA_BENDING, FIELD(link[BRACE_TIBIA].bending_mm_per_n), COMPLIANCE},
    {LEVER_FEMUR, LEVER_FEMUR, SPRING_FEMUR, COMPLIANCE},
    {LEVER_TIBIA, LEVER_TIBIA, SPRING_TIBIA, COMPLIANCE},
    {BASE_X, BASE_X, FIELD(base.x_mm_per_n), COMPLIANCE},
    {BASE_Z, BASE_Z, FIELD(base.z_mm_per_n), COMPLIANCE},
    {LEVER_FEMUR, LEVER_FEMUR, SPRING_BASE, COMPLIANCE},
};

/* Scaled by the eigenvalues: what a compliance is between the bare vectors, -dK is between these. */
static void find_vectors(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                         const brace_stiffness_t *stiffness, brace_vec_t vectors[VECTOR_COUNT])
{
    const float lambda_stiff = stiffness->lambda_max_n_per_mm;
    const float lambda_soft = stiffness->lambda_min_n_per_mm;
    const uint32_t axis = brace_turn(stiffness->stiff_axis_rad);
    const uint32_t femur = brace_turn(theta1_rad) - axis;
    const uint32_t tibia = femur - brace_turn(theta2_rad);
    const uint32_t turn[DIRECTION_COUNT] = {
        [BASE] = 0u - axis,
        [FEMUR] = femur + brace_turn(limb->link[BRACE_FEMUR].tilt_rad),
        [TIBIA] = tibia + brace_turn(limb->link[BRACE_TIBIA].tilt_rad),
        [HIP] = femur + HALF_TURN,
        [TIP] = tibia,
    };
    const float *lengths = (const float *)limb + PLACE(femur_mm); /* and tibia_mm */
    for (int i = 0; i < DIRECTION_COUNT; i++) {
        const float length = i < HIP ? 1.0f : lengths[i - HIP];
        const brace_vec_t v = vec_scaled(brace_direction(turn[i]), length);
        vectors[2 * i] = (brace_vec_t){lambda_stiff * v.x, lambda_soft * v.z};
        vectors[2 * i + 1] = (brace_vec_t){-lambda_stiff * v.z, lambda_soft * v.x};
    }
    vectors[LEVER_FEMUR] = vec_minus(vectors[LEVER_TIBIA], vectors[LEVER_THIGH]);
}

/* The figures a stiffness begins with and, behind them, that of the axis; as brace_stiffness_sigma_t. */
enum { XX, XZ, ZZ, SOFT, STIFF, ENTRY_COUNT, CROSS = ENTRY_COUNT, FIGURE_COUNT };

_Static_assert(offsetof(brace_stiffness_t, stiff_axis_rad) == ENTRY_COUNT * sizeof(float) &&
                   offsetof(brace_stiffness_sigma_t, stiff_axis_rad) == ENTRY_COUNT * sizeof(float),
               "entries and eigenvalues first, and in one order");

BRACE_OFF_TICK
brace_status_t brace_uncertainty_stiffness(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                           const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma)
{
    if (sigma == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_limb_check(limb);
    return status == BRACE_OK ? brace_uncertainty_known(limb, theta1_rad, theta2_rad, stiffness, sigma) : status;
}

BRACE_OFF_TICK
brace_status_t brace_uncertainty_known(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                       const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma)
{
    brace_status_t status = brace_check_two(theta1_rad, theta2_rad, BRACE_ANGLE_LIMIT_RAD);
    if (status == BRACE_OK) {
        status = brace_check_stiffness(stiffness);
    }
    if (status != BRACE_OK) {
        return status;
    }
    const float lambda_stiff = stiffness->lambda_max_n_per_mm;
    const float lambda_soft = stiffness->lambda_min_n_per_mm;
    brace_vec_t vectors[VECTOR_COUNT];
    find_vectors(limb, theta1_rad, theta2_rad, stiffness, vectors);
    const brace_link_t *femur = &limb->link[BRACE_FEMUR];
    const brace_link_t *tibia = &limb->link[BRACE_TIBIA];
    const float *fields = (const float *)limb + PLACE(FIRST);
    const float bend = 1.5f * femur->moment_transfer_ratio * femur->bending_mm_per_n / limb->femur_mm;
    const float weights[WEIGHT_COUNT] = {
        [BEND_PER_MOMENT] = bend,
        [TURN_PER_MOMENT] = 2.0f * bend / limb->femur_mm,
        [TIBIA_SLENDERNESS] = tibia->bending_mm_per_n - tibia->axial_mm_per_n,
        [BASE_SLENDERNESS] = limb->base.z_mm_per_n - limb->base.x_mm_per_n,
    };
    const brace_uncertainty_t *trust = &limb->uncertainty;
    const float one_sigma[TRUST_COUNT] = {
        [ANGLE] = trust->angle_rad,
        [FEMUR_LENGTH] = trust->length_mm / limb->femur_mm,
        [TIBIA_LENGTH] = trust->length_mm / limb->tibia_mm,
        [COMPLIANCE] = 0.5f * trust->compliance_rel,
    };

    const float *entry = (const float *)stiffness;
    float *variance = (float *)sigma; /* until the roots are taken */
    for (int figure = 0; figure < ENTRY_COUNT; figure++) {
        const float by_gain = entry[figure] * trust->gain_rel; /* scales all of K alike */
        variance[figure] = by_gain * by_gain;
    }
    variance[CROSS] = 0.0f;
    /* the limb's x, seen from the axes */
    const brace_vec_t x = brace_direction(0u - brace_turn(stiffness->stiff_axis_rad));
    float stiff = 0.0f;
    float cross = lambda_soft - lambda_stiff;
    float soft = 0.0f;
    for (const term_t *term = terms; term < terms + sizeof terms / sizeof *terms; term++) {
        const brace_vec_t u = vectors[term->u];
        const brace_vec_t v = vectors[term->v];
        const unsigned place = term->weight;
        const float weight = place < WEIGHT_COUNT ? weights[place] : fields[place - WEIGHT_COUNT];
        stiff += 2.0f * weight * u.x * v.x;
        cross += weight * (u.x * v.z + u.z * v.x);
        soft += 2.0f * weight * u.z * v.z;
        if (term->known_to == MORE) {
            continue;
        }
        const float shear = 2.0f * x.x * x.z * cross;
        const float shift[FIGURE_COUNT] = {
            [XX] = x.x * x.x * stiff + shear + x.z * x.z * soft,
            [XZ] = x.x * x.z * (soft - stiff) + (x.x * x.x - x.z * x.z) * cross,
            [ZZ] = x.z * x.z * stiff - shear + x.x * x.x * soft,
            [SOFT] = soft,
            [STIFF] = stiff,
            [CROSS] = cross,
        };
        for (int figure = 0; figure < FIGURE_COUNT; figure++) {
            const float known_to = shift[figure] * one_sigma[term->known_to];
            variance[figure] += known_to * known_to;
        }
        stiff = cross = soft = 0.0f;
    }
    for (int figure = 0; figure < FIGURE_COUNT; figure++) {
        variance[figure] = brace_sqrt(variance[figure]);
    }
    const float apart = lambda_stiff - lambda_soft;
    sigma->flags = stiffness->flags;
    if (sigma->stiff_axis_rad < UNKNOWN_AXIS_RAD * apart) {
        sigma->stiff_axis_rad /= apart;
    } else {
        sigma->stiff_axis_rad = UNKNOWN_AXIS_RAD;
        sigma->flags |= BRACE_FLAG_SATURATED;
    }
    return BRACE_OK;
}
