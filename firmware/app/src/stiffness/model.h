/* K of the limb in force, with its joints' springs of the moment: without load, and at the equilibrium under it.
 *
 * Three paths of the core lead to K without load in the limb's plane. A limb in space takes the spatial path, because
 * its coxa link yields in the plane too. A planar limb whose springs never change is collapsed into a few constants,
 * the cheapest path. Every other planar limb (hardening, temperature, a base that yields unequally) takes the general
 * path. K under a load is for limbs in their plane: brace/loaded.h, on a controller without an FPU
 * brace/loaded_fixed.h. docs/kernel.md says more. */
#ifndef BRACE_STIFFNESS_MODEL_H
#define BRACE_STIFFNESS_MODEL_H

#include <stdbool.h>

#include "brace/general.h"
#include "brace/loaded.h"
#include "brace/loaded_fixed.h"
#include "brace/parameters.h"
#include "brace/planar.h"
#include "brace/spatial.h"
#include "brace/stiffness.h"

/* What K under a load takes of a limb: floats, or integers where floats are computed in software. */
#ifdef __SOFTFP__
typedef brace_loaded_fixed_t model_loaded_limb_t;
#else
typedef brace_loaded_t model_loaded_limb_t;
#endif

typedef struct {
    bool is_spatial;            /* the coxa joint is fitted */
    bool springs_change;        /* with temperature or load */
    bool is_collapsed;          /* planar holds the limb */
    brace_planar_t planar;
    brace_general_t general;
    brace_spatial_t spatial;
    model_loaded_limb_t loaded; /* of a limb in its plane */
    float deflection_rad[BRACE_LINK_COUNT]; /* of hardening springs, followed from tick to tick */
} model_t;

/* Prepares the model when parameters are put in force.
 *   is_spatial: the limb has a coxa joint
 * At most 4,000 instructions. */
void model_configure(model_t *model, const brace_parameters_t *parameters, bool is_spatial);

/* How every joint yields at a load and a temperature.
 *   load_n_mm: NaN: at no load; temp_degc: NaN: at the reference temperature
 * At most 190 instructions; hardly any for a limb whose springs do not change. */
void model_springs(model_t *model, const brace_parameters_t *parameters, const float load_n_mm[BRACE_LINK_COUNT],
                   const float temp_degc[BRACE_LINK_COUNT], brace_loaded_joint_t springs[BRACE_LINK_COUNT]);

/* The same at no load. */
void model_springs_at_rest(const brace_parameters_t *parameters, const float temp_degc[BRACE_LINK_COUNT],
                           brace_loaded_joint_t springs[BRACE_LINK_COUNT]);

/* K in the limb's plane with every gap closed and neither force nor weight counted.
 *   across_n_per_mm (out): K across the plane of a limb in space; NaN: planar limb, or nothing yields across
 * returns BRACE_OK and what brace_planar_stiffness, brace_general_stiffness or brace_spatial_in_plane return; outputs
 *   untouched then. At most 450 instructions. */
brace_status_t model_stiffness(model_t *model, const brace_parameters_t *parameters, float theta1_rad, float theta2_rad,
                               const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_stiffness_t *stiffness,
                               float *across_n_per_mm);

/* Can this limb's K be told under a load? One in space cannot yet: its estimator would stand beside `loaded`, and be
 * called by model_loaded. */
static inline bool model_counts_loads(const model_t *model)
{
    return !model->is_spatial;
}

/* K at the equilibrium under a load, every gap closed, of a limb that model_counts_loads.
 *   unbent: angles without what the load turns
 *   tip: force of the ground; down: where the weight pulls, in the limb's plane
 *   result (out): flags as brace_loaded_stiffness, and NEAR_SINGULAR also where the load is beyond what the estimator's
 *     accuracy is promised for (a buckling factor below 2, a tip that moves by more than a fifth of the reach), and
 *     SOFTENED (a factor below 3)
 *   joint_turn_rad (out): how far the load has turned the joints themselves, by BRACE_FEMUR and BRACE_TIBIA, in the
 *     sense of their angles
 * returns as brace_loaded_stiffness. At most 2,600 instructions. */
brace_status_t model_loaded(const model_t *model, const brace_limb_t *limb, const float unbent_rad[BRACE_LINK_COUNT],
                            const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_force_t tip, brace_vec_t down,
                            brace_loaded_stiffness_t *result, float joint_turn_rad[BRACE_LINK_COUNT]);

#endif
