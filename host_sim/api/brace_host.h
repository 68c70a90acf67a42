/* The simulated limb and its rig, for other languages: plain C, doubles throughout.
 *
 * Shared library libbrace_host. Every call is a pure function of its arguments (it keeps no state and writes no
 * global), so any number of threads may call at once, and the same arguments give the same bits.
 * Units: mm, N, N mm, rad, s, degC. Frames, signs and formulas: docs/physics.md. A refused call returns a
 * negative status of brace_host_status_t and leaves its outputs untouched. Output pointers that are called optional may
 * be null. "Commanded" angles are those of a dataset. Functions that take them say so, and add the joints' zero offsets
 * of the model.
 *
 * cffi reads this file and brace_plant_model.h as they are: apart from '#' lines they hold nothing but declarations.
 */
#ifndef BRACE_HOST_H
#define BRACE_HOST_H

#include <stddef.h>
#include <stdint.h>

#include "brace_plant_model.h"

/* ------------------------------------------------------------------------------------------- status -- */

typedef enum {
    BRACE_HOST_OK = 0,
    BRACE_HOST_E_NULL = -1,        /* a pointer that must be given is null */
    BRACE_HOST_E_NOT_FINITE = -2,  /* an input is NaN or infinite where it may not be */
    BRACE_HOST_E_RANGE = -3,       /* an input lies outside its stated range, or time runs backwards */
    BRACE_HOST_E_UNREACHABLE = -4, /* no posture of this limb puts the tip there */
    BRACE_HOST_E_PARAMETER = -5,   /* a model that no limb can have; brace_plant_model_fault names the key */
    BRACE_HOST_E_SINGULAR = -6,    /* nothing yields in some direction */
    BRACE_HOST_E_NO_CONVERGENCE = -9 /* the solver did not find the rest state of some row to tolerance */
} brace_host_status_t;

/* One line of English for a status; constant storage, never null. */
const char *brace_host_status_text(int32_t status);

/* Version of this library, "major.minor.patch"; constant storage. */
const char *brace_host_version(void);

/* -------------------------------------------------------------------------------------------- model -- */
/* brace_plant_model_t holds the tables and keys of limb.toml, one double each: brace_plant_model.h. */

/* A model without any effect: rigid links and joints, gain 1, no saturation, no change, reference 22 degC, and the
 * paper's lengths. Null is ignored. */
void brace_plant_model_default(brace_plant_model_t *model);

/* The first key (as in limb.toml, "joint.femur.gap_rad") whose value no limb can have, or null when all are sound;
 * constant storage. Calls that need a limb which yields refuse a rigid one with E_SINGULAR. */
const char *brace_plant_model_fault(const brace_plant_model_t *model);

/* ---------------------------------------------------------------------------------------- reference -- */
/* The linear limb in double precision, to judge the firmware; its code was written apart from the firmware's. It uses
 * compliances only and ignores gaps, friction, hardening, creep, gravity, contact and sensor. Angles are TRUE joint
 * angles, finite.
 * returns OK, E_NULL, E_NOT_FINITE, E_PARAMETER, E_SINGULAR */

/* out: count x 9 row-major: k_xx k_xz k_zz [N/mm], c_xx c_xz c_zz [mm/N], lambda_min lambda_max [N/mm],
 * stiff axis [rad, (-pi/2, pi/2]]. Accuracy: 1e-12 of lambda_max, and of lambda_min relative. */
int32_t brace_reference_planar(const brace_plant_model_t *model, size_t count, const double *theta1_rad,
                               const double *theta2_rad, double *out);

/* The same for many models (array of model_count), each at its own angles: theta1_rad, theta2_rad model_count x count,
 * out model_count x count x 9, row-major. status (optional) has one entry per model; a refused model leaves NaN.
 * returns the first status that is not OK. cost: about 2 us a posture. */
int32_t brace_reference_planar_many(const brace_plant_model_t *models, size_t model_count, size_t count,
                                    const double *theta1_rad, const double *theta2_rad, double *out, int32_t *status);

/* out: count x 18 row-major: k_xx k_xy k_xz k_yy k_yz k_zz, the same six of C, three eigenvalues of K ascending, unit
 * vector of the largest; in the robot's base frame (theta0 = 0: the plane's x). The limb then has its coxa link, coxa
 * joint, lateral and torsional compliances too. */
