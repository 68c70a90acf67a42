#include "stiffness/model.h"

#define LEAST_FACTOR 1e-3f        /* no temperature makes a spring push the wrong way */
#define WARMER_MOST_DEGC 200.0f
#define NEWTON_STEPS 2
#define DEFLECTION_MOST_RAD 8.0f  /* no spring is wound further than a joint turns */
#define LOAD_MOST_N_MM 1e9f

void model_configure(model_t *model, const brace_parameters_t *parameters, bool is_spatial)
{
    const brace_limb_t *limb = &parameters->limb;
    *model = (model_t){.is_spatial = is_spatial};
    model->springs_change = parameters->slow.joint_compliance_per_degc != 0.0f;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        model->springs_change = model->springs_change || parameters->drive[i].hardening_n_mm_per_rad3 != 0.0f;
    }
    if (is_spatial) {
        (void)brace_spatial_collapse(limb, &model->spatial);
    } else {
        model->is_collapsed = !model->springs_change && brace_planar_collapse(limb, &model->planar) == BRACE_OK;
        brace_general_collapse(limb, &model->general);
    }
}

static float spring_at_rest(const brace_parameters_t *parameters, int index, float temp_degc)
{
    const float warmer_degc = temp_degc - parameters->slow.reference_degc;
    const bool measured = __builtin_fabsf(warmer_degc) <= WARMER_MOST_DEGC;
    const float factor = measured ? 1.0f + parameters->slow.joint_compliance_per_degc * warmer_degc : 1.0f;
    return parameters->limb.joint[index].compliance_rad_per_n_mm * (factor > LEAST_FACTOR ? factor : LEAST_FACTOR);
}

/* 1 / (d torque / d deflection) of torque = deflection / compliance + hardening * deflection^3 at a load. A load
 * changes little in a tick, so the deflection is followed with two of Newton's steps from the last one. After a jump
 * of the load the deflection is right within a few ticks. */
static float hardened_spring(float *deflection_rad, float hardening_n_mm_per_rad3, float load_n_mm,
                             float compliance_rad_per_n_mm)
{
    const bool hardens = hardening_n_mm_per_rad3 > 0.0f && compliance_rad_per_n_mm > 0.0f;
    if (!hardens || !(__builtin_fabsf(load_n_mm) <= LOAD_MOST_N_MM)) {
        return compliance_rad_per_n_mm;
    }
    const float linear_n_mm_per_rad = 1.0f / compliance_rad_per_n_mm;
    float deflection = *deflection_rad;
    for (int i = 0; i < NEWTON_STEPS; i++) {
        const float cubic_n_mm_per_rad = hardening_n_mm_per_rad3 * deflection * deflection;
        deflection = (load_n_mm + 2.0f * cubic_n_mm_per_rad * deflection) /
                     (linear_n_mm_per_rad + 3.0f * cubic_n_mm_per_rad);
    }
    /* From within this bound Newton's steps stay finite, whatever the spring. */
    if (!(__builtin_fabsf(deflection) <= DEFLECTION_MOST_RAD)) {
        deflection = load_n_mm < 0.0f ? -DEFLECTION_MOST_RAD : DEFLECTION_MOST_RAD;
    }
    *deflection_rad = deflection;
    return 1.0f / (linear_n_mm_per_rad + 3.0f * hardening_n_mm_per_rad3 * deflection * deflection);
}

void model_springs_at_rest(const brace_parameters_t *parameters, const float temp_degc[BRACE_LINK_COUNT],
                           float springs_rad_per_n_mm[BRACE_LINK_COUNT])
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        springs_rad_per_n_mm[i] = spring_at_rest(parameters, i, temp_degc[i]);
    }
}

void model_springs(model_t *model, const brace_parameters_t *parameters, const float load_n_mm[BRACE_LINK_COUNT],
                   const float temp_degc[BRACE_LINK_COUNT], float springs_rad_per_n_mm[BRACE_LINK_COUNT])
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        springs_rad_per_n_mm[i] = parameters->limb.joint[i].compliance_rad_per_n_mm;
        if (model->springs_change) {
            springs_rad_per_n_mm[i] =
                hardened_spring(&model->deflection_rad[i], parameters->drive[i].hardening_n_mm_per_rad3, load_n_mm[i],
                                spring_at_rest(parameters, i, temp_degc[i]));
        }
    }
}

brace_status_t model_stiffness(model_t *model, const brace_parameters_t *parameters, float theta1_rad, float theta2_rad,
                               const float springs_rad_per_n_mm[BRACE_LINK_COUNT], brace_stiffness_t *stiffness,
                               float *across_n_per_mm)
{
    const float hip_rad_per_n_mm =
        springs_rad_per_n_mm[BRACE_FEMUR] + parameters->limb.base.rotation_rad_per_n_mm;
    if (model->is_spatial) {
        brace_spatial_set_springs(&model->spatial, springs_rad_per_n_mm[BRACE_COXA], hip_rad_per_n_mm,
                                  springs_rad_per_n_mm[BRACE_TIBIA]);
        return brace_spatial_in_plane(&model->spatial, theta1_rad, theta2_rad, stiffness, across_n_per_mm);
    }
    const brace_status_t status =
        model->is_collapsed ? brace_planar_stiffness(&model->planar, theta1_rad, theta2_rad, stiffness)
                            : brace_general_stiffness(&model->general, theta1_rad, theta2_rad, hip_rad_per_n_mm,
                                                      springs_rad_per_n_mm[BRACE_TIBIA], stiffness);
    if (status == BRACE_OK) {
        *across_n_per_mm = __builtin_nanf("");
    }
    return status;
}
