/* Everything here lives in K's principal frame, x along the stiff axis. There C and K are diagonal, so the
 * eigenvalues' shifts are dK's diagonal and the axis's turn its corner over the eigenvalues' difference. What a lever
 * has along the stiff axis, little, is known to a few 1e-7 of the whole lever: the axis itself is not known better.
 */
#include "brace/uncertainty.h"

#include <stdbool.h>
#include <stddef.h>

#include "brace/kinematics.h"
#include "base/check.h"
#include "base/off_tick.h"
#include "base/trig.h"
#include "base/vec.h"
#include "chain/tensor.h"

/* pi / sqrt(12): an axis that may point anywhere. */
#define UNKNOWN_AXIS_RAD 0.906899682f

/* The vectors that C and its derivatives are made of: a pose's, its tip replaced by the base's x, and the links' axes; */
enum { KNEE, BASE, FEMUR_JOINT, TIBIA_JOINT, AXES, DIRECTION_COUNT = AXES + 2 };

_Static_assert(offsetof(brace_pose_t, lever_femur) == FEMUR_JOINT * sizeof(brace_vec_t) &&
                   offsetof(brace_pose_t, lever_tibia) == TIBIA_JOINT * sizeof(brace_vec_t),
               "a pose is four vectors");

/* each followed by itself turned by -90 degrees. */
enum {
    LEVER_THIGH = 2 * KNEE + 1,    /* the femur joint's shift for a unit turn about the knee [mm] */
    BASE_X = 2 * BASE,             /* unit vectors */
    BASE_Z,
    LEVER_FEMUR = 2 * FEMUR_JOINT, /* the tip's shift for a unit turn about the femur's joint */
    LEVER_TIBIA = 2 * TIBIA_JOINT, /* and about the knee */
    SHANK,                         /* knee to tip */
    FEMUR_AXIAL = 2 * AXES,        /* the ellipsoids' principal axes, tilt included; unit vectors */
    FEMUR_BENDING,
    TIBIA_AXIAL,
    TIBIA_BENDING,
    VECTOR_COUNT
};

typedef union {
    brace_pose_t pose;
    brace_vec_t at[VECTOR_COUNT];
} vectors_t;