int32_t brace_reference_spatial(const brace_plant_model_t *model, size_t count, const double *theta0_rad,
                                const double *theta1_rad, const double *theta2_rad, double *out);

/* out: count x 3: x y z of the tip [mm] in the robot's base frame, origin on the yaw axis at the height of
 * the femur axis (in the limb's plane the femur axis is at x = coxa). */
int32_t brace_reference_tip(const brace_plant_model_t *model, size_t count, const double *theta0_rad,
                            const double *theta1_rad, const double *theta2_rad, double *out);

/* The posture at r [mm] from the femur axis, in direction phi [rad]. knee_up != 0 takes the branch with
 * theta2 >= 0, else its mirror image. theta_rad: theta1, theta2. returns also E_UNREACHABLE. */
int32_t brace_reference_posture(const brace_plant_model_t *model, double r_mm, double phi_rad, int32_t knee_up,
                                double *theta_rad);

/* -------------------------------------------------------------------------------- reference, loaded -- */
/* The limb under load, at finite displacements: the rest state (a minimum of spring energy minus work of force and
 * weights), and K there. Compliances, lengths and weights of the model; no gaps, friction, hardening, creep, contact or
 * sensor. Zero offsets of the model are not added. Meaning of the limb, formulas and sources: docs/physics.md,
 * reference/loaded.h, reference/chain.h.
 *
 * parts: 0, the default, takes every beam (a link's share of moment transfer) as 8 and as 16 parts of two hinges each
 * and extrapolates; the error that is left is below 1e-6 of K and of the reach, where the buckling factor is at least 2
 * and the tip moves by at most a fifth of the reach. [1, 1000]: so many parts, and no extrapolation. [-1000, -1]:
 * -parts parts with one hinge in the middle of each, as physics engines have beams: bending is exact at no load, the
 * turn of n parts 1/(4 n^2) too large. The rest state is found to 1e-9 mm.
 * status (optional): one entry a case. A case without an answer leaves NaN in its result.
 * returns the first status of a case that is not OK: E_NOT_FINITE, E_RANGE (gravity is no unit vector),
 * E_NO_CONVERGENCE (no rest state: the load collapses the limb, or the displacement is out of reach), E_SINGULAR
 * (nothing yields in some direction); or E_NULL, E_RANGE (parts), E_PARAMETER, and then writes nothing
 * cost of a case: 0.02-0.1 ms with ellipsoids only, 0.1-0.4 ms with beams; in space 0.02-0.1 and 0.3-1.2 ms. */

/* In the limb's plane. */
typedef struct {
    double theta1_rad; /* joint angles without deflection */
    double theta2_rad;
    double fx_n; /* force of the ground on the tip; only _under_force reads it */
    double fz_n;
    double dx_mm; /* of the tip, from its place without force and weight; only _under_displacement reads it */
    double dz_mm;
    double gravity_rad; /* direction in which the weights pull: -pi/2 is down */
} brace_loaded_case_t;

typedef struct {
    double dx_mm; /* displacement of the tip, from its place on the limb without force and weight */
    double dz_mm;
    double fx_n; /* force of the ground on the tip */
    double fz_n;
    double k_xx; /* [N/mm] gradient of the force by the displacement, at rest */
    double k_xz;
    double k_zz;
    double lambda_min;      /* [N/mm] */
    double lambda_max;      /* [N/mm] */
    double axis_rad;        /* of lambda_max, (-pi/2, pi/2] */
    double buckling_factor; /* smallest factor on the springs' geometric stiffness that makes H singular; inf: none */
    double femur_rad;       /* deflection of the joints, counter-clockwise: a positive tibia_rad opens the knee */
    double tibia_rad;
    double femur_n_mm; /* moment of force and weights about the joints, counter-clockwise; at rigid ones, too */
    double tibia_n_mm;
    double base_x_mm; /* deflection of the base, its rotation counter-clockwise */
    double base_z_mm;
    double base_rad;
} brace_loaded_result_t;

int32_t brace_reference_under_force(const brace_plant_model_t *model, size_t count, const brace_loaded_case_t *cases,
                                    int32_t parts, brace_loaded_result_t *results, int32_t *status);

