/* Model against measurement, on the limb: is it still the limb that was commissioned?
 *
 * Fed with the readings of loading runs (displacement imposed on the tip, force read there), it learns the
 * limb's own baseline within what the calibration is trusted to, holds it, and tells a change: which link or
 * joint, how much, since which step. A cracked tube shows here long before a person would notice.
 *
 * A run is a stretch of readings at one posture; its readings count from their own mean, so preload, sensor bias
 * and gravity play no part. A new run begins by itself when the posture changes by a milliradian and after 64
 * readings, else by brace_drift_run. Where joints have dry friction, begin a run at each reversal of the motion:
 * friction is constant in it. Leave out readings flagged GAP_OPEN, and begin a run after them.
 *
 * Learning wants readings along both axes, at postures that span the ones to be watched, and over the
 * temperatures to be expected; of the paper's limb, nine postures and 1,000 to 4,000 readings. It ends when the
 * baseline of both links is known to BRACE_DRIFT_LEARNED_TO of their stiffness, or at BRACE_DRIFT_LEARN_MOST.
 * Afterwards the baseline is held, but for a memory of thousands of readings that keeps it true at new postures
 * and temperatures; should it walk away by more than a tenth and six sigma, that is an alarm too. A change before
 * or while learning becomes part of the baseline, unless it is beyond what the calibration is trusted to
 * (report.baseline_sigmas).
 *
 * The state is plain data without pointers: keep its bytes in non-volatile memory to go on after a power cut. It
 * belongs to one set of limb parameters; learn again when they change, and after any repair.
 *
 * How it works and what it cannot see: docs/drift.md.
 * Thread rule: one caller per brace_drift_t; different ones are independent. No loop depends on data.
 */
#ifndef BRACE_DRIFT_H
#define BRACE_DRIFT_H

#include "brace/limb.h"
#include "brace/stiffness.h"

enum { BRACE_DRIFT_LEARN_LEAST = 256, BRACE_DRIFT_LEARN_MOST = 4096 };
enum { BRACE_DRIFT_NEVER = 0xffff };
#define BRACE_DRIFT_LEARNED_TO 0.04f

typedef enum {
    BRACE_DRIFT_LEARNING = 0,
    BRACE_DRIFT_WATCHING = 1,
    BRACE_DRIFT_DRIFTED = 2 /* raise MODEL_DRIFT; stays until brace_drift_reset or brace_drift_learn */
} brace_drift_state_t;

/* What tip forces can tell apart. */
typedef enum {
    BRACE_DRIFT_FEMUR = 0,               /* the femur's bending */
    BRACE_DRIFT_TIBIA_OR_KNEE = 1,       /* the tibia's bending or the knee's spring: inseparable at the tip */
    BRACE_DRIFT_FEMUR_JOINT_OR_BASE = 2, /* the femur joint's spring or the base's rotation: inseparable too */
    BRACE_DRIFT_CAUSE_COUNT = 3,
    BRACE_DRIFT_UNEXPLAINED = 3          /* readings scatter more than their noise and no cause above fits better */
} brace_drift_cause_t;

/* What the check is told once. */
typedef struct {
    float noise_n;                     /* one sigma of a force reading, resolution included (0, 1e6] */
    float model_error_ratio;           /* systematic error of the model allowed for, of the force [0, 0.1];
                                          0.0005 for a limb as docs/physics.md has it. What creeps by 1 % needs 0.01 */
    float joint_compliance_per_degc;   /* believed: joint compliance grows by this per degree [-0.1, 0.1] */
    float joint_compliance_trust_ratio; /* one sigma of it, of itself [0, 1] */
} brace_drift_setup_t;

/* One reading of a loading run. */
typedef struct {
    float theta1_rad, theta2_rad; /* true angles [+-7.9] */
    float dx_mm, dz_mm;           /* displacement of the tip, from any fixed point [+-1e4] */
    float fx_n, fz_n;             /* force on the tip, with any constant offset [+-1e6] */
    float warmer_degc;            /* temperature less the model's reference [+-200] */
} brace_drift_reading_t;

