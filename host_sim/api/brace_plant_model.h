/* The simulated limb's model: the tables and keys of limb.toml, one double each, with the range of each.
 * What a key means: docs/limb-keys.md. Written by tools/interface from dictionary.toml; do not edit. */
#ifndef BRACE_PLANT_MODEL_H
#define BRACE_PLANT_MODEL_H

typedef struct {
    double coxa_mm; /* [0, 10000] */
    double femur_mm; /* [1, 10000] */
    double tibia_mm; /* [1, 10000] */
} brace_plant_geometry_t;

typedef struct {
    double axial_mm_per_n; /* [0, 1000] */
    double bending_mm_per_n; /* [0, 1000] */
    double tilt_rad; /* [-1.5708, 1.5708] */
    double lateral_mm_per_n; /* [0, 1000] */
    double torsion_rad_per_n_mm; /* [0, 1] */
    double moment_transfer; /* [0, 1] */
} brace_plant_link_t;

typedef struct {
    double compliance_rad_per_n_mm; /* [0, 1] */
    double gap_rad; /* [0, 0.5] */
    double zero_offset_rad; /* [-0.5, 0.5] */
    double coulomb_n_mm; /* [0, 1e+09] */
    double coulomb_per_load_ratio; /* [0, 0.9] */
    double hardening_n_mm_per_rad3; /* [0, 1e+30] */
    double coulomb_load_fade_per_n_mm; /* [0, 1] */
} brace_plant_joint_t;

typedef struct {
    double x_mm_per_n; /* [0, 1000] */
    double z_mm_per_n; /* [0, 1000] */
    double rotation_rad_per_n_mm; /* [0, 1] */
} brace_plant_base_t;

typedef struct {
    double femur_n; /* [0, 1e+06] */
    double tibia_n; /* [0, 1e+06] */
    double knee_n; /* [0, 1e+06] */
    double direction_rad; /* [-3.14159, 3.14159] */
    double lean_rad; /* [-1.5708, 1.5708] */
} brace_plant_gravity_t;

typedef struct {
    double bias_x_n; /* [-1e+06, 1e+06] */
    double bias_z_n; /* [-1e+06, 1e+06] */
    double gain; /* (0, 1000] */
    double rotation_rad; /* [-3.14159, 3.14159] */
    double crosstalk_xz; /* [-1, 1] */
    double crosstalk_zx; /* [-1, 1] */
    double drift_x_n_per_s; /* [-1000, 1000] */
    double drift_z_n_per_s; /* [-1000, 1000] */
    double saturation_n; /* (0, inf] */
} brace_plant_sensor_t;

typedef struct {
    double ratio; /* [0, 1000] */
    double time_constant_s; /* (0, inf) */
} brace_plant_creep_t;

typedef struct {
    double joint_compliance_per_degc; /* [-1, 1] */
    double reference_degc; /* [-273.15, 1000] */
} brace_plant_thermal_t;

typedef struct {
    double play_mm; /* [0, 1000] */
} brace_plant_contact_t;

typedef struct {
    double at_s; /* [-inf, inf] */
    double link_index; /* 0 coxa, 1 femur, 2 tibia */
    double bending_factor; /* (0, 1000] */
} brace_plant_change_t;

typedef struct {
    brace_plant_geometry_t geometry;
    brace_plant_link_t link[3]; /* coxa, femur, tibia */
    brace_plant_joint_t joint[3]; /* coxa, femur, tibia */
    brace_plant_base_t base;
    brace_plant_gravity_t gravity;
    brace_plant_sensor_t sensor;
    brace_plant_creep_t creep;
    brace_plant_thermal_t thermal;
    brace_plant_contact_t contact;
    brace_plant_change_t change;
} brace_plant_model_t;

#endif