/* The rest state that is reached when the tip, from the rest at no force, is led to the displacement on a straight
 * line. K of a held tip may be indefinite: the tip would not stay there if it were let go. */
int32_t brace_reference_under_displacement(const brace_plant_model_t *model, size_t count,
                                           const brace_loaded_case_t *cases, int32_t parts,
                                           brace_loaded_result_t *results, int32_t *status);

/* In space: as brace_reference_spatial, in the robot's base frame (theta0 = 0: the plane's x). */
typedef struct {
    double theta0_rad;
    double theta1_rad;
    double theta2_rad;
    double fx_n;
    double fy_n;
    double fz_n;
    double dx_mm;
    double dy_mm;
    double dz_mm;
    double gravity_x; /* unit vector in which the weights pull */
    double gravity_y;
    double gravity_z;
} brace_loaded_space_case_t;

typedef struct {
    double dx_mm;
    double dy_mm;
    double dz_mm;
    double fx_n;
    double fy_n;
    double fz_n;
    double k_xx;
    double k_xy;
    double k_xz;
    double k_yy;
    double k_yz;
    double k_zz;
    double buckling_factor;
    double coxa_rad; /* counter-clockwise seen from above */
    double femur_rad;
    double tibia_rad;
    double coxa_n_mm;
    double femur_n_mm;
    double tibia_n_mm;
    double base_x_mm; /* along the commanded limb's plane */
    double base_z_mm;
    double base_rad;
} brace_loaded_space_result_t;

int32_t brace_reference_space_under_force(const brace_plant_model_t *model, size_t count,
                                          const brace_loaded_space_case_t *cases, int32_t parts,
                                          brace_loaded_space_result_t *results, int32_t *status);
int32_t brace_reference_space_under_displacement(const brace_plant_model_t *model, size_t count,
                                                 const brace_loaded_space_case_t *cases, int32_t parts,
                                                 brace_loaded_space_result_t *results, int32_t *status);

/* ------------------------------------------------------------------------------------ loading, plant -- */

/* A loading record's inputs, one entry per row, in the order of the record. A run starts wherever run[] changes: then
 * joints' and contact's backlash is centred, friction is relaxed and creep is gone, while time and temperature run on.
 * t_s must not fall. */
typedef struct {
    size_t count;
    int32_t creep_runs_on;  /* 0: each run starts with creep gone; 1: creep runs on from run to run */
    int32_t zeroed_per_run; /* 1: each run's first reading is subtracted from its readings */
    int32_t small_displacements; /* 0: the limb turns by any angle, and bends under its weight; 1: the linear limb about
                                  * the commanded posture, whose weights load the joints only */
    int32_t held_at_rest; /* displacements count 0: from the weightless limb's place; 1: from where the limb hangs under
                           * its weight at the start of each run, with backlash and friction as they are left there */
    const int32_t *run;
    const double *theta1_rad; /* commanded; the model's zero offsets are added */
    const double *theta2_rad;
    const double *t_s;
    const double *temp_degc; /* may be null: the model's reference temperature */
    const double *dx_mm; /* imposed displacement of the tip */
    const double *dz_mm;
    const int32_t *free_axis; /* may be null; 0: both axes imposed, 1: x is free, 2: z is free, its force 0 */
    /* may be null, then preload_z_n is, too. Else the force on the limb's tip at each run's first row: the tip rests in
     * its place under that force, and displacements count from the first row */
    const double *preload_x_n;
    const double *preload_z_n;
} brace_loading_rows_t;

/* The rig's readings. Every pointer is optional, and has room for one entry per row. */
typedef struct {
    double *fx_n; /* the sensor's reading of the force on the limb, before resolution and noise */
    double *fz_n;
    double *enc1_rad; /* joint deflection on the output side (elastic, backlash and creep), positive */
    double *enc2_rad; /* counter-clockwise, so that a positive enc2 opens the knee (theta2 falls) */
    double *base_x_mm; /* how far the base moved, without its rotation */
    double *base_z_mm;
} brace_loading_reading_t;

