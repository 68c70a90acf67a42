/* Everything here lives in K's principal frame, x along the stiff axis. There C and K are diagonal, so the
 * eigenvalues' shifts are dK's diagonal and the axis's turn its corner over the eigenvalues' difference; and
 * the small component of a lever along the stiff axis is computed, not left over from a subtraction.
 */
#include "brace/uncertainty.h"

#include <stdbool.h>
#include <stddef.h>

#include "brace/kinematics.h"
#include "check.h"
#include "trig.h"
#include "vec.h"

/* pi / sqrt(12): an axis that may point anywhere. */
#define UNKNOWN_AXIS_RAD 0.906899682f

/* The vectors that C and its derivatives are made of. */
enum {
    BASE_X, /* unit, as the next five, of which every second is the first turned by +90 degrees */
    BASE_Z,
    FEMUR_AXIAL, /* the ellipsoids' principal axes, tilt included */
    FEMUR_BENDING,
    TIBIA_AXIAL,
    TIBIA_BENDING,
    SHANK,       /* knee to tip [mm] */
    LEVER_KNEE,  /* the knee's shift for a unit turn of the femur's joint [mm] */
    LEVER_FEMUR, /* the tip's shift for the same, and for a unit turn of the tibia's joint */
    LEVER_TIBIA,
    VECTOR_COUNT
};

/* The compliances that weigh them: what follows from the limb's, */
enum {
    BEND_PER_MOMENT, /* the femur's shift and turn per moment of the tip force about the knee, */
    BEND_PER_MOMENT_TWICE,
    TURN_PER_MOMENT,
    BEND_PER_MOMENT_FALLS, /* and their derivatives by the femur's length, times it (the turn's halved) */
    TURN_PER_MOMENT_FALLS,
    TURN_AT_FEMUR, /* all that turns about the femur's joint, about the knee */
    TURN_AT_KNEE,
    TIBIA_SLENDERNESS, /* what shows of an ellipsoid's turning: bending - axial */
    BASE_SLENDERNESS,
    WEIGHT_COUNT
};

/* and the limb's own, by their place among its floats. */
#define FIELD(name) ((uint8_t)(WEIGHT_COUNT + offsetof(brace_limb_t, name) / sizeof(float)))

/* What one sigma of a cause is: of its own dimension, or as a fraction of the cause's own size. */
enum { MORE, ANGLE, FEMUR_LENGTH, TIBIA_LENGTH, COMPLIANCE, TRUST_COUNT };

/* One term of dC: weight (u v' + v u'). A cause is a run of terms; the last of them says how well the cause
 * is known. What is a compliance times u u' comes out doubled, so its causes are spelt doubled and known to
 * half. */
typedef struct {
    uint8_t weight, u, v, known_to;
} term_t;

static const term_t terms[] = {
    /* theta1 turns all of C, from which the sum starts, but the base */
    {BASE_SLENDERNESS, BASE_X, BASE_Z, ANGLE},
    /* theta2 moves the tip across the shank, so the levers along it, and turns the tibia's ellipsoid */
    {TURN_AT_FEMUR, SHANK, LEVER_FEMUR, MORE},
    {TURN_AT_KNEE, SHANK, LEVER_TIBIA, MORE},
    {BEND_PER_MOMENT, SHANK, FEMUR_BENDING, MORE},
    {TIBIA_SLENDERNESS, TIBIA_AXIAL, TIBIA_BENDING, ANGLE},
    /* the lengths grow the levers */
    {TURN_AT_FEMUR, LEVER_KNEE, LEVER_FEMUR, MORE},
    {BEND_PER_MOMENT_FALLS, FEMUR_BENDING, LEVER_TIBIA, MORE},
    {TURN_PER_MOMENT_FALLS, LEVER_TIBIA, LEVER_TIBIA, FEMUR_LENGTH},
    {TURN_AT_FEMUR, LEVER_TIBIA, LEVER_FEMUR, MORE},
    {TURN_AT_KNEE, LEVER_TIBIA, LEVER_TIBIA, MORE},
    {BEND_PER_MOMENT, LEVER_TIBIA, FEMUR_BENDING, TIBIA_LENGTH},
    /* the compliances */
    {FIELD(link[BRACE_FEMUR].bending_mm_per_n), FEMUR_BENDING, FEMUR_BENDING, MORE},
    {BEND_PER_MOMENT_TWICE, FEMUR_BENDING, LEVER_TIBIA, MORE},
    {TURN_PER_MOMENT, LEVER_TIBIA, LEVER_TIBIA, COMPLIANCE},
    {FIELD(link[BRACE_FEMUR].axial_mm_per_n), FEMUR_AXIAL, FEMUR_AXIAL, COMPLIANCE},
    {FIELD(link[BRACE_TIBIA].axial_mm_per_n), TIBIA_AXIAL, TIBIA_AXIAL, COMPLIANCE},
    {FIELD(link[BRACE_TIBIA].bending_mm_per_n), TIBIA_BENDING, TIBIA_BENDING, COMPLIANCE},
    {FIELD(joint[BRACE_FEMUR].compliance_rad_per_n_mm), LEVER_FEMUR, LEVER_FEMUR, COMPLIANCE},
    {FIELD(joint[BRACE_TIBIA].compliance_rad_per_n_mm), LEVER_TIBIA, LEVER_TIBIA, COMPLIANCE},
    {FIELD(base.x_mm_per_n), BASE_X, BASE_X, COMPLIANCE},
    {FIELD(base.z_mm_per_n), BASE_Z, BASE_Z, COMPLIANCE},
    {FIELD(base.rotation_rad_per_n_mm), LEVER_FEMUR, LEVER_FEMUR, COMPLIANCE},
};

