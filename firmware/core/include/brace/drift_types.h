/* Types of the drift check; brace/drift.h says what they are for. */
#ifndef BRACE_DRIFT_TYPES_H
#define BRACE_DRIFT_TYPES_H

#include <stdint.h>

enum { BRACE_DRIFT_LEARN_LEAST = 256, BRACE_DRIFT_LEARN_MOST = 4096 };
enum { BRACE_DRIFT_NEVER = 0xffff };
#define BRACE_DRIFT_LEARNED_TO 0.04f

typedef enum {
    BRACE_DRIFT_LEARNING = 0,
    BRACE_DRIFT_WATCHING = 1,
    BRACE_DRIFT_DRIFTED = 2 /* raise MODEL_DRIFT; stays until brace_drift_reset or brace_drift_learn */
} brace_drift_state_t;

/* Causes that tip forces can tell apart. */
typedef enum {
    BRACE_DRIFT_FEMUR = 0,               /* the femur's bending */
    BRACE_DRIFT_TIBIA_OR_KNEE = 1,       /* the tibia's bending or the knee's spring: inseparable at the tip */
    BRACE_DRIFT_FEMUR_JOINT_OR_BASE = 2, /* the femur joint's spring or the base's rotation: inseparable too */
    BRACE_DRIFT_CAUSE_COUNT = 3,
    BRACE_DRIFT_UNEXPLAINED = 3 /* readings scatter more than their noise, and no cause above explains that */
} brace_drift_cause_t;

/* What the caller gives the check once. */
typedef struct {
    float noise_n; /* one sigma of a force reading, resolution included (0, 1e6] */
    float model_error_ratio; /* systematic error of the model that the check allows for, as a ratio of the
                                          force [0, 0.1]; 0.0005 for a limb as in docs/physics.md. A limb that creeps by
                                          1 % needs 0.01 */
    float joint_compliance_per_degc; /* the model's growth of joint compliance per degree [-0.1, 0.1] */
    float joint_compliance_trust_ratio; /* one sigma of that growth, relative to it [0, 1] */
} brace_drift_setup_t;

/* One reading of a loading run. */
typedef struct {
    float theta1_rad, theta2_rad; /* true angles [+-7.9] */
    float dx_mm, dz_mm; /* displacement of the tip, from any fixed point [+-1e4] */
    float fx_n, fz_n; /* force on the tip, with any constant offset [+-1e6] */
    float warmer_degc; /* temperature minus the model's reference [+-200] */
} brace_drift_reading_t;

/* The check's memory; read it through brace_drift_report. */
typedef struct {
    brace_drift_setup_t setup;
    float offset[7]; /* estimates: three compliances (relative), turn of the limb and of the knee, thermal rate,
                            axial compliance of both links */
    float covariance[28];
    float held[3]; /* compliance offsets when learning ended */
    float held_sigma[3];
    float left[3][7]; /* the part of a change of each cause that the estimates have not yet absorbed */
    float evidence[4]; /* log likelihood ratio for each cause since it was last zero */
    float score[3], information[3];
    float run_mean[4]; /* displacement and force */
    float run_theta_rad[2];
    uint32_t steps; /* readings taken in */
    uint16_t since[4]; /* readings since each evidence left zero; 65535: so many or more */
    uint8_t run_count, state, cause, outliers; /* outliers: force components more than six sigma off, up to 255 */
} brace_drift_t;

/* What the check knows. Loss: share of stiffness lost since learning ended; negative when the limb is stiffer. */
typedef struct {
    brace_drift_state_t state;
    brace_drift_cause_t cause; /* likeliest cause; meaningful only while evidence is large */
    uint32_t could_be; /* causes nearly as likely, as bits 1 << cause; includes the likeliest */
    float evidence; /* the largest log likelihood ratio of all causes; the alarm is at BRACE_DRIFT_ALARM */
    float loss_ratio; /* loss by the likeliest cause; of tibia or knee the tibia's. 0 for UNEXPLAINED */
    float loss_sigma_ratio; /* one sigma of loss_ratio */
    uint32_t since_steps; /* readings since the likeliest change */
    float learned_sigma_ratio[2]; /* how well the baselines of femur, and tibia or knee, are known */
    float baseline_sigmas; /* largest offset of the baseline from the calibration, in sigmas of its trust */
    uint32_t steps;
} brace_drift_report_t;

/* What readings at a posture can show. */
typedef struct {
    float sigma_of_loss_ratio[BRACE_DRIFT_CAUSE_COUNT]; /* one sigma of a loss from one reading like the one
                                                           given; 1e9: it shows nothing of this cause */
    uint32_t steps_needed[BRACE_DRIFT_CAUSE_COUNT]; /* such readings until a loss of 10 % is flagged, on
                                                           average; BRACE_DRIFT_NEVER: no number of them suffices */
} brace_drift_outlook_t;

/* Alarm level of the evidence, a log likelihood ratio. Whatever the postures, a ratio that starts at one reaches e^20
 * with a probability of at most e^-20 (Ville's inequality); for four causes that may start at each of 10^6 readings
 * that is at most 0.8 %, as long as the limb is within its calibration's trust and the noise is what the setup says. */
#define BRACE_DRIFT_ALARM 20.0f

#endif