/* The quasi-static limb under the imposed displacements, in its plane: coxa link and joint do not act. On
 * E_NO_CONVERGENCE the outputs are written nevertheless, and unsolved_rows (optional) counts the rows whose unbalance
 * is above tolerance (1e-9 N, or rounding where that is more).
 * returns OK, E_NULL, E_NOT_FINITE, E_RANGE, E_PARAMETER, E_SINGULAR, E_NO_CONVERGENCE
 * cost of a row: 0.4 us where all is springs, 0.6-1.2 us with play, friction or hardening, 0.6 us more with beams for
 * both links (1 us more where the record is one run); at small displacements 0.2 us, 0.4-0.7 us and nothing. */
int32_t brace_plant_loading(const brace_plant_model_t *model, const brace_loading_rows_t *rows,
                            const brace_loading_reading_t *reading, size_t *unsolved_rows);

/* The same for many models (array of model_count) on one record. Every column of `readings` that is not null is
 * model_count x count, row-major. status (optional) has one entry per model; a refused model leaves NaN. returns the
 * first status that is not OK. */
int32_t brace_plant_loading_many(const brace_plant_model_t *models, size_t model_count,
                                 const brace_loading_rows_t *rows, const brace_loading_reading_t *readings,
                                 int32_t *status);

/* --------------------------------------------------------------------------------- joint test, plant -- */

/* One joint alone, with its output locked or loaded. With torque_imposed == 0, input is the imposed deflection [rad]
 * and torque is read; otherwise input is the torque [N mm]. A test starts wherever test[] changes (null: one test).
 */
typedef struct {
    size_t count;
    const int32_t *test;
    const double *t_s;
    const double *temp_degc; /* may be null: the model's reference temperature */
    const double *input;
    int32_t torque_imposed;
    int32_t joint_index; /* 0 coxa, 1 femur, 2 tibia */
    double reversal_rad; /* [0, 1] imposed angle: length of the turn over which friction changes its sign */
    /* For an imposed angle. Null: friction is relaxed where a test starts. Else count torques, of which only those at
     * the start of a test are read: there friction begins strained by the part of the torque that the spring does not
     * carry. */
    const double *start_torque_n_mm;
} brace_joint_rows_t;

/* out: torque [N mm] for imposed angles, angle [rad] for imposed torques; deflection = angle + the joint's
 * zero_offset_rad. A joint of compliance 0 refuses an imposed angle with E_SINGULAR.
 * returns OK, E_NULL, E_NOT_FINITE, E_RANGE, E_PARAMETER, E_SINGULAR */
int32_t brace_plant_joint(const brace_plant_model_t *model, const brace_joint_rows_t *rows, double *out);

/* The same for many models (array of model_count) on one record. reversal_rad has one entry per model, in place of the
 * rows' own. torque_offset_n_mm has one entry per model: what the torque's sensor reads at no torque; it is added to
 * every torque in out and taken off the start torques. With an imposed torque neither acts. out: model_count x count,
 * row-major. status (optional) has one entry per model; a refused model leaves NaN. returns the first status that is
 * not OK. cost: about 0.02 us a row. */
int32_t brace_plant_joint_many(const brace_plant_model_t *models, size_t model_count, const brace_joint_rows_t *rows,
                               const double *reversal_rad, const double *torque_offset_n_mm, double *out,
                               int32_t *status);

/* ----------------------------------------------------------------------------------------------- rig -- */

/* The paper's loading test: at each configuration, along x (bit 0 of axes) and z (bit 1), `repeats` runs of
 * 0 -> +n -> 0 -> -n -> 0 steps. With cyclic != 0 it is the paper's Fig. 12: 0 -> -n -> 0 -> +n -> 0 -> -n -> 0. */
