/* The simulated limb and its rig, for other languages: plain C, doubles throughout.
 *
 * Shared library libbrace_host. Every call is a pure function of its arguments (no state is kept, no global
 * is written), so calls may run on any number of threads at once; the same arguments give the same bits.
 * Units: mm, N, N mm, rad, s, degC. Frames, signs and formulas: docs/physics.md. A refused call returns a
 * negative status of brace_host_status_t and leaves its outputs untouched. Output pointers said to be
 * optional may be null. "Commanded" angles are what a dataset holds; the joints' zero offsets of the model
 * are added here, by the functions that say so.
 *
 * This file is its own cffi source: apart from '#' lines it holds nothing but declarations.
 */
#ifndef BRACE_HOST_H
#define BRACE_HOST_H

#include <stddef.h>
#include <stdint.h>

/* ------------------------------------------------------------------------------------------- status -- */

typedef enum {
    BRACE_HOST_OK = 0,
    BRACE_HOST_E_NULL = -1,        /* a pointer that must be given is null */
    BRACE_HOST_E_NOT_FINITE = -2,  /* an input is NaN or infinite where it may not be */
    BRACE_HOST_E_RANGE = -3,       /* an input lies outside its stated range, time runs backwards */
    BRACE_HOST_E_UNREACHABLE = -4, /* no posture of this limb puts the tip there */
    BRACE_HOST_E_PARAMETER = -5,   /* a model that no limb can have; brace_plant_model_fault names the key */
    BRACE_HOST_E_SINGULAR = -6,    /* nothing yields in some direction */
    BRACE_HOST_E_NO_CONVERGENCE = -9 /* some row's rest state was not found to tolerance */
} brace_host_status_t;

/* One line of English for a status; constant storage, never null. */
const char *brace_host_status_text(int32_t status);

/* Version of this library, "major.minor.patch"; constant storage. */
const char *brace_host_version(void);

/* -------------------------------------------------------------------------------------------- model -- */
/* The tables and keys of limb.toml, one double each, in the order of that file. */

typedef struct {
    double coxa_mm;  /* [0, 1e4] */
    double femur_mm; /* [1, 1e4] */
    double tibia_mm; /* [1, 1e4] */
} brace_plant_geometry_t;

typedef struct {
    double axial_mm_per_n;        /* [0, 1e3] */
    double bending_mm_per_n;      /* [0, 1e3] */
    double tilt_rad;              /* [-pi/2, pi/2] */
    double moment_transfer_ratio; /* [0, 1]; toml's false is 0 and true is 1 */
    double lateral_mm_per_n;      /* [0, 1e3]; spatial only */
    double torsion_rad_per_n_mm;  /* [0, 1]; spatial only */
} brace_plant_link_t;

typedef struct {
    double compliance_rad_per_n_mm; /* [0, 1] */
    double gap_rad;                 /* [0, 0.5], full play: no torque within +-gap/2 */
    double coulomb_n_mm;            /* [0, 1e9] */
    double coulomb_per_load_ratio;  /* [0, 0.9], friction = coulomb + this * |spring's torque| */
    double hardening_n_mm_per_rad3; /* [0, 1e30], torque = deflection / compliance + this * deflection^3 */
    double zero_offset_rad;         /* [-0.5, 0.5], true angle = commanded + offset */
} brace_plant_joint_t;

typedef struct {
    double x_mm_per_n;            /* [0, 1e3] */
    double z_mm_per_n;            /* [0, 1e3] */
    double rotation_rad_per_n_mm; /* [0, 1], about the femur axis */
} brace_plant_base_t;

typedef struct {
    double femur_n; /* [0, 1e6], at mid-length */
    double tibia_n; /* [0, 1e6], at mid-length */
    double knee_n;  /* [0, 1e6], at the knee joint */
} brace_plant_gravity_t;

typedef struct {
    double bias_x_n;
    double bias_z_n;
    double gain; /* (0, 1e3] */
    double rotation_rad;
    double crosstalk_xz;
    double crosstalk_zx;
    double drift_x_n_per_s;
    double drift_z_n_per_s;
    double saturation_n; /* (0, inf], each axis is clipped to +-this */
} brace_plant_sensor_t;

