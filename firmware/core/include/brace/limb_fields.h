/* Written by tools/interface from dictionary.toml; do not edit. */
#ifndef BRACE_LIMB_FIELDS_H
#define BRACE_LIMB_FIELDS_H

/* The three links and, by the same index, the joint at the near end of each. */
enum { BRACE_COXA = 0, BRACE_FEMUR = 1, BRACE_TIBIA = 2, BRACE_LINK_COUNT = 3 };

/* A link's compliance ellipsoid: principal compliances of its far end under a force there, while its near end is
 * clamped. Zero is rigid. */
typedef struct {
    /* the link's compliance along itself [mm/N, 0 to 1000] */
    float axial_mm_per_n;
    /* the link's compliance across itself, in the limb's plane [mm/N, 0 to 1000] */
    float bending_mm_per_n;
    /* the turn of the compliance ellipsoid from the link's axis [rad, -1.5708 to 1.5708] */
    float tilt_rad;
    /* the link's compliance out of the limb's plane [mm/N, 0 to 1000] */
    float lateral_mm_per_n;
    /* the link's torsional compliance about itself [rad/(N mm), 0 to 1] */
    float torsion_rad_per_n_mm;
    /* the strength of the uniform-beam coupling of force and moment [0 to 1] */
    float moment_transfer;
} brace_link_t;

/* A joint, without its drive. */
typedef struct {
    /* the compliance of gearbox and servo at the joint [rad/(N mm), 0 to 1] */
    float compliance_rad_per_n_mm;
    /* the full play at the joint [rad, 0 to 0.5] */
    float gap_rad;
    /* the true angle less the commanded one at the joint [rad, -0.5 to 0.5] */
    float zero_offset_rad;
} brace_joint_t;

/* What the limb stands on. */
typedef struct {
    /* the compliance of the base along x [mm/N, 0 to 1000] */
    float x_mm_per_n;
    /* the compliance of the base along z [mm/N, 0 to 1000] */
    float z_mm_per_n;
    /* the compliance of the base in rotation about the femur axis [rad/(N mm), 0 to 1] */
    float rotation_rad_per_n_mm;
} brace_base_t;

/* How far the calibration is trusted. */
typedef struct {
    /* how far the lengths are trusted, as one sigma [mm, 0 to 100] */
    float length_mm;
    /* how far the joints' zeros are trusted, as one sigma [rad, 0 to 0.5] */
    float angle_rad;
    /* how far every compliance is trusted, as one sigma relative to it [0 to 1] */
    float compliance_rel;
    /* how far the sensor's gain is trusted, as one sigma relative to it [0 to 1] */
    float gain_rel;
} brace_uncertainty_t;

/* The limb as its calibration describes it. */
typedef struct {
    /* the distance from the yaw axis to the femur axis [mm, 0 to 10000] */
    float coxa_mm;
    /* the femur's length [mm, 1 to 10000] */
    float femur_mm;
    /* the tibia's length [mm, 1 to 10000] */
    float tibia_mm;
    brace_link_t link[BRACE_LINK_COUNT];
    brace_joint_t joint[BRACE_LINK_COUNT];
    brace_base_t base;
    brace_uncertainty_t uncertainty;
} brace_limb_t;

/* Weights of the limb's parts, and where they pull. */
typedef struct {
    /* the femur's weight, at mid-length [N, 0 to 1e+06] */
    float femur_n;
    /* the tibia's weight, at mid-length [N, 0 to 1e+06] */
    float tibia_n;
    /* the weight at the knee joint [N, 0 to 1e+06] */
    float knee_n;
    /* the direction of down in the limb's plane, from +x, until the main computer says another one [rad, -3.14159
     * to 3.14159] */
    float direction_rad;
    /* how far down leans out of the limb's plane, to the left: its part in the plane is shortened by the cosine
     * [rad, -1.5708 to 1.5708] */
    float lean_rad;
} brace_gravity_t;

#endif