typedef struct {
    size_t config_count;
    const double *theta1_rad; /* commanded, one per configuration; any finite angle */
    const double *theta2_rad; /* the same */
    int32_t axes; /* 1 x, 2 z, 3 both */
    int32_t repeats; /* [1, 1000] */
    int32_t steps_per_side; /* [1, 10000] */
    int32_t cyclic;
    int32_t transverse_free; /* 1: the tip is free across the run's axis; 0: held, as in the paper */
    int32_t zeroed; /* 0 never, 1 per run: the run's first reading is subtracted from all of its readings */
    int32_t shuffled; /* 1: runs come in random order (from the seed); 0: one configuration after another */
    int32_t small_displacements; /* as in brace_loading_rows_t */
    int32_t held_at_rest;
    double step_mm; /* (0, 100] */
    double preload_x_mm; /* [-1000, 1000] displacement from which every step of a run counts */
    double preload_z_mm; /* [-1000, 1000] */
    double dwell_s; /* [0, 1e6] time between readings */
    double pause_s; /* [0, 1e6] time between runs, in addition to dwell_s */
    double temp_start_degc; /* [-273.15, 1e4]; temperature = start + rise * (1 - exp(-(t - start_s) / time constant)) */
    double temp_rise_degc; /* [-1e4, 1e4] */
    double temp_time_constant_s; /* (0, inf) */
    double noise_n; /* [0, 1e6] one sigma of each force reading, before rounding */
    double resolution_n; /* [0, 1e6] readings are rounded to multiples of it; 0: not rounded */
    double range_n; /* (0, inf]: readings are clipped to +-this */
    double encoder_noise_rad; /* [0, 1e6] one sigma */
    double base_noise_mm; /* [0, 1e6] one sigma */
    uint64_t seed; /* the same seed gives the same noise on every machine */
    double start_s; /* [0, 1e9] time of the first reading; the temperature's course begins there too */
} brace_rig_design_t;

/* The paper's test, which still needs a configuration: both axes, 2 repeats, 4 steps of 0.635 mm,
 * dwell 4 s, pause 20 s, 22 degC, noise 0, resolution 1/16 N, range 145 N, seed 0. */
void brace_rig_design_default(brace_rig_design_t *design);

/* How many rows the design makes; 0 when a value is outside its range, or for more than 20 million rows. */
size_t brace_rig_row_count(const brace_rig_design_t *design);

/* A dataset's columns. Every pointer is optional, with room for brace_rig_row_count entries. */
typedef struct {
    int32_t *run;
    int32_t *config;
    int32_t *axis; /* 0 x, 1 z */
    int32_t *rep;
    int32_t *step;
    double *theta1_rad;
    double *theta2_rad;
    double *t_s;
    double *temp_degc;
    double *dx_mm;
    double *dz_mm;
    double *fx_n;
    double *fz_n;
    double *enc1_rad;
    double *enc2_rad;
    double *base_x_mm;
    double *base_z_mm;
} brace_rig_record_t;

/* Plays the test on the limb and reads the instruments. With a null model it writes only the sequence, with readings 0.
 * returns as brace_plant_loading; E_RANGE where brace_rig_row_count is 0. */
int32_t brace_rig_play(const brace_rig_design_t *design, const brace_plant_model_t *model,
                       const brace_rig_record_t *record);

/* K by slopes as the paper measures it: one run per axis at each posture (commanded angles, finite), steps_per_side
 * [1, 10000] steps of step_mm (0, 100]. least_squares == 0: the paper's mean of ratios; else least squares through the
 * first reading. k: count x 4: k_xx k_xz k_zx k_zz [N/mm], not made symmetric; written on success only.
 * returns as brace_plant_loading; E_RANGE for steps outside their range. */
int32_t brace_rig_slopes(const brace_plant_model_t *model, size_t count, const double *theta1_rad,
                         const double *theta2_rad, double step_mm, int32_t steps_per_side, int32_t least_squares,
                         double *k);

/* Fig. 12's number [mm], from the cyclic test along the axis (0 x, 1 z) with the tip free across it: the displacement
 * at which the force comes back to zero after unloading from +n, minus that after -n. Backlash alone gives gap times
 * lever along the axis; friction adds to it. (With the tip held across the axis, backlash without friction shifts
 * nothing and only lowers the slope.) Angles, steps_per_side and step_mm as above; shift_mm is written on success only.
 * returns the same; E_RANGE also when the force does not come back to zero, or for another axis. */
int32_t brace_rig_zero_force_shift(const brace_plant_model_t *model, double theta1_rad, double theta2_rad, int32_t axis,
                                   double step_mm, int32_t steps_per_side, double *shift_mm);

/* ---------------------------------------------------------------------------------------------- keys -- */

/* Where the value of a key of limb.toml ("joint.femur.gap_rad", "change.link", ...) lies: byte offset of its double in
 * brace_plant_model_t, or -1 for a key that the model does not have. */
int64_t brace_plant_key_offset(const char *key);

#endif
