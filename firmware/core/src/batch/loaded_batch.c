#include "brace/loaded_batch.h"

#define NOT_A_NUMBER __builtin_nanf("")

static uint32_t flags_of(const brace_loaded_stiffness_t *result, float reach_mm)
{
    const brace_displacement_t moved = result->displacement;
    return brace_loaded_flags(result->buckling_factor, moved.x_mm * moved.x_mm + moved.z_mm * moved.z_mm, reach_mm);
}

size_t brace_loaded_batch(const brace_loaded_t *loaded, const brace_load_t *joints, size_t n, const float *theta1_rad,
                          const float *theta2_rad, const float *x_n, const float *z_n,
                          brace_loaded_stiffness_t *results)
{
    const brace_loaded_stiffness_t none = {
        .stiffness = {NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, 0u},
        .displacement = {NOT_A_NUMBER, NOT_A_NUMBER},
        .tibia_mm = {NOT_A_NUMBER, NOT_A_NUMBER},
        .hip_turn_rad = NOT_A_NUMBER,
        .knee_turn_rad = NOT_A_NUMBER,
        .buckling_factor = NOT_A_NUMBER};
    const float reach_mm = loaded->femur.length_mm + loaded->tibia.length_mm;
    size_t refused = 0;
    for (size_t i = 0; i < n; i++) { /* at most the host's columns */
        brace_load_t load = *joints;
        load.tip = (brace_force_t){x_n[i], z_n[i]};
        results[i] = none;
        if (brace_loaded_stiffness(loaded, theta1_rad[i], theta2_rad[i], &load, &results[i]) != BRACE_OK) {
            refused++;
        } else {
            results[i].stiffness.flags |= flags_of(&results[i], reach_mm);
        }
    }
    return refused;
}
