/* The limb controller: samples in, K out, once a tick. This header is its manual.
 *
 * src/app.c holds the tick as one straight list of calls: sense the joints and the force; which flank of the backlash
 * carries; posture; K; one step of each job that runs; faults and mode; command the drives; publish the snapshot;
 * answer the wires; feed the watchdog.
 *
 * One brace_app_t per limb and no global state: many limbs run in one process. The controller knows the world through
 * brace_hal_t only. No heap, no recursion, no stdio, no clock of its own. One caller, never from an interrupt.
 * brace/app_memory.h completes the type, for whoever places it statically.
 *
 * K is valid when the mode is MONITOR, TAKING_UP or LOADING_TEST, the newest sound samples of femur and tibia joint
 * are no older than controller.age_limit_us, the posture is inside both drives' travel, and parameters are in force
 * (safe defaults count, flagged UNCALIBRATED). A limb whose coxa joint is fitted has its K in space too.
 *
 * A joint with play (gap_rad >= 1e-5) carries nothing while its load does not prove a flank: K is valid then, flagged
 * GAP_OPEN, with both bounds. The same holds while the joint's newest sample is more than four ticks old (its drive
 * answers AGAIN), and for 20 ms afterwards: choose a tick no shorter than a quarter of the drives' own period. A
 * flank is proven for at most brace_backlash_detection_us and four ticks after its gap has opened.
 */
#ifndef BRACE_APP_H
#define BRACE_APP_H

#include "brace/drift.h"
#include "brace/loading.h"
#include "brace/recorder.h"
#include "brace/snapshot.h"
#include "brace/store.h"
#include "brace_hal.h"

typedef struct brace_app brace_app_t;

/* ---------------------------------------------------------------------------------------------- running -- */

/* Starts a controller: takes the parameters in force from the store, sets up CAN (listen only while the node's number
 * is unset), and is in START until the first ticks have brought sound samples.
 *   hal: lives as long as app; entries that are not optional must be there
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER (a mandatory entry of hal is missing).
 * Not for the tick: some 50,000 instructions, and can_setup's 20 ms. */
brace_status_t brace_app_start(brace_app_t *app, const brace_hal_t *hal);

/* One tick; call it every parameters.controller.tick_us.
 *   now_us: the HAL's clock; may wrap
 * Cost on a Cortex-M4F: at most 12,000 instructions in every mode, HAL excluded; ./dev bench measures it. */
void brace_app_tick(brace_app_t *app, uint32_t now_us);

/* The newest snapshot; everything in it comes from the samples of one tick. Never null. Its content stays until the
 * tick after next. */
const brace_snapshot_t *brace_app_snapshot(const brace_app_t *app);

/* The parameters in force. */
const brace_parameters_t *brace_app_parameters(const brace_app_t *app);

void brace_app_counters(const brace_app_t *app, brace_app_counters_t *counters);

/* What the drift check knows: how far measurement and model have drifted apart, and the likeliest cause. */
const brace_drift_report_t *brace_app_drift_report(const brace_app_t *app);

/* --------------------------------------------------------------------------------------------- requests --
 * Call them between ticks. Each answers at once; what it begins goes on in the ticks.
 * All return BRACE_OK, BRACE_E_NULL, BRACE_E_MODE (not possible in this mode), and what is named. */

/* Takes up the backlash of one joint against a flank. When its take-up holds, another joint may follow. From MONITOR,
 * or in TAKING_UP with every joint asked before holding. snapshot.play[].takeup tells how it went. If one joint
 * fails, every joint is let go in the reverse order.
 *   joint_index: BRACE_COXA, BRACE_FEMUR or BRACE_TIBIA; flank: +1 or -1
 * returns also BRACE_E_RANGE (joint, flank), BRACE_E_UNSUPPORTED (no play, or no joint_command) */
brace_status_t brace_app_take_up(brace_app_t *app, int32_t joint_index, int32_t flank);

/* Lets every joint go, the last taken up first; the mode is MONITOR when the last is back. Ends a loading test too. */
brace_status_t brace_app_let_go(brace_app_t *app);

/* Begins a loading test, from MONITOR or with the backlash taken up: brace/loading.h.
 * returns also BRACE_E_RANGE (setup), BRACE_E_UNSUPPORTED (no joint_command), BRACE_E_SINGULAR (no valid K, or the
 * joints cannot move the tip along the axis at this posture) */
brace_status_t brace_app_loading_start(brace_app_t *app, const brace_loading_setup_t *setup);

/* Ends it; the limb goes back to where the test began. The rows so far stay. */
brace_status_t brace_app_loading_stop(brace_app_t *app);

/* The last loading test, or the one under way. Never null for a started app. */
const brace_loading_result_t *brace_app_loading_result(const brace_app_t *app);

/* Rows of the recorder, oldest first; BRACE_E_RANGE past the end. */
uint32_t brace_app_row_count(const brace_app_t *app);
brace_status_t brace_app_row(const brace_app_t *app, uint32_t index, brace_row_t *row);

/* Configuration: only here may parameters be stored. Nothing moves the limb and no K is valid. Entered from MONITOR or
 * FAULT, left to START. It ends by itself after BRACE_CONFIGURATION_PATIENCE_US in which nothing was written,
 * uploaded or stored and the mode was not asked for again; what was staged is forgotten then, and the set in force
 * stays. */
enum { BRACE_CONFIGURATION_PATIENCE_US = 10000000 };
brace_status_t brace_app_configuration_enter(brace_app_t *app);
brace_status_t brace_app_configuration_leave(brace_app_t *app);

/* Stores a set, and puts it in force once it has read back; in CONFIGURATION only. brace_app_store_status tells how it
 * goes. What concerns buses (node, bit rates) takes effect at the next start.
 * returns also BRACE_E_UNSUPPORTED (a set is being stored), BRACE_E_NOT_FINITE, BRACE_E_PARAMETER. Not within a tick.
 * */
brace_status_t brace_app_parameters_commit(brace_app_t *app, const brace_parameters_t *parameters);

/* Puts the set before the one in force back; in CONFIGURATION only. returns also what brace_store_rollback returns */
brace_status_t brace_app_parameters_rollback(brace_app_t *app);

brace_status_t brace_app_store_status(const brace_app_t *app, brace_store_status_t *status);

/* Clears MODEL_DRIFT (the drift check watches on from the baseline it holds) and CRASHED. faults: BRACE_FAULT_... bits
 * returns also BRACE_E_RANGE: a fault that no request clears */
brace_status_t brace_app_clear(brace_app_t *app, uint32_t faults);

#endif
