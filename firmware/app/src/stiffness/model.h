/* K of the limb in force, with its joints' springs of the moment.
 *
 * Three paths of the core lead to K in the limb's plane. A limb in space takes the spatial path, because its coxa link
 * yields in the plane too. A planar limb whose springs never change is collapsed into a few constants, the cheapest
 * path. Every other planar limb (hardening, temperature, a base that yields unequally) takes the general path.
 * docs/kernel.md says more. */
#ifndef BRACE_STIFFNESS_MODEL_H
#define BRACE_STIFFNESS_MODEL_H

#include <stdbool.h>

#include "brace/general.h"
#include "brace/parameters.h"
#include "brace/planar.h"
#include "brace/spatial.h"
#include "brace/stiffness.h"

typedef struct {
    bool is_spatial;            /* the coxa joint is fitted */
    bool springs_change;        /* with temperature or load */
    bool is_collapsed;          /* planar holds the limb */
    brace_planar_t planar;
    brace_general_t general;
    brace_spatial_t spatial;
    float deflection_rad[BRACE_LINK_COUNT]; /* of hardening springs, followed from tick to tick */
} model_t;

/* Prepares the model when parameters are put in force.
 *   is_spatial: the limb has a coxa joint
 * At most 3,500 instructions. */
void model_configure(model_t *model, const brace_parameters_t *parameters, bool is_spatial);

/* Every joint's compliance [rad/(N mm)] at a load and a temperature: the slope of its spring's torque there.
 *   load_n_mm: NaN: at no load; temp_degc: NaN: at the reference temperature
 * At most 180 instructions; hardly any for a limb whose springs do not change. */
void model_springs(model_t *model, const brace_parameters_t *parameters, const float load_n_mm[BRACE_LINK_COUNT],
                   const float temp_degc[BRACE_LINK_COUNT], float springs_rad_per_n_mm[BRACE_LINK_COUNT]);

/* The same at no load. */
void model_springs_at_rest(const brace_parameters_t *parameters, const float temp_degc[BRACE_LINK_COUNT],
                           float springs_rad_per_n_mm[BRACE_LINK_COUNT]);

/* K in the limb's plane with every gap closed.
 *   across_n_per_mm (out): K across the plane of a limb in space; NaN: planar limb, or nothing yields across
 * returns BRACE_OK and what brace_planar_stiffness, brace_general_stiffness or brace_spatial_in_plane return; outputs
 *   untouched then. At most 450 instructions. */
brace_status_t model_stiffness(model_t *model, const brace_parameters_t *parameters, float theta1_rad, float theta2_rad,
                               const float springs_rad_per_n_mm[BRACE_LINK_COUNT], brace_stiffness_t *stiffness,
                               float *across_n_per_mm);

#endif