typedef struct {
    double ratio;           /* [0, 1e3] delayed deflection at last, over the elastic one */
    double time_constant_s; /* (0, inf) */
} brace_plant_creep_t;

typedef struct {
    double joint_compliance_per_degc; /* compliance times 1 + this * (temperature - reference), > 0 */
    double reference_degc;
} brace_plant_thermal_t;

typedef struct {
    double play_mm; /* [0, 1e3] full clearance of the tip's joint, each axis; it drags the tip along */
} brace_plant_contact_t;

typedef struct {
    double at_s;           /* the bending of the link is multiplied from this time on; inf is never */
    double link_index;     /* 0 coxa, 1 femur, 2 tibia */
    double bending_factor; /* [0, 1e3] */
} brace_plant_change_t;

typedef struct {
    brace_plant_geometry_t geometry;
    brace_plant_link_t link[3];   /* coxa, femur, tibia */
    brace_plant_joint_t joint[3]; /* coxa, femur, tibia: theta0, theta1, theta2 */
    brace_plant_base_t base;
    brace_plant_gravity_t gravity;
    brace_plant_sensor_t sensor;
    brace_plant_creep_t creep;
    brace_plant_thermal_t thermal;
    brace_plant_contact_t contact;
    brace_plant_change_t change;
} brace_plant_model_t;

/* The zero effect everywhere: rigid links and joints, gain 1, no saturation, no change, reference 22 degC,
 * the paper's lengths. Null is ignored. */
void brace_plant_model_default(brace_plant_model_t *model);

/* The first key (as in limb.toml, "joint.femur.gap_rad") whose value no limb can have, or null when all are
 * sound; constant storage. A limb in which nothing yields is found by the calls that need it (E_SINGULAR). */
const char *brace_plant_model_fault(const brace_plant_model_t *model);

/* ---------------------------------------------------------------------------------------- reference -- */
/* The linear limb (compliances only; gaps, friction, hardening, creep, gravity, contact, sensor ignored) in
 * double precision, written apart from the firmware, to judge it. Angles are TRUE joint angles, finite.
 * returns OK, E_NULL, E_NOT_FINITE, E_PARAMETER, E_SINGULAR */

/* out: count x 9 row-major: k_xx k_xz k_zz [N/mm], c_xx c_xz c_zz [mm/N], lambda_min lambda_max [N/mm],
 * stiff axis [rad, (-pi/2, pi/2]]. Accuracy: 1e-12 of lambda_max, and of lambda_min relative. */
int32_t brace_reference_planar(const brace_plant_model_t *model, size_t count, const double *theta1_rad,
                               const double *theta2_rad, double *out);

/* out: count x 18 row-major: k_xx k_xy k_xz k_yy k_yz k_zz, c_ likewise, three eigenvalues of K ascending,
 * unit vector of the largest; in the robot's base frame (theta0 = 0: the plane's x). Adds the coxa link, the
 * coxa joint, lateral and torsional compliances. */
int32_t brace_reference_spatial(const brace_plant_model_t *model, size_t count, const double *theta0_rad,
                                const double *theta1_rad, const double *theta2_rad, double *out);

/* out: count x 3: x y z of the tip [mm] in the robot's base frame, origin on the yaw axis at the height of
 * the femur axis (in the limb's plane the femur axis is at x = coxa). */
int32_t brace_reference_tip(const brace_plant_model_t *model, size_t count, const double *theta0_rad,
                            const double *theta1_rad, const double *theta2_rad, double *out);

/* The posture at r [mm] from the femur axis, in direction phi [rad]. knee_up != 0 takes the branch with
 * theta2 >= 0, the other its mirror. theta_rad: theta1, theta2. Adds E_UNREACHABLE. */
int32_t brace_reference_posture(const brace_plant_model_t *model, double r_mm, double phi_rad,
                                int32_t knee_up, double *theta_rad);

/* ------------------------------------------------------------------------------------ loading, plant -- */

/* A loading record's inputs, one entry per row, in the order of the record. A run starts wherever run[]
 * changes: joints' and contact's play centred, friction relaxed, creep gone; time and temperature run on. t_s
 * must not fall. */