static void find_vectors(const brace_limb_t *limb, uint32_t axis, uint32_t femur, uint32_t tibia,
                         brace_vec_t vectors[VECTOR_COUNT])
{
    vectors[BASE_X] = brace_direction(0u - axis);
    vectors[FEMUR_AXIAL] = brace_direction(femur + brace_turn(limb->link[BRACE_FEMUR].tilt_rad));
    vectors[TIBIA_AXIAL] = brace_direction(tibia + brace_turn(limb->link[BRACE_TIBIA].tilt_rad));
    for (int i = BASE_X; i <= TIBIA_AXIAL; i += 2) {
        vectors[i + 1] = vec_quarter(vectors[i]);
    }
    const brace_vec_t thigh = vec_scaled(brace_direction(femur), limb->femur_mm);
    const brace_vec_t shank = vec_scaled(brace_direction(tibia), limb->tibia_mm);
    vectors[SHANK] = shank;
    vectors[LEVER_KNEE] = vec_quarter(thigh);
    vectors[LEVER_TIBIA] = vec_quarter(shank);
    vectors[LEVER_FEMUR] = (brace_vec_t){-thigh.z - shank.z, thigh.x + shank.x};
}

static void find_weights(const brace_limb_t *limb, float weights[WEIGHT_COUNT])
{
    const brace_link_t *femur = &limb->link[BRACE_FEMUR];
    const brace_link_t *tibia = &limb->link[BRACE_TIBIA];
    const float bend = 1.5f * femur->moment_transfer_ratio * femur->bending_mm_per_n / limb->femur_mm;
    const float turn = 2.0f * bend / limb->femur_mm;
    weights[BEND_PER_MOMENT] = bend;
    weights[BEND_PER_MOMENT_TWICE] = 2.0f * bend;
    weights[TURN_PER_MOMENT] = turn;
    weights[BEND_PER_MOMENT_FALLS] = -bend;
    weights[TURN_PER_MOMENT_FALLS] = -turn;
    weights[TURN_AT_FEMUR] =
        limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm + limb->base.rotation_rad_per_n_mm;
    weights[TURN_AT_KNEE] = limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm + turn;
    weights[TIBIA_SLENDERNESS] = tibia->bending_mm_per_n - tibia->axial_mm_per_n;
    weights[BASE_SLENDERNESS] = limb->base.z_mm_per_n - limb->base.x_mm_per_n;
}

/* The variance of a value from the causes so far, and from the gain that scales all values alike. */
static float root_with_gain(float variance, float value, float gain_rel)
{
    const float by_gain = value * gain_rel;
    return brace_sqrt(variance + by_gain * by_gain);
}

