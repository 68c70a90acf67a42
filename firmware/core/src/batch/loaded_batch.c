#include "brace/loaded_batch.h"

#define NOT_A_NUMBER __builtin_nanf("")

static void refuse(brace_status_t status, brace_loaded_stiffness_t *result)
{
    const uint32_t flags = status == BRACE_E_SINGULAR ? BRACE_FLAG_NEAR_SINGULAR | BRACE_FLAG_SOFTENED : 0u;
    *result = (brace_loaded_stiffness_t){
        .stiffness = {NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, flags},
        .displacement = {NOT_A_NUMBER, NOT_A_NUMBER},
        .tibia_mm = {NOT_A_NUMBER, NOT_A_NUMBER},
        .hip_turn_rad = NOT_A_NUMBER,
        .knee_turn_rad = NOT_A_NUMBER,
        .buckling_factor = NOT_A_NUMBER};
}

/* One row. returns whether it was refused, 1 or 0 */
static size_t finish(brace_status_t status, float reach_mm, brace_loaded_stiffness_t *result)
{
    const brace_displacement_t moved = result->displacement;
    if (status != BRACE_OK) {
        refuse(status, result);
        return 1;
    }
    result->stiffness.flags |=
        brace_loaded_flags(result->buckling_factor, moved.x_mm * moved.x_mm + moved.z_mm * moved.z_mm, reach_mm);
    return 0;
}

static brace_load_t with_force(const brace_load_t *joints, float x_n, float z_n)
{
    brace_load_t load = *joints;
    load.tip = (brace_force_t){x_n, z_n};
    return load;
}

size_t brace_loaded_batch(const brace_loaded_t *loaded, const brace_load_t *joints, size_t n, const float *theta1_rad,
                          const float *theta2_rad, const float *x_n, const float *z_n,
                          brace_loaded_stiffness_t *results)
{
    const float reach_mm = loaded->femur.length_mm + loaded->tibia.length_mm;
    size_t refused = 0;
    for (size_t i = 0; i < n; i++) { /* at most the host's columns */
        const brace_load_t load = with_force(joints, x_n[i], z_n[i]);
        refuse(BRACE_OK, &results[i]);
        refused += finish(brace_loaded_stiffness(loaded, theta1_rad[i], theta2_rad[i], &load, &results[i]), reach_mm,
                          &results[i]);
    }
    return refused;
}

size_t brace_loaded_fixed_batch(const brace_loaded_fixed_t *fixed, float reach_mm, const brace_load_t *joints, size_t n,
                                const float *theta1_rad, const float *theta2_rad, const float *x_n, const float *z_n,
                                brace_loaded_stiffness_t *results)
{
    size_t refused = 0;
    for (size_t i = 0; i < n; i++) { /* at most the host's columns */
        const brace_load_t load = with_force(joints, x_n[i], z_n[i]);
        refuse(BRACE_OK, &results[i]);
        refused += finish(brace_loaded_fixed_stiffness(fixed, theta1_rad[i], theta2_rad[i], &load, &results[i]),
                          reach_mm, &results[i]);
    }
    return refused;
}

uint32_t brace_loaded_space_flags(const brace_space_result_t *result, float buckling_factor, float reach_mm)
{
    const brace_vec3_t moved = result->displacement_mm;
    return result->flags |
           brace_loaded_flags(buckling_factor, moved.x * moved.x + moved.y * moved.y + moved.z * moved.z, reach_mm);
}
