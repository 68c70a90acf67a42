#include "measure/model.h"

#define LEAST_FACTOR 1e-3f           /* no temperature makes a spring push the wrong way */
#define NEWTON_STEPS 2
#define DEFLECTION_MOST_RAD 8.0f     /* no spring is wound further than a joint turns */

void model_configure_collapse(brace_app_model_t *model, const brace_parameters_t *parameters)
{
    const bool springs_change = parameters->slow.joint_compliance_per_degc != 0.0f ||
                                parameters->drive[BRACE_FEMUR].hardening_n_mm_per_rad3 != 0.0f ||
                                parameters->drive[BRACE_TIBIA].hardening_n_mm_per_rad3 != 0.0f;
    model->collapsed = !springs_change && brace_planar_collapse(&parameters->limb, &model->planar) == BRACE_OK;
}

void model_configure_general(brace_app_model_t *model, const brace_parameters_t *parameters)
{
    const brace_limb_t *limb = &parameters->limb;
    brace_general_collapse(limb, &model->general);
    model->spring_rad_per_n_mm[0] = limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    model->spring_rad_per_n_mm[1] = limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm;
    model->rotation_rad_per_n_mm = limb->base.rotation_rad_per_n_mm;
    model->warm_per_degc = parameters->slow.joint_compliance_per_degc;
    model->reference_degc = parameters->slow.reference_degc;
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        model->hardening_n_mm_per_rad3[i] = parameters->drive[BRACE_FEMUR + i].hardening_n_mm_per_rad3;
        model->deflection_rad[i] = 0.0f;
    }
}

/* A joint's compliance at no load. */
static inline float at_rest(const brace_app_model_t *model, int index, float temp_degc)
{
    const float warmer_degc = temp_degc - model->reference_degc;
    const bool measured = __builtin_fabsf(warmer_degc) <= 200.0f;
    const float factor = measured ? 1.0f + model->warm_per_degc * warmer_degc : 1.0f;
    return model->spring_rad_per_n_mm[index] * (factor > LEAST_FACTOR ? factor : LEAST_FACTOR);
}

/* 1 / (d torque / d deflection) of torque = deflection / compliance + hardening deflection^3 at a load.
 * compliance: at no load. The deflection is followed from tick to tick, two of Newton's steps from the last one: a load
 * changes little in a tick, and after a jump it is right within a few. */
static float yielding(brace_app_model_t *model, int index, float load_n_mm, float compliance)
{
    const float hardening = model->hardening_n_mm_per_rad3[index];
    if (!(hardening > 0.0f && compliance > 0.0f) || !(__builtin_fabsf(load_n_mm) <= 1e9f)) {
        return compliance;
    }
    const float stiffness = 1.0f / compliance;
    float deflection = model->deflection_rad[index];
    float slope = stiffness;
    for (int i = 0; i < NEWTON_STEPS; i++) {
        const float cubic = hardening * deflection * deflection;
        slope = stiffness + 3.0f * cubic;
        deflection = (load_n_mm + 2.0f * cubic * deflection) / slope;
    }
    /* from there the steps stay finite, whatever the spring */
    if (!(__builtin_fabsf(deflection) <= DEFLECTION_MOST_RAD)) {
        deflection = load_n_mm < 0.0f ? -DEFLECTION_MOST_RAD : DEFLECTION_MOST_RAD;
    }
    model->deflection_rad[index] = deflection;
    return 1.0f / (stiffness + 3.0f * hardening * deflection * deflection);
}

void model_springs_at_rest(const brace_app_model_t *model, const float temp_degc[BRACE_APP_JOINTS],
                           float spring_rad_per_n_mm[BRACE_APP_JOINTS])
{
    if (!model->collapsed) {
        spring_rad_per_n_mm[0] = at_rest(model, 0, temp_degc[0]) + model->rotation_rad_per_n_mm;
        spring_rad_per_n_mm[1] = at_rest(model, 1, temp_degc[1]);
    }
}

void model_springs(brace_app_model_t *model, const float load_n_mm[BRACE_APP_JOINTS],
                   const float temp_degc[BRACE_APP_JOINTS], float spring_rad_per_n_mm[BRACE_APP_JOINTS])
{
    if (!model->collapsed) {
        const float hip = yielding(model, 0, load_n_mm[0], at_rest(model, 0, temp_degc[0]));
        spring_rad_per_n_mm[0] = hip + model->rotation_rad_per_n_mm;
        spring_rad_per_n_mm[1] = yielding(model, 1, load_n_mm[1], at_rest(model, 1, temp_degc[1]));
    }
}

brace_status_t model_stiffness(const brace_app_model_t *model, float theta1_rad, float theta2_rad,
                               const float spring_rad_per_n_mm[BRACE_APP_JOINTS], brace_stiffness_t *stiffness)
{
    return model->collapsed ? brace_planar_stiffness(&model->planar, theta1_rad, theta2_rad, stiffness)
                            : brace_general_stiffness(&model->general, theta1_rad, theta2_rad, spring_rad_per_n_mm[0],
                                                      spring_rad_per_n_mm[1], stiffness);
}
