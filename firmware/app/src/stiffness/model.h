/* K of the limb in force, with its joints' springs of the moment: without load, and at the equilibrium under it.
 *
 * Three paths of the core lead to K without load in the limb's plane. A limb in space takes the spatial path, because
 * its coxa link yields in the plane too. A planar limb whose springs never change is collapsed into a few constants,
 * the cheapest path. Every other planar limb (hardening, temperature, a base that yields unequally) takes the general
 * path. K under a load is brace/loaded.h for a limb in its plane, on a controller without an FPU brace/loaded_fixed.h,
 * and brace/loaded_space.h for a limb in space. docs/kernel.md says more. */
#ifndef BRACE_STIFFNESS_MODEL_H
#define BRACE_STIFFNESS_MODEL_H

#include <stdbool.h>

#include "brace/general.h"
#include "brace/loaded.h"
#include "brace/loaded_fixed.h"
#include "brace/loaded_space.h"
#include "brace/parameters.h"
#include "brace/planar.h"
#include "brace/spatial.h"
#include "brace/stiffness.h"
#include "posture/posture.h"

/* What K under a load takes of a limb in its plane: floats, or integers where floats are computed in software. */
#ifdef __SOFTFP__
typedef brace_loaded_fixed_t model_loaded_limb_t;
typedef brace_loaded_stiffness_t model_plane_work_t; /* the first of two steps does it all */
typedef brace_loaded_fixed_place_t model_plane_place_t;
#else
typedef brace_loaded_t model_loaded_limb_t;
typedef brace_loaded_rest_t model_plane_work_t;
typedef brace_loaded_place_t model_plane_place_t;
#endif

typedef struct {
    bool is_spatial;            /* the coxa joint is fitted */
    bool springs_change;        /* with temperature or load */
    bool is_collapsed;          /* planar holds the limb */
    brace_planar_t planar;
    brace_general_t general;
    brace_spatial_t spatial;
    model_loaded_limb_t loaded; /* of a limb in its plane */
    brace_loaded_space_t loaded_space;
    float deflection_rad[BRACE_LINK_COUNT]; /* of hardening springs, followed from tick to tick */
} model_t;

/* What is prepared of a model, in this order. Each part has its own tick, because they cost the tick most where floats
 * are computed in software. */
typedef enum { MODEL_LOADED, MODEL_PLANAR, MODEL_GENERAL, MODEL_PARTS } model_part_t;

/* Prepares one part of the model when parameters are put in force. The model gives no K before its last part is there.
 *   is_spatial: the limb has a coxa joint
 * At most 2,000 instructions. */
void model_configure(model_t *model, const brace_parameters_t *parameters, bool is_spatial, model_part_t part);

/* The same for K under a load alone. At most 800 instructions. */
void model_configure_loaded(model_t *model, const brace_limb_t *limb, const brace_gravity_t *weights, bool is_spatial);

/* How every joint yields at a load and a temperature.
 *   load_n_mm: NaN: at no load; temp_degc: NaN: at the reference temperature
 * At most 190 instructions; hardly any for a limb whose springs do not change. */
void model_springs(model_t *model, const brace_parameters_t *parameters, const float load_n_mm[BRACE_LINK_COUNT],
                   const float temp_degc[BRACE_LINK_COUNT], brace_loaded_joint_t springs[BRACE_LINK_COUNT]);

/* The same of one joint.
 *   deflection_rad (in, out): the spring's, from which it is followed to this load */
brace_loaded_joint_t model_spring(const model_t *model, const brace_parameters_t *parameters, int index,
                                  float load_n_mm, float temp_degc, float *deflection_rad);

/* The same at no load. */
void model_springs_at_rest(const brace_parameters_t *parameters, const float temp_degc[BRACE_LINK_COUNT],
                           brace_loaded_joint_t springs[BRACE_LINK_COUNT]);

/* K in the limb's plane with every gap closed and neither force nor weight counted.
 *   across_n_per_mm (out): K across the plane of a limb in space; NaN: planar limb, or nothing yields across
 * returns BRACE_OK and what brace_planar_stiffness, brace_general_stiffness or brace_spatial_in_plane return; outputs
 *   untouched then. At most 450 instructions. */
brace_status_t model_stiffness(model_t *model, const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                               const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_stiffness_t *stiffness,
                               float *across_n_per_mm);

/* Where a limb rests under a load, and K there. */
typedef struct {
    brace_stiffness_t plane;  /* K in the limb's plane; of a limb in space the tip is held across it. Flags: the
                                 estimator's, NEAR_SINGULAR also where the load is beyond what its accuracy is promised
                                 for (a buckling factor below 2, a tip that moves by more than a fifth of the reach),
                                 and SOFTENED (a factor below 3) */
    brace_k3_t space;         /* of a limb in space, in its plane's frame */
    posture_bend_t bend;
    float moved_across_mm;    /* the tip, across the plane; NaN: limb in its plane */
    float buckling_factor;    /* NaN: of a limb in space (stiffness/softening.h) */
} model_rest_t;

/* Where a limb rests. All zero before the first tick. */
typedef struct {
    union {
        brace_space_rest_t space;
        model_plane_place_t plane;
    } at;
    uint8_t ticks_without; /* so many after one another have not come near a rest */
    bool is_there;         /* the next tick may go on from `at` */
    uint8_t unyielding; /* in the plane: joints that did not yield, in bits. Where others do not in the next tick, the
                              limb rests elsewhere, and that tick begins anew */
    brace_loaded_joint_t springs[BRACE_LINK_COUNT]; /* of a limb in space, there */
} model_place_t;

/* K at the equilibrium under a load, every gap closed.
 *   unbent_rad: angles without what the load turns
 *   tip_n: force of the ground; down: where the weight pulls. Frame: x outwards, y to the left, z up; a limb in its
 *     plane does not feel y
 *   place (in, out): from the tick before: the search goes on from there, a step a tick, so that a load that comes at
 *     once may need some ticks. So a limb that stands comes to its rest within rounding
 *   rest (out): after BRACE_OK
 * returns BRACE_OK, or as brace_loaded_follow, brace_loaded_fixed_follow and brace_loaded_space_follow, and as
 *   brace_loaded_space_stiffness. At most 2,700 instructions in the plane, 7,600 in space. */
brace_status_t model_loaded(const model_t *model, const brace_limb_t *limb, const float unbent_rad[BRACE_LINK_COUNT],
                            const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_vec3_t tip_n, brace_vec3_t down,
                            model_place_t *place, model_rest_t *rest);

/* The same in steps, for a job that cannot spend so much in a tick: begin, then go on until there is an answer. */

enum { MODEL_LATER = 1 }; /* a later step finds the answer */

/* What a step leaves for the next. */
typedef struct {
    bool is_under_way;
    float hip_yields_rad_per_n_mm; /* the joint alone */
    union {
        model_plane_work_t plane;
        brace_space_work_t space;
    } of;
} model_work_t;

/* returns MODEL_LATER, or why there is no K, as model_loaded. At most 1,200 instructions in the plane, 300 in
 * space. */
int32_t model_loaded_begin(const model_t *model, const float unbent_rad[BRACE_LINK_COUNT],
                           const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_vec3_t tip_n, brace_vec3_t down,
                           model_work_t *work);

/* After MODEL_LATER. The first call of it finds the answer in the plane, the sixth to the ninth in space.
 *   rest (out): after BRACE_OK
 * returns MODEL_LATER, or as model_loaded. At most 1,500 instructions in the plane, 1,200 in space. */
int32_t model_loaded_go_on(const model_t *model, const brace_limb_t *limb, model_work_t *work, model_rest_t *rest);

#endif
