/* The limb controller: samples in, K out, once a tick. This header is its manual.
 *
 * src/app.c holds the tick as one straight list of calls: sense the joints and the force; which side of each
 * backlash is loaded; posture; K; one step of each job that moves the limb or stores parameters; faults and mode;
 * command the drives; publish the snapshot; answer the wires; one step of one job that takes long; look at sensors and
 * memory; feed the watchdog.
 *
 * One brace_app_t per limb and no global state: many limbs run in one process. The controller knows the world through
 * brace_hal_t only. No heap, no recursion, no stdio, no clock of its own. One caller, never from an interrupt.
 * brace/app_memory.h completes the type, for whoever places it statically. What a started controller may be asked is in
 * brace/requests.h.
 *
 * K is valid when the mode is MONITOR, TAKING_UP or LOADING_TEST, the newest sound samples of femur and tibia joint
 * are no older than controller.age_limit_us, the posture is inside both drives' travel, and parameters are in force
 * (safe defaults count, flagged UNCALIBRATED), and K exists there: a singular posture has none (NEAR_SINGULAR), nor has
 * a load that folds the limb (SOFTENED). A limb whose coxa joint is fitted has its K in space too.
 *
 * A joint with play (gap_rad >= 1e-5) carries nothing while its load does not prove a side: K is valid then, flagged
 * GAP_OPEN, with both bounds. The same holds while the joint's newest sample is more than four ticks old (its drive
 * answers AGAIN), and for 20 ms afterwards: choose a tick no shorter than a quarter of the drives' own period. A
 * side is proven for at most brace_backlash_detection_us and four ticks after its gap has opened.
 */
#ifndef BRACE_APP_H
#define BRACE_APP_H

#include "brace/requests.h"
#include "brace_hal.h"

/* Starts a controller: takes the parameters in force from the store, sets up CAN (listen only while the node's number
 * is unset), and is in START until the first ticks have brought sound samples.
 *   hal: lives as long as app; entries that are not optional must be there
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER: now_us, joint_read, nvm_read, nvm_write, nvm_erase, watchdog_feed,
 *   reset_cause or crash_clear is null. Other mandatory entries are checked by hal/selftest only.
 * Not for the tick: some 50,000 instructions, and can_setup's 1 ms, twice where CAN FD is refused. */
brace_status_t brace_app_start(brace_app_t *app, const brace_hal_t *hal);

/* One tick; call it every parameters.controller.tick_us.
 *   now_us: the HAL's clock; may wrap
 * Cost on a Cortex-M4F, HAL excluded: the worst of 100,000 random ticks in every mode, with every port flooded, has
 * 15,665 instructions for a limb in its plane and 21,485 for a limb in space
 * (tests/judges/bench/tick_cost.py 100000). */
void brace_app_tick(brace_app_t *app, uint32_t now_us);

#endif
