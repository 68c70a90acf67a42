/* Is it still the limb that was commissioned? The drift check compares model and measurement on the limb.
 *
 * It takes the readings of loading runs: the displacement imposed on the tip and the force read there. From them it
 * learns the limb's own baseline, within what the calibration is trusted to, and holds it. Then it reports a change:
 * which link or joint, how much, since which step. A cracked tube shows here long before a person would notice.
 *
 * A run is a stretch of readings at one posture. Its readings count from their own mean, so preload, sensor bias and
 * gravity play no part. A new run begins by itself when the posture changes by a milliradian and after 64 readings;
 * brace_drift_run begins one at any time. Where joints have dry friction, begin a run at each reversal of the motion,
 * because friction is constant within such a run. Leave out readings flagged GAP_OPEN, and begin a run after them.
 *
 * Learning needs readings along both axes, at postures that span the ones to be watched, and over the temperatures to
 * be expected. The paper's limb needs nine postures and 1,000 to 4,000 readings. Learning ends when the baseline of
 * both links is known to BRACE_DRIFT_LEARNED_TO of their stiffness, or at BRACE_DRIFT_LEARN_MOST readings. Afterwards
 * the baseline moves only slowly, with a memory of thousands of readings, so that it stays true at new postures and
 * temperatures. A baseline that moves by more than a tenth and six sigma is an alarm too. A change before or during
 * learning becomes part of the baseline; report.baseline_sigmas shows it only when it exceeds the calibration's trust.
 *
 * The state is plain data without pointers: keep its bytes in non-volatile memory to go on after a power cut. It
 * belongs to one set of limb parameters; learn again when they change, and after any repair.
 *
 * How it works and what it cannot see: docs/drift.md.
 * Thread rule: one caller per brace_drift_t; different ones are independent. No loop depends on data.
 */
#ifndef BRACE_DRIFT_H
#define BRACE_DRIFT_H

#include "brace/drift_types.h"
#include "brace/limb.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* Begins to learn. Call it at commissioning, after a repair, and when limb parameters change.
 *   limb: checked with brace_limb_check; its `uncertainty` bounds how far the baseline may differ from the model
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE (setup), BRACE_E_PARAMETER (limb);
 *   drift untouched unless BRACE_OK.
 * Off the tick; stack at most 250 bytes. */
brace_status_t brace_drift_learn(brace_drift_t *drift, const brace_limb_t *limb, const brace_drift_setup_t *setup);

/* Clears an alarm and the evidence, and watches on from the baseline that it holds. It begins a new run;
 * during learning it does nothing else.
 * returns BRACE_OK, BRACE_E_NULL. */
brace_status_t brace_drift_reset(brace_drift_t *drift);

/* Makes the next reading begin a new run: after a new contact, a zeroed sensor, or a change of flank.
 * returns BRACE_OK, BRACE_E_NULL. */
brace_status_t brace_drift_run(brace_drift_t *drift);

/* Takes one reading in.
 *   limb: as given to brace_drift_learn; stiffness: the model's K at the reading's posture, at reference temperature
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE; drift untouched unless BRACE_OK.
 * cost: at most 2,400 instructions on a Cortex-M4F (2,200 typical), stack at most 400 bytes: once a loading step, not
 * once a tick. */
brace_status_t brace_drift_step(brace_drift_t *drift, const brace_limb_t *limb, const brace_stiffness_t *stiffness,
                                const brace_drift_reading_t *reading);

/* What the check knows so far.
 *   limb: as given to brace_drift_learn
 * returns BRACE_OK, BRACE_E_NULL; report untouched unless BRACE_OK.
 * cost: at most 1,500 instructions on a Cortex-M4F (460 measured), whatever the state; stack at most 200 bytes. */
brace_status_t brace_drift_report(const brace_drift_t *drift, const brace_limb_t *limb, brace_drift_report_t *report);

/* What readings at a posture can show. It helps to choose where to test, and says what the silence of a check means.
 *   reading: the posture, and as dx, dz a typical displacement from the run's mean; its force is not used
 * returns as brace_drift_step; outlook untouched unless BRACE_OK.
 * cost: at most 1,500 instructions on a Cortex-M4F (1,255 measured); stack at most 400 bytes. On simulated limbs:
 * where it gives at most 15 readings, 30 readings flag the loss in 98 of 100. */
brace_status_t brace_drift_outlook(const brace_drift_t *drift, const brace_limb_t *limb,
                                   const brace_stiffness_t *stiffness, const brace_drift_reading_t *reading,
                                   brace_drift_outlook_t *outlook);

#endif
