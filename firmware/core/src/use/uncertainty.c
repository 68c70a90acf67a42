/* Everything here is seen in K's principal frame, x along the stiff axis. There C and K are diagonal. So the diagonal
 * of dK is the shift of the eigenvalues, and its corner over the difference of the eigenvalues is the turn of the axis.
 * A lever's small component along the stiff axis is known to a few 1e-7 of the whole lever, because the axis itself is
 * not known better.
 */
#include "brace/uncertainty.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/check.h"
#include "base/trig.h"
#include "base/vec.h"
#include "brace/kinematics.h"
#include "use/stiffness_check.h"

/* The vectors of C and of its derivatives, seen from K's axes and multiplied by K. If dC is a sum of terms u v', then
 * -dK = K dC K is the same sum of these vectors. */
typedef struct {
    brace_vec_t base_x, base_z;             /* unit vectors */
    brace_vec_t lever_femur;                /* the tip's shift for a unit turn about the femur joint [mm] */
    brace_vec_t lever_tibia;                /* the tip's shift for a unit turn about the knee [mm] */
    brace_vec_t lever_thigh;                /* the femur joint's shift for a unit turn about the knee [mm] */
    brace_vec_t shank;                      /* from the knee to the tip [mm] */
    brace_vec_t femur_axial, femur_bending; /* the ellipsoids' principal axes, tilt included; unit vectors */
    brace_vec_t tibia_axial, tibia_bending;
} vectors_t;

/* The direction of K's axes, and the factor of K along each of them. */
typedef struct {
    brace_vec_t stiff_axis;
    float stiff_n_per_mm, soft_n_per_mm;
} frame_t;

static brace_vec_t seen(const frame_t *frame, float x, float z)
{
    const brace_vec_t v = vec_turned_back((brace_vec_t){x, z}, frame->stiff_axis);
    return (brace_vec_t){frame->stiff_n_per_mm * v.x, frame->soft_n_per_mm * v.z};
}

static vectors_t vectors_at(const brace_limb_t *limb, float theta1_rad, float theta2_rad, const frame_t *frame)
{
    brace_pose_t pose;
    brace_kinematics_pose(limb, theta1_rad, theta2_rad, &pose);
    const brace_vec_t femur = brace_direction(theta1_rad);
    const brace_vec_t tibia = vec_turned_back(femur, brace_direction(theta2_rad));
    const brace_vec_t femur_axial = vec_turned(femur, brace_direction(limb->link[BRACE_FEMUR].tilt_rad));
    const brace_vec_t tibia_axial = vec_turned(tibia, brace_direction(limb->link[BRACE_TIBIA].tilt_rad));
    return (vectors_t){
        .base_x = seen(frame, 1.0f, 0.0f),
        .base_z = seen(frame, 0.0f, 1.0f),
        .lever_femur = seen(frame, pose.lever_femur.x_mm, pose.lever_femur.z_mm),
        .lever_tibia = seen(frame, pose.lever_tibia.x_mm, pose.lever_tibia.z_mm),
        .lever_thigh = seen(frame, pose.knee.z_mm, -pose.knee.x_mm),
        .shank = seen(frame, pose.lever_tibia.z_mm, -pose.lever_tibia.x_mm),
        .femur_axial = seen(frame, femur_axial.x, femur_axial.z),
        .femur_bending = seen(frame, -femur_axial.z, femur_axial.x),
        .tibia_axial = seen(frame, tibia_axial.x, tibia_axial.z),
        .tibia_bending = seen(frame, -tibia_axial.z, tibia_axial.x),
    };
}

/* A change of K in its principal frame: half of each diagonal entry, and the corner. */
typedef struct {
    float half_stiff, corner, half_soft;
} change_t;

/* change += weight (u v' + v u') */
static inline void add(change_t *change, float weight, brace_vec_t u, brace_vec_t v)
{
    const brace_vec_t weighted = vec_scaled(u, weight);
    change->half_stiff = brace_fma(weighted.x, v.x, change->half_stiff);
    change->corner = brace_fma(weighted.x, v.z, brace_fma(weighted.z, v.x, change->corner));
    change->half_soft = brace_fma(weighted.z, v.z, change->half_soft);
}

static inline float square(float value)
{
    return value * value;
}

/* Adds an independent cause whose one sigma changes K by sigma times `change`. Until all causes are added, `variance`
 * holds squares, and the corner's square in place of that of the axis's angle. to_world: the direction of twice the
 * stiff axis's angle. */
