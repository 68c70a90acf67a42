/* All causes of brace/uncertainty_causes.h at once. */
#include <stddef.h>

#include "base/check.h"
#include "brace/uncertainty_causes.h"

/* K of these inputs, in the plane or in space. `of` has what no cause changes: weights, and the direction of down. */
typedef struct {
    const brace_gravity_t *weights;
    brace_vec3_t down;
    bool is_spatial;
} where_t;

static brace_status_t k_in_plane(const where_t *where, const brace_k_inputs_t *inputs, brace_stiffness_t *plane)
{
    const brace_load_t load = {.tip = {inputs->tip_n.x, inputs->tip_n.z},
                               .down = {where->down.x, where->down.z},
                               .hip = inputs->spring[BRACE_FEMUR],
                               .knee = inputs->spring[BRACE_TIBIA]};
    brace_loaded_t loaded;
    brace_loaded_stiffness_t found;
    brace_loaded_collapse(&inputs->limb, where->weights, &loaded);
    const brace_status_t status =
        brace_loaded_stiffness(&loaded, inputs->angle_rad[BRACE_FEMUR], inputs->angle_rad[BRACE_TIBIA], &load, &found);
    if (status == BRACE_OK) {
        *plane = found.stiffness;
    }
    return status;
}

static brace_status_t k_in_space(const where_t *where, const brace_k_inputs_t *inputs, brace_stiffness_t *plane,
                                 brace_k3_t *space)
{
    const brace_space_load_t load = {.tip_n = inputs->tip_n,
                                     .down = where->down,
                                     .yaw = inputs->spring[BRACE_COXA],
                                     .hip = inputs->spring[BRACE_FEMUR],
                                     .knee = inputs->spring[BRACE_TIBIA]};
    brace_loaded_space_t loaded;
    brace_space_rest_t rest;
    brace_space_result_t found;
    brace_loaded_space_collapse(&inputs->limb, where->weights, &loaded);
    brace_status_t status = brace_loaded_space_settle(&loaded, inputs->angle_rad[BRACE_FEMUR],
                                                      inputs->angle_rad[BRACE_TIBIA], &load, &rest);
    status = status == BRACE_OK ? brace_loaded_space_stiffness(&loaded, &rest, &found) : status;
    status = status == BRACE_OK ? brace_loaded_space_in_plane(&found.k, plane) : status;
    if (status == BRACE_OK) {
        *space = found.k;
    }
    return status;
}

static brace_status_t k_of(const where_t *where, const brace_k_inputs_t *inputs, brace_stiffness_t *plane,
                           brace_k3_t *space)
{
    return where->is_spatial ? k_in_space(where, inputs, plane, space) : k_in_plane(where, inputs, plane);
}

static brace_status_t count_all(const where_t *where, const brace_k_inputs_t *inputs, brace_k_sigma_t *sigma)
{
    brace_k_base_t base;
    brace_k_sigma_t variance;
    brace_stiffness_t plane;
    brace_k3_t space;
    brace_status_t status = k_of(where, inputs, &plane, &space);
    if (status != BRACE_OK) {
        return status;
    }
    brace_k_base_find(&plane, &space, inputs->angle_rad[BRACE_COXA], where->is_spatial, &base);
    brace_sigma_begin(&base, inputs->angle_sigma_rad[BRACE_COXA], &variance);
    for (uint32_t cause = 0; cause < BRACE_CAUSE_COUNT; cause++) {
        brace_k_inputs_t changed = *inputs;
        if (!brace_cause_change(cause, where->is_spatial, &changed)) {
            continue;
        }
        status = k_of(where, &changed, &plane, &space);
        if (status != BRACE_OK) {
            return BRACE_E_SINGULAR;
        }
        brace_sigma_add(&base, &plane, &space, BRACE_CAUSE_SIGMAS, &variance);
    }
    brace_sigma_end(&variance, sigma);
    return BRACE_OK;
}

static void all_angles(float sigma_rad, brace_k_inputs_t *inputs)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        inputs->angle_sigma_rad[i] = sigma_rad;
    }
}

brace_status_t brace_uncertainty_loaded(const brace_limb_t *limb, const brace_gravity_t *weights, float theta1_rad,
                                        float theta2_rad, const brace_load_t *load, brace_stiffness_sigma_t *sigma)
{
    if (weights == NULL || load == NULL || sigma == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_limb_check(limb);
    if (status != BRACE_OK) {
        return status;
    }
    brace_k_sigma_t all;
    brace_k_inputs_t inputs = {.limb = *limb,
                               .angle_rad = {0.0f, theta1_rad, theta2_rad},
                               .spring = {{0.0f, 0.0f}, load->hip, load->knee},
                               .tip_n = {load->tip.x_n, 0.0f, load->tip.z_n}};
    const where_t where = {.weights = weights, .down = {load->down.x, 0.0f, load->down.z}, .is_spatial = false};
    all_angles(limb->uncertainty.angle_rad, &inputs);
    status = count_all(&where, &inputs, &all);
    if (status == BRACE_OK) {
        *sigma = all.plane;
    }
    return status;
}

brace_status_t brace_uncertainty_loaded_space(const brace_limb_t *limb, const brace_gravity_t *weights,
                                              const float theta_rad[BRACE_LINK_COUNT], const brace_space_load_t *load,
                                              brace_k_sigma_t *sigma)
{
    if (weights == NULL || theta_rad == NULL || load == NULL || sigma == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_first_refusal(
        brace_limb_check(limb), brace_check_two(theta_rad[BRACE_COXA], theta_rad[BRACE_FEMUR], BRACE_ANGLE_LIMIT_RAD));
    if (status != BRACE_OK) {
        return status;
    }
    brace_k_inputs_t inputs = {.limb = *limb,
                               .angle_rad = {theta_rad[BRACE_COXA], theta_rad[BRACE_FEMUR], theta_rad[BRACE_TIBIA]},
                               .spring = {load->yaw, load->hip, load->knee},
                               .tip_n = load->tip_n};
    const where_t where = {.weights = weights, .down = load->down, .is_spatial = true};
    all_angles(limb->uncertainty.angle_rad, &inputs);
    return count_all(&where, &inputs, sigma);
}