/* The check's memory; read it through brace_drift_report. */
typedef struct {
    brace_drift_setup_t setup;
    float offset[7];     /* estimates: three compliances (relative), turn of the limb and of the knee, thermal rate,
                            axial compliance of both links */
    float covariance[28];
    float held[3];       /* compliance offsets when learning ended */
    float held_sigma[3];
    float left[3][7];    /* what the estimates have not yet absorbed of a change of each cause */
    float evidence[4];   /* log likelihood ratio for each cause since it last was zero */
    float score[3], information[3];
    float run_mean[4];   /* displacement and force */
    float run_theta_rad[2];
    uint32_t steps;      /* readings taken in */
    uint16_t since[4];   /* readings since each evidence left zero; 65535: as many or more */
    uint8_t run_count, state, cause, outliers; /* outliers: force components more than six sigma off, up to 255 */
} brace_drift_t;

/* What is known. Loss: share of stiffness lost since the baseline was held; negative when stiffer. */
typedef struct {
    brace_drift_state_t state;
    brace_drift_cause_t cause; /* likeliest; means something while evidence is large */
    uint32_t could_be;         /* causes nearly as likely, as bits 1 << cause; the likeliest among them */
    float evidence;            /* log likelihood ratio of the likeliest cause; the alarm is at BRACE_DRIFT_ALARM */
    float loss_ratio;          /* of the likeliest cause: tibia or knee is given as the tibia's. 0 for UNEXPLAINED */
    float loss_sigma_ratio;
    uint32_t since_steps;      /* readings since the likeliest change */
    float learned_sigma_ratio[2]; /* how well the baselines of femur, and tibia or knee, are known */
    float baseline_sigmas;     /* largest offset of the baseline from the calibration, in sigmas of its trust */
    uint32_t steps;
} brace_drift_report_t;

/* What a posture can show. */
typedef struct {
    float sigma_of_loss_ratio[BRACE_DRIFT_CAUSE_COUNT]; /* one sigma of a loss from one reading like the one given */
    uint32_t steps_needed[BRACE_DRIFT_CAUSE_COUNT];     /* such readings until a loss of 10 % is flagged, on
                                                           average; BRACE_DRIFT_NEVER: not at this posture */
} brace_drift_outlook_t;

/* Alarm level of the evidence, a log likelihood ratio. Whatever the postures, a ratio that starts at one reaches e^20
 * with a probability of at most e^-20 (Ville's inequality); for four causes that may start at each of 10^6 readings
 * that is at most 0.8 %, as long as the limb is within its calibration's trust and the noise is what the setup says. */
#define BRACE_DRIFT_ALARM 20.0f

/* Begins to learn: at commissioning, after a repair, when limb parameters change.
 *   limb: checked with brace_limb_check; its `uncertainty` bounds what is learned
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE (setup), BRACE_E_PARAMETER (limb);
 *   drift untouched unless BRACE_OK.
 * Off the tick; stack at most 250 bytes. */
brace_status_t brace_drift_learn(brace_drift_t *drift, const brace_limb_t *limb, const brace_drift_setup_t *setup);

/* Clears an alarm and the evidence, and watches on from the baseline as it is held; while learning: no effect.
 * returns BRACE_OK, BRACE_E_NULL. */
brace_status_t brace_drift_reset(brace_drift_t *drift);

/* The next reading begins a new run (new contact, sensor zeroed anew, flank changed).
 * returns BRACE_OK, BRACE_E_NULL. */
brace_status_t brace_drift_run(brace_drift_t *drift);

/* Takes one reading in.
 *   limb: as learned with; stiffness: the model's K at the reading's posture, at reference temperature
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE; drift untouched unless BRACE_OK.
 * cost: at most 2,400 instructions on a Cortex-M4F (2,200 typical), stack at most 400 bytes: once a loading step, not
 * once a tick. */
brace_status_t brace_drift_step(brace_drift_t *drift, const brace_limb_t *limb, const brace_stiffness_t *stiffness,
                                const brace_drift_reading_t *reading);

/* returns BRACE_OK, BRACE_E_NULL; report untouched unless BRACE_OK.
 * Off the tick; stack at most 200 bytes. */
brace_status_t brace_drift_report(const brace_drift_t *drift, const brace_limb_t *limb, brace_drift_report_t *report);

/* What readings at a posture can show: to choose where to test, and to say what a silent check means.
 *   reading: posture, and as dx, dz a typical displacement from the run's mean; its force is not used
 * returns as brace_drift_step; outlook untouched unless BRACE_OK.
 * Off the tick; stack at most 400 bytes. On simulated limbs, where it says at most 15 readings, 30 do in 98 of 100. */
brace_status_t brace_drift_outlook(const brace_drift_t *drift, const brace_limb_t *limb,
                                   const brace_stiffness_t *stiffness, const brace_drift_reading_t *reading,
                                   brace_drift_outlook_t *outlook);

#endif