static void count(brace_stiffness_sigma_t *variance, brace_vec_t to_world, float sigma, change_t change)
{
    const float mean = change.half_stiff + change.half_soft;
    const brace_vec_t dev = vec_turned((brace_vec_t){change.half_stiff - change.half_soft, change.corner}, to_world);
    variance->k_xx_n_per_mm += square((mean + dev.x) * sigma);
    variance->k_xz_n_per_mm += square(dev.z * sigma);
    variance->k_zz_n_per_mm += square((mean - dev.x) * sigma);
    variance->lambda_min_n_per_mm += square(2.0f * change.half_soft * sigma);
    variance->lambda_max_n_per_mm += square(2.0f * change.half_stiff * sigma);
    variance->stiff_axis_rad += square(change.corner * sigma);
}

/* The compliances that several causes share. */
typedef struct {
    float hip, knee;                            /* [rad/(N mm)]; hip: joint 1 and the base's rotation */
    float bend_per_moment, turn_per_moment;     /* of the femur, per moment of the tip force about the knee */
} weights_t;

static void count_angles(brace_stiffness_sigma_t *variance, brace_vec_t to_world, const brace_limb_t *limb,
                         const weights_t *w, const vectors_t *v, float apart_n_per_mm)
{
    /* theta1 turns all of K except the base's part. */
    change_t by_theta1 = {.corner = -apart_n_per_mm};
    add(&by_theta1, limb->base.z_mm_per_n - limb->base.x_mm_per_n, v->base_x, v->base_z);
    count(variance, to_world, limb->uncertainty.angle_rad, by_theta1);

    /* theta2 moves the tip, and so the levers, along the shank, and turns the tibia's ellipsoid. */
    const brace_link_t *tibia = &limb->link[BRACE_TIBIA];
    change_t by_theta2 = {0};
    add(&by_theta2, w->hip, v->shank, v->lever_femur);
    add(&by_theta2, w->knee, v->shank, v->lever_tibia);
    add(&by_theta2, w->turn_per_moment, v->shank, v->lever_tibia);
    add(&by_theta2, w->bend_per_moment, v->shank, v->femur_bending);
    add(&by_theta2, tibia->bending_mm_per_n - tibia->axial_mm_per_n, v->tibia_axial, v->tibia_bending);
    count(variance, to_world, limb->uncertainty.angle_rad, by_theta2);
}

static void count_lengths(brace_stiffness_sigma_t *variance, brace_vec_t to_world, const brace_limb_t *limb,
                          const weights_t *w, const vectors_t *v)
{
    /* A longer femur has longer levers about its joint, and its coupling with the moment is weaker. The sign of the
     * whole is reversed here; only squares of it are used. */
    change_t by_femur = {0};
    add(&by_femur, w->hip, v->lever_thigh, v->lever_femur);
    add(&by_femur, w->bend_per_moment, v->femur_bending, v->lever_tibia);
    add(&by_femur, w->turn_per_moment, v->lever_tibia, v->lever_tibia);
    count(variance, to_world, limb->uncertainty.length_mm / limb->femur_mm, by_femur);

    /* A longer tibia has longer levers everywhere. */
    change_t by_tibia = {0};
    add(&by_tibia, w->hip, v->lever_tibia, v->lever_femur);
    add(&by_tibia, w->knee, v->lever_tibia, v->lever_tibia);
    add(&by_tibia, w->turn_per_moment, v->lever_tibia, v->lever_tibia);
    add(&by_tibia, w->bend_per_moment, v->lever_tibia, v->femur_bending);
    count(variance, to_world, limb->uncertainty.length_mm / limb->tibia_mm, by_tibia);
}

/* A compliance that acts along one vector. */
static void count_compliance(brace_stiffness_sigma_t *variance, brace_vec_t to_world, float sigma, float compliance,
                             brace_vec_t along)
{
    change_t change = {0};
    add(&change, 0.5f * compliance, along, along);
    count(variance, to_world, sigma, change);
}

static void count_compliances(brace_stiffness_sigma_t *variance, brace_vec_t to_world, const brace_limb_t *limb,
                              const weights_t *w, const vectors_t *v)
{
    const float sigma = limb->uncertainty.compliance_rel;
    const brace_link_t *femur = &limb->link[BRACE_FEMUR], *tibia = &limb->link[BRACE_TIBIA];
    const brace_base_t *base = &limb->base;
    /* The femur's moment transfer grows with its bending. */
    change_t by_bending = {0};
    add(&by_bending, 0.5f * femur->bending_mm_per_n, v->femur_bending, v->femur_bending);
    add(&by_bending, w->bend_per_moment, v->femur_bending, v->lever_tibia);
    add(&by_bending, 0.5f * w->turn_per_moment, v->lever_tibia, v->lever_tibia);
    count(variance, to_world, sigma, by_bending);

    count_compliance(variance, to_world, sigma, femur->axial_mm_per_n, v->femur_axial);
    count_compliance(variance, to_world, sigma, tibia->axial_mm_per_n, v->tibia_axial);
    count_compliance(variance, to_world, sigma, tibia->bending_mm_per_n, v->tibia_bending);
    count_compliance(variance, to_world, sigma, limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm, v->lever_femur);
    count_compliance(variance, to_world, sigma, limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm, v->lever_tibia);
    count_compliance(variance, to_world, sigma, base->x_mm_per_n, v->base_x);
    count_compliance(variance, to_world, sigma, base->z_mm_per_n, v->base_z);
    count_compliance(variance, to_world, sigma, base->rotation_rad_per_n_mm, v->lever_femur);
}

