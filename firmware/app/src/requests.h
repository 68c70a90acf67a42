/* What may be asked of the controller, whoever asks: a wire, or the program around it through brace/app.h.
 *
 * This is the only door to the controller's parts. Wires know nothing behind it. Every function answers at once; what a
 * request begins goes on in the ticks. No pointer may be null. Costs on a Cortex-M4F stand where they matter. */
#ifndef BRACE_REQUESTS_H
#define BRACE_REQUESTS_H

#include "brace/contact.h"
#include "brace/drift.h"
#include "brace/loading.h"
#include "brace/recorder.h"
#include "brace/snapshot.h"
#include "brace/store.h"

typedef struct controller controller_t;

/* ------------------------------------------------------------------------------------ what is known -- */

/* The newest snapshot: K and everything measured. Complete, and untouched until the tick after next. */
const brace_snapshot_t *request_snapshot(const controller_t *controller);

/* Mode and faults of this moment; a request may have changed the mode since the snapshot. */
brace_mode_t request_mode(const controller_t *controller);
uint32_t request_faults(const controller_t *controller);

const brace_parameters_t *request_parameters(const controller_t *controller);
uint32_t request_parameter_crc(const controller_t *controller);
uint32_t request_parameter_sequence(const controller_t *controller); /* counts the sets stored; 0 for the defaults */
brace_parameter_origin_t request_parameter_origin(const controller_t *controller);

/* Troubles counted by the controller's own parts; the counters of the wires are 0 here. */
void request_counters(const controller_t *controller, brace_app_counters_t *counters);

/* What the drift check knows, and what a person should do next. */
const brace_drift_report_t *request_drift_report(const controller_t *controller);
brace_drift_next_t request_drift_next_step(const controller_t *controller);

/* ------------------------------------------------------------------------------- what moves the limb -- */

/* brace/app.h tells what these do and what they return. */
brace_status_t request_take_up(controller_t *controller, int32_t joint_index, int32_t flank);
brace_status_t request_let_go(controller_t *controller);
brace_status_t request_loading_start(controller_t *controller, const brace_loading_setup_t *setup);
brace_status_t request_loading_stop(controller_t *controller);
const brace_loading_result_t *request_loading_result(const controller_t *controller);

/* Is the limb on its way back from a loading test that has ended? */
bool request_loading_is_returning(const controller_t *controller);

uint32_t request_row_count(const controller_t *controller);
brace_status_t request_row(const controller_t *controller, uint32_t index, brace_row_t *row);

/* Clears MODEL_DRIFT and CRASHED; brace_app_clear. */
brace_status_t request_clear(controller_t *controller, uint32_t faults);

/* --------------------------------------------------------------------------------------- parameters -- */

brace_status_t request_configuration_enter(controller_t *controller);
brace_status_t request_configuration_leave(controller_t *controller);

/* CONFIGURATION lasts its patience from here. */
void request_configuration_keep(controller_t *controller);

/* Is a set being stored or put in force? */
bool request_is_storing(const controller_t *controller);
void request_store_status(const controller_t *controller, brace_store_status_t *status);

/* May parameters be written now? That somebody asks keeps CONFIGURATION going.
 * returns BRACE_OK, BRACE_E_MODE (not in CONFIGURATION), BRACE_E_UNSUPPORTED (a set is being stored) */
brace_status_t request_may_write(controller_t *controller);

/* The set that is being written, begun as a copy of the set in force. */
const brace_parameters_t *request_staged(const controller_t *controller);

/* Stages one parameter as its 32 bits.
 *   number: on the wire (brace_parameter_index)
 * returns also what request_may_write returns, BRACE_E_RANGE (no such parameter), BRACE_E_PARAMETER and
 * BRACE_E_NOT_FINITE (not in its own range). At most 450 instructions the first time, then 90. */
brace_status_t request_stage(controller_t *controller, uint32_t number, uint32_t word);

/* Stages parameters whose numbers follow one another: all of them, or none where one is refused. words: each as its 32
 * bits. Returns what request_stage returns. At most 450 instructions the first time, and 65 a parameter. */
brace_status_t request_stage_block(controller_t *controller, uint32_t first_number, uint32_t count,
                                   const uint32_t *words);

/* Begins to store what is staged. wrong_index (out, may be null): as brace_parameters_check. At most 2,000
 * instructions. */
brace_status_t request_commit_staged(controller_t *controller, uint32_t *wrong_index);

/* Begins to store a whole set, which the store checks in its first steps. */
brace_status_t request_commit(controller_t *controller, const brace_parameters_t *parameters);
brace_status_t request_rollback(controller_t *controller);

/* ------------------------------------------------------------------------------------------ questions -- */

/* stiffness/questions.h tells what these answer. */
brace_status_t request_k_at_posture(controller_t *controller, float theta1_rad, float theta2_rad,
                                    brace_stiffness_t *stiffness);
brace_status_t request_k_at_tip(controller_t *controller, brace_point_t tip, brace_knee_t knee,
                                brace_stiffness_t *stiffness);
brace_status_t request_k_in_space(controller_t *controller, float theta0_rad, float theta1_rad, float theta2_rad,
                                  brace_stiffness_spatial_t *stiffness);
brace_status_t request_contact_force(const controller_t *controller, brace_displacement_t displacement,
                                     brace_contact_force_t *contact);
brace_status_t request_sag(const controller_t *controller, brace_force_t load, brace_displacement_t *sag);
brace_status_t request_grip(const controller_t *controller, float normal_rad, float friction_ratio,
                            brace_contact_grip_t *grip);

#endif