typedef struct {
    size_t count;
    int32_t creep_runs_on;  /* 0: each run starts with creep gone; 1: creep runs on from run to run */
    int32_t zeroed_per_run; /* 1: each run's first reading is taken from its readings */
    const int32_t *run;
    const double *theta1_rad; /* commanded; zero offsets are added */
    const double *theta2_rad;
    const double *t_s;
    const double *temp_degc; /* may be null: the model's reference temperature */
    const double *dx_mm;     /* imposed displacement of the tip */
    const double *dz_mm;
    const int32_t *free_axis; /* may be null; 0: both axes imposed, 1: x is free, 2: z is free, its force 0 */
} brace_loading_rows_t;

/* What the rig would read; every pointer optional, each with room for one entry per row. */
typedef struct {
    double *fx_n; /* the sensor's reading of the force on the limb, before resolution and noise */
    double *fz_n;
    double *enc1_rad;  /* joint deflection on the output side: elastic, play and creep; counter-clockwise */
    double *enc2_rad;  /* positive, so that enc2 opens the knee (theta2 falls) */
    double *base_x_mm; /* deflection of the base, its rotation left out */
    double *base_z_mm;
} brace_loading_reading_t;

/* The quasi-static limb under the imposed displacements, in its plane: coxa link and joint do not act. On
 * E_NO_CONVERGENCE the outputs are written all the same and unsolved_rows (optional) counts the rows above
 * tolerance (1e-9 N of unbalance, or rounding where that is more).
 * returns OK, E_NULL, E_NOT_FINITE, E_RANGE, E_PARAMETER, E_SINGULAR, E_NO_CONVERGENCE
 * cost: about 0.05 us a row for a linear limb, 0.2-0.5 us with play, friction or hardening. */
int32_t brace_plant_loading(const brace_plant_model_t *model, const brace_loading_rows_t *rows,
                            const brace_loading_reading_t *reading, size_t *unsolved_rows);

/* The same for many models (array of model_count) on one record: every column of `readings` that is not null is
 * model_count x count, row-major; status (optional) has one entry per model; refused models leave NaN. Returns
 * the first status that is not OK. */
int32_t brace_plant_loading_many(const brace_plant_model_t *models, size_t model_count,
                                 const brace_loading_rows_t *rows, const brace_loading_reading_t *readings,
                                 int32_t *status);

/* --------------------------------------------------------------------------------- joint test, plant -- */

/* One joint alone, output locked or loaded. input is the other quantity: with torque_imposed == 0 the
 * imposed deflection [rad], else the torque [N mm]. A test starts wherever test[] changes (null: one test).
 */
typedef struct {
    size_t count;
    const int32_t *test;
    const double *t_s;
    const double *temp_degc; /* may be null: the model's reference temperature */
    const double *input;
    int32_t torque_imposed;
    int32_t joint_index; /* 0 coxa, 1 femur, 2 tibia */
    double reversal_rad; /* [0, 1] imposed angle: turning over which friction changes sign */
    /* imposed angle; may be null: friction relaxed where a test starts. Else count torques, of which those where a
     * test starts are read: friction begins strained by what the spring does not carry of them. */
    const double *start_torque_n_mm;
} brace_joint_rows_t;

/* out: torque [N mm] for imposed angles, angle [rad] for imposed torques; deflection = angle + the joint's
 * zero_offset_rad. A joint of compliance 0 refuses an imposed angle with E_SINGULAR.
 * returns OK, E_NULL, E_NOT_FINITE, E_RANGE, E_PARAMETER, E_SINGULAR */
int32_t brace_plant_joint(const brace_plant_model_t *model, const brace_joint_rows_t *rows, double *out);

/* ----------------------------------------------------------------------------------------------- rig -- */

/* The paper's loading test: at each configuration, along x (bit 0 of axes) and z (bit 1), repeats runs of
 * 0 -> +n -> 0 -> -n -> 0 steps; or, with cyclic != 0, its Fig. 12: 0 -> -n -> 0 -> +n -> 0 -> -n -> 0. */