/* The gain of the force sensor scales all of K alike; it is the first cause that is counted. */
static brace_stiffness_sigma_t variance_by_gain(const brace_stiffness_t *stiffness, float gain_rel)
{
    return (brace_stiffness_sigma_t){
        .k_xx_n_per_mm = square(stiffness->k_xx_n_per_mm * gain_rel),
        .k_xz_n_per_mm = square(stiffness->k_xz_n_per_mm * gain_rel),
        .k_zz_n_per_mm = square(stiffness->k_zz_n_per_mm * gain_rel),
        .lambda_min_n_per_mm = square(stiffness->lambda_min_n_per_mm * gain_rel),
        .lambda_max_n_per_mm = square(stiffness->lambda_max_n_per_mm * gain_rel),
    };
}

static void take_roots(const brace_stiffness_sigma_t *variance, const brace_stiffness_t *stiffness,
                       float apart_n_per_mm, brace_stiffness_sigma_t *sigma)
{
    const float axis_rad = sqrtf(variance->stiff_axis_rad) / apart_n_per_mm;
    const bool is_known = axis_rad < BRACE_UNKNOWN_AXIS_RAD; /* a round K divides by zero: the axis is not known */
    *sigma = (brace_stiffness_sigma_t){
        .k_xx_n_per_mm = sqrtf(variance->k_xx_n_per_mm),
        .k_xz_n_per_mm = sqrtf(variance->k_xz_n_per_mm),
        .k_zz_n_per_mm = sqrtf(variance->k_zz_n_per_mm),
        .lambda_min_n_per_mm = sqrtf(variance->lambda_min_n_per_mm),
        .lambda_max_n_per_mm = sqrtf(variance->lambda_max_n_per_mm),
        .stiff_axis_rad = is_known ? axis_rad : BRACE_UNKNOWN_AXIS_RAD,
        .flags = stiffness->flags | (is_known ? 0u : (uint32_t)BRACE_FLAG_SATURATED),
    };
}

brace_status_t brace_uncertainty_known(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                       const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma)
{
    const brace_status_t status = brace_first_refusal(brace_check_two(theta1_rad, theta2_rad, BRACE_ANGLE_LIMIT_RAD),
                                                      brace_check_stiffness(stiffness));
    if (status != BRACE_OK) {
        return status;
    }
    const frame_t frame = {brace_direction(stiffness->stiff_axis_rad), stiffness->lambda_max_n_per_mm,
                           stiffness->lambda_min_n_per_mm};
    const vectors_t vectors = vectors_at(limb, theta1_rad, theta2_rad, &frame);
    const brace_link_t *femur = &limb->link[BRACE_FEMUR];
    const float bend_per_moment = 1.5f * femur->moment_transfer * femur->bending_mm_per_n / limb->femur_mm;
    const weights_t weights = {
        .hip = limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm + limb->base.rotation_rad_per_n_mm,
        .knee = limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm,
        .bend_per_moment = bend_per_moment,
        .turn_per_moment = 2.0f * bend_per_moment / limb->femur_mm,
    };
    const float apart_n_per_mm = stiffness->lambda_max_n_per_mm - stiffness->lambda_min_n_per_mm;
    const brace_vec_t to_world = vec_doubled(frame.stiff_axis);
    brace_stiffness_sigma_t variance = variance_by_gain(stiffness, limb->uncertainty.gain_rel);
    count_angles(&variance, to_world, limb, &weights, &vectors, apart_n_per_mm);
    count_lengths(&variance, to_world, limb, &weights, &vectors);
    count_compliances(&variance, to_world, limb, &weights, &vectors);
    take_roots(&variance, stiffness, apart_n_per_mm, sigma);
    return BRACE_OK;
}

brace_status_t brace_uncertainty_stiffness(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                           const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma)
{
    if (stiffness == NULL || sigma == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_limb_check(limb);
    return status == BRACE_OK ? brace_uncertainty_known(limb, theta1_rad, theta2_rad, stiffness, sigma) : status;
}