/* The compliances that weigh them: what follows from the limb's, */
enum {
    BEND_PER_MOMENT, /* the femur's shift and turn per moment of the tip force about the knee */
    TURN_PER_MOMENT,
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
 * cause has more terms. Of an angle's last term an ellipsoid turns, of which only the difference of its two compliances
 * shows: the weight is the named less the one behind it. */
enum { MORE, ANGLE, FEMUR_LENGTH, TIBIA_LENGTH, COMPLIANCE, TRUST_COUNT };

/* One term of dC: (u v' + v u') weight. A cause is a run of terms; the last of them says how well the cause
 * is known. What is a compliance times u u' comes out doubled, so its causes are spelt doubled and known to
 * half. */
typedef struct {
    uint8_t u : 4, v : 4, weight : 5, known_to : 3;
} term_t;

static const term_t terms[] = {
    /* theta1 turns all of C, from which the sum starts, but the base */
    {BASE_X, BASE_Z, FIELD(base.x_mm_per_n), ANGLE},
    /* theta2 moves the tip across the shank, so the levers along it, and turns the tibia's ellipsoid */
    {SHANK, LEVER_FEMUR, SPRING_FEMUR, MORE},
    {SHANK, LEVER_FEMUR, SPRING_BASE, MORE},
    {SHANK, LEVER_TIBIA, SPRING_TIBIA, MORE},
    {SHANK, LEVER_TIBIA, TURN_PER_MOMENT, MORE},
    {SHANK, FEMUR_BENDING, BEND_PER_MOMENT, MORE},
    {TIBIA_AXIAL, TIBIA_BENDING, FIELD(link[BRACE_TIBIA].axial_mm_per_n), ANGLE},
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

/* As seen from K's axes and scaled by the eigenvalues: what a compliance is between the bare vectors, -dK is between
 * these. x: the limb's, seen from the same axes. */
static void find_vectors(const brace_limb_t *limb, const float theta_rad[2], const brace_stiffness_t *stiffness,
                         brace_vec_t x, vectors_t *vectors)
{
    const float lambda_stiff = stiffness->lambda_max_n_per_mm;
    const float lambda_soft = stiffness->lambda_min_n_per_mm;
    brace_kinematics_pose(limb, theta_rad[0], theta_rad[1], &vectors->pose);
    vectors->at[BASE] = (brace_vec_t){1.0f, 0.0f};
    const uint32_t femur_turn = brace_turn(theta_rad[0]), tibia_turn = femur_turn - brace_turn(theta_rad[1]);
    vectors->at[AXES] = brace_direction(femur_turn + brace_turn(limb->link[BRACE_FEMUR].tilt_rad));
    vectors->at[AXES + 1] = brace_direction(tibia_turn + brace_turn(limb->link[BRACE_TIBIA].tilt_rad));
    for (int i = DIRECTION_COUNT; i-- > 0;) { /* backwards: each makes room for two */
        const brace_vec_t v = brace_turned(vectors->at[i], x);
        vectors->at[2 * i] = (brace_vec_t){lambda_stiff * v.x, lambda_soft * v.z};
        vectors->at[2 * i + 1] = (brace_vec_t){lambda_stiff * v.z, -(lambda_soft * v.x)};
    }
}

/* The figures a stiffness begins with and, behind them, that of the axis; as brace_stiffness_sigma_t. */
enum { XX, XZ, ZZ, SOFT, STIFF, CROSS, FIGURE_COUNT };

_Static_assert(offsetof(brace_stiffness_sigma_t, stiff_axis_rad) == CROSS * sizeof(float), "one order");

BRACE_OFF_TICK
static brace_status_t estimate(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                               const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma, bool limb_is_known)
{
    const float theta_rad[] = {theta1_rad, theta2_rad};
    brace_status_t status = limb_is_known ? BRACE_OK : brace_limb_check(limb);
    if (status == BRACE_OK) {
        status = brace_check_stiffness(stiffness, sigma, theta_rad, BRACE_INPUT_ANGLES);
    }
    if (status != BRACE_OK) {
        return status;
    }
    vectors_t vectors;
    const brace_vec_t x = brace_direction(0u - brace_turn(stiffness->stiff_axis_rad));
    find_vectors(limb, theta_rad, stiffness, x, &vectors);
    const brace_link_t *femur = &limb->link[BRACE_FEMUR];
    const float *fields = (const float *)limb + PLACE(FIRST) - WEIGHT_COUNT;
    const float bend = -1.5f * femur->moment_transfer_ratio * femur->bending_mm_per_n / limb->femur_mm;
    const float weights[WEIGHT_COUNT] = {
        [BEND_PER_MOMENT] = bend,
        [TURN_PER_MOMENT] = -2.0f * bend / limb->femur_mm,
    };
    const brace_uncertainty_t *trust = &limb->uncertainty;
    float one_sigma[TRUST_COUNT];
    one_sigma[ANGLE] = trust->angle_rad;
    one_sigma[FEMUR_LENGTH] = trust->length_mm / limb->femur_mm;
    one_sigma[TIBIA_LENGTH] = trust->length_mm / limb->tibia_mm;
    one_sigma[COMPLIANCE] = 0.5f * trust->compliance_rel;

    float *variance = (float *)sigma; /* until the roots are taken */
    const float gain = trust->gain_rel;
    const float *entry = (const float *)stiffness;
    for (int figure = 0; figure < CROSS; figure++) {
        const float by_gain = entry[figure] * gain; /* scales all of K alike */
        variance[figure] = by_gain * by_gain;
    }
    variance[CROSS] = 0.0f;

    /* from K's axes to the limb's, twice the angle */
    const brace_vec_t twice = {x.x * x.x - x.z * x.z, -2.0f * x.x * x.z};
    const float apart = stiffness->lambda_max_n_per_mm - stiffness->lambda_min_n_per_mm;
    float stiff = 0.0f, cross = -apart, soft = 0.0f; /* half of dK's diagonal, and its corner */
    for (const term_t *term = terms; term < terms + sizeof terms / sizeof *terms;) { /* at most thirteen, the causes */
        unsigned known_to;
        do { /* at most six, its terms */
            const brace_vec_t u = vectors.at[term->u];
            const brace_vec_t v = vectors.at[term->v];
            const float *at = (term->weight < WEIGHT_COUNT ? weights : fields) + term->weight;
            known_to = term->known_to;
            const float weight = known_to == ANGLE ? at[0] - at[1] : at[0];
            const brace_vec_t weighted = {weight * u.x, weight * u.z};
            stiff += weighted.x * v.x;
            cross += weighted.x * v.z;
            cross += weighted.z * v.x;
            soft += weighted.z * v.z;
            term++;
        } while (known_to == MORE);
        const float mean = stiff + soft;
        const brace_vec_t dev = brace_turned((brace_vec_t){stiff - soft, cross}, twice);
        const float shift[FIGURE_COUNT] = {
            [XX] = mean + dev.x,
            [XZ] = dev.z,
            [ZZ] = mean - dev.x,
            [SOFT] = 2.0f * soft,
            [STIFF] = 2.0f * stiff,
            [CROSS] = cross,
        };
        for (int figure = 0; figure < FIGURE_COUNT; figure++) {
            const float by_cause = shift[figure] * one_sigma[known_to];
            variance[figure] += by_cause * by_cause;
        }
        stiff = cross = soft = 0.0f;
    }
    for (int figure = 0; figure < FIGURE_COUNT; figure++) {
        variance[figure] = brace_sqrt(variance[figure]);
    }
    sigma->stiff_axis_rad = variance[CROSS] / apart;
    sigma->flags = stiffness->flags;
    if (brace_magnitude_bits(sigma->stiff_axis_rad) >= brace_magnitude_bits(UNKNOWN_AXIS_RAD)) {
        sigma->stiff_axis_rad = UNKNOWN_AXIS_RAD;
        sigma->flags |= BRACE_FLAG_SATURATED;
    }
    return BRACE_OK;
}

BRACE_OFF_TICK
brace_status_t brace_uncertainty_stiffness(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                           const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma)
{
    return estimate(limb, theta1_rad, theta2_rad, stiffness, sigma, false);
}

BRACE_OFF_TICK
brace_status_t brace_uncertainty_known(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                       const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma)
{
    return estimate(limb, theta1_rad, theta2_rad, stiffness, sigma, true);
}