typedef struct {
    size_t config_count;
    const double *theta1_rad; /* commanded, one per configuration */
    const double *theta2_rad;
    int32_t axes;           /* 1 x, 2 z, 3 both */
    int32_t repeats;        /* [1, 1000] */
    int32_t steps_per_side; /* [1, 10000] */
    int32_t cyclic;
    int32_t transverse_free; /* 1: the tip is free across the run's axis; 0: held, as in the paper */
    int32_t zeroed;          /* 0 never, 1 per run: the run's first reading is taken from all */
    int32_t shuffled;        /* runs in random order (from the seed) instead of one configuration at a time */
    double step_mm;          /* (0, 100] */
    double preload_x_mm;     /* displacement that every step of a run is taken from */
    double preload_z_mm;
    double dwell_s;         /* [0, 1e6] between readings */
    double pause_s;         /* [0, 1e6] between runs, on top of dwell */
    double temp_start_degc; /* temperature = start + rise * (1 - exp(-(t - start_s) / time constant)) */
    double temp_rise_degc;
    double temp_time_constant_s; /* (0, inf) */
    double noise_n;              /* one sigma of each force reading, before rounding */
    double resolution_n;         /* readings are rounded to multiples; 0: not rounded */
    double range_n;              /* (0, inf]: readings are clipped */
    double encoder_noise_rad;
    double base_noise_mm;
    uint64_t seed; /* the same seed, the same noise, on every machine */
    double start_s; /* [0, 1e9] when the first reading is taken; the temperature's course begins there too */
} brace_rig_design_t;

/* The paper's test, ready to change: 1 configuration needed, both axes, 2 repeats, 4 steps of 0.635 mm,
 * dwell 4 s, pause 20 s, 22 degC, noise 0, resolution 1/16 N, range 145 N, seed 0. */
void brace_rig_design_default(brace_rig_design_t *design);

/* Rows that the design makes, 0 when it is not sound. */
size_t brace_rig_row_count(const brace_rig_design_t *design);

/* A dataset's columns; every pointer optional, room for brace_rig_row_count entries each. */
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

/* Plays the test on the limb and reads it. model may be null: the sequence alone, readings 0. Statuses as
 * brace_plant_loading. */
int32_t brace_rig_play(const brace_rig_design_t *design, const brace_plant_model_t *model,
                       const brace_rig_record_t *record);

/* K by slopes as the paper measures it: one run per axis at each posture (commanded angles), steps_per_side
 * steps of step_mm. least_squares == 0: the paper's mean of ratios; else least squares through the first
 * reading. k: count x 4: k_xx k_xz k_zx k_zz [N/mm], not made symmetric. */
int32_t brace_rig_slopes(const brace_plant_model_t *model, size_t count, const double *theta1_rad,
                         const double *theta2_rad, double step_mm, int32_t steps_per_side,
                         int32_t least_squares, double *k);

/* Fig. 12's number [mm]: in the cyclic test along the axis (0 x, 1 z), the tip free across it, where the
 * force comes back to zero after unloading from +n, less where it does after -n. Play alone gives gap times
 * lever along the axis; friction adds to it. (With the tip held across the axis, play without friction shifts
 * nothing: it only lowers the slope.) E_RANGE when the force does not come back. */
int32_t brace_rig_zero_force_shift(const brace_plant_model_t *model, double theta1_rad, double theta2_rad,
                                   int32_t axis, double step_mm, int32_t steps_per_side, double *shift_mm);

/* ------------------------------------------------------------------------------------------- effects -- */

/* One named effect at one place. Strings are constant storage. */
typedef struct {
    const char *name;       /* "backlash" */
    const char *where;      /* "joint.femur" */
    const char *parameters; /* keys of limb.toml, separated by one space: "joint.femur.gap_rad" */
    const char *law;        /* one line */
} brace_effect_t;

/* Number of (effect, place) entries, and the entry at index [0, count). Null result pointers and a bad index
 * give E_NULL, E_RANGE. */
size_t brace_effect_count(void);
int32_t brace_effect_at(size_t index, brace_effect_t *effect);

/* The value of a key of limb.toml ("joint.femur.gap_rad", "change.link_index", ...): byte offset of its
 * double in brace_plant_model_t, or -1 for a key that the model does not have. */
int64_t brace_plant_key_offset(const char *key);

#endif