brace_status_t brace_uncertainty_stiffness(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                           const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma)
{
    if (sigma == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_limb_check(limb);
    if (status == BRACE_OK) {
        status = brace_check_two(theta1_rad, theta2_rad, BRACE_ANGLE_LIMIT_RAD);
    }
    if (status == BRACE_OK) {
        status = brace_check_stiffness(stiffness);
    }
    if (status != BRACE_OK) {
        return status;
    }
    brace_vec_t vectors[VECTOR_COUNT];
    const float *fields = (const float *)limb;
    float weights[WEIGHT_COUNT];
    const uint32_t axis = brace_turn(stiffness->stiff_axis_rad);
    const uint32_t femur = brace_turn(theta1_rad) - axis;
    find_vectors(limb, axis, femur, femur - brace_turn(theta2_rad), vectors);
    find_weights(limb, weights);

    const brace_uncertainty_t *trust = &limb->uncertainty;
    const float one_sigma[TRUST_COUNT] = {
        [ANGLE] = trust->angle_rad,
        [FEMUR_LENGTH] = trust->length_mm / limb->femur_mm,
        [TIBIA_LENGTH] = trust->length_mm / limb->tibia_mm,
        [COMPLIANCE] = 0.5f * trust->compliance_rel,
    };
    const float lambda_stiff = stiffness->lambda_max_n_per_mm;
    const float lambda_soft = stiffness->lambda_min_n_per_mm;
    const brace_vec_t x = vectors[BASE_X]; /* the limb's x, seen from the axes */
    float dc_stiff = 0.0f;
    float dc_cross = 1.0f / lambda_stiff - 1.0f / lambda_soft;
    float dc_soft = 0.0f;
    float var_stiff = 0.0f, var_cross = 0.0f, var_soft = 0.0f;
    float var_xx = 0.0f, var_xz = 0.0f, var_zz = 0.0f;
    for (size_t i = 0; i < sizeof terms / sizeof terms[0]; i++) {
        const brace_vec_t u = vectors[terms[i].u];
        const brace_vec_t v = vectors[terms[i].v];
        const uint8_t place = terms[i].weight;
        const float weight = place < WEIGHT_COUNT ? weights[place] : fields[place - WEIGHT_COUNT];
        dc_stiff += 2.0f * weight * u.x * v.x;
        dc_cross += weight * (u.x * v.z + u.z * v.x);
        dc_soft += 2.0f * weight * u.z * v.z;
        if (terms[i].known_to == MORE) {
            continue;
        }
        const float stiff_sigma = lambda_stiff * one_sigma[terms[i].known_to];
        const float soft_sigma = lambda_soft * one_sigma[terms[i].known_to];
        const float stiff = lambda_stiff * stiff_sigma * dc_stiff;
        const float cross = lambda_soft * stiff_sigma * dc_cross;
        const float soft = lambda_soft * soft_sigma * dc_soft;
        const float shear = 2.0f * x.x * x.z * cross;
        const float xx = x.x * x.x * stiff + shear + x.z * x.z * soft;
        const float zz = x.z * x.z * stiff - shear + x.x * x.x * soft;
        const float xz = x.x * x.z * (soft - stiff) + (x.x * x.x - x.z * x.z) * cross;
        var_stiff += stiff * stiff;
        var_cross += cross * cross;
        var_soft += soft * soft;
        var_xx += xx * xx;
        var_xz += xz * xz;
        var_zz += zz * zz;
        dc_stiff = dc_cross = dc_soft = 0.0f;
    }
    const float gain_rel = trust->gain_rel;
    sigma->k_xx_n_per_mm = root_with_gain(var_xx, stiffness->k_xx_n_per_mm, gain_rel);
    sigma->k_xz_n_per_mm = root_with_gain(var_xz, stiffness->k_xz_n_per_mm, gain_rel);
    sigma->k_zz_n_per_mm = root_with_gain(var_zz, stiffness->k_zz_n_per_mm, gain_rel);
    sigma->lambda_min_n_per_mm = root_with_gain(var_soft, lambda_soft, gain_rel);
    sigma->lambda_max_n_per_mm = root_with_gain(var_stiff, lambda_stiff, gain_rel);

    const float apart = lambda_stiff - lambda_soft;
    const float corner = brace_sqrt(var_cross);
    const bool axis_known = corner < UNKNOWN_AXIS_RAD * apart;
    sigma->stiff_axis_rad = axis_known ? corner / apart : UNKNOWN_AXIS_RAD;
    sigma->flags = stiffness->flags | (axis_known ? 0u : (uint32_t)BRACE_FLAG_SATURATED);
    return BRACE_OK;
}
