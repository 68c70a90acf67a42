/* K of the limb in force: the collapsed path where it serves, else the general path with its joints' springs of
 * the moment. */
#ifndef BRACE_APP_MODEL_H
#define BRACE_APP_MODEL_H

#include "brace/app.h"

/* Prepares the model in two pieces, each for a tick of its own: at most 3,000 and 1,700 instructions. */
void model_configure_collapse(brace_app_model_t *model, const brace_parameters_t *parameters);
void model_configure_general(brace_app_model_t *model, const brace_parameters_t *parameters);

/* Both joints' compliances at this load and temperature, the hip's with the base's rotation: a spring's share of K is
 * the slope of its torque there.
 *   load_n_mm, temp_degc: of femur and tibia joint; NaN: at no load, at the reference temperature
 * At most 120 instructions; none worth counting of a limb that collapses. */
void model_springs(brace_app_model_t *model, const float load_n_mm[BRACE_APP_JOINTS],
                   const float temp_degc[BRACE_APP_JOINTS], float spring_rad_per_n_mm[BRACE_APP_JOINTS]);

/* The same at no load. At most 50 instructions. */
void model_springs_at_rest(const brace_app_model_t *model, const float temp_degc[BRACE_APP_JOINTS],
                           float spring_rad_per_n_mm[BRACE_APP_JOINTS]);

/* K with every gap closed, by the collapsed path where it serves, else with these springs.
 * returns as brace_planar_stiffness or brace_general_stiffness. At most 440 instructions. */
brace_status_t model_stiffness(const brace_app_model_t *model, float theta1_rad, float theta2_rad,
                               const float spring_rad_per_n_mm[BRACE_APP_JOINTS], brace_stiffness_t *stiffness);

#endif
