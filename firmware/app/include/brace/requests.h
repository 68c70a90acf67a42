/* What may be asked of a controller, whoever asks: the program around it, or one of its wires.
 *
 * This is the one door to the controller's parts; nobody outside knows what is behind it. Call it between ticks; the
 * wires, which are part of the tick, call it in their turn. Every function answers at once; what a request begins goes
 * on in the ticks. Functions that return a status take null pointers (BRACE_E_NULL); for all others there must be a
 * started controller. Costs on a Cortex-M4F stand where they matter. */
#ifndef BRACE_REQUESTS_H
#define BRACE_REQUESTS_H

#include "brace/contact.h"
#include "brace/drift.h"
#include "brace/k_question.h"
#include "brace/loading.h"
#include "brace/recorder.h"
#include "brace/snapshot.h"
#include "brace/store.h"
#include "brace/who.h"

typedef struct brace_app brace_app_t;

/* ------------------------------------------------------------------------------------ what is known -- */

/* The newest snapshot: K and everything measured, from the samples of one tick. Never null. Its content stays until the
 * tick after next. */
const brace_snapshot_t *brace_app_snapshot(const brace_app_t *app);

/* Mode and faults of this moment; a request may have changed them since the snapshot. */
brace_mode_t brace_app_mode(const brace_app_t *app);
uint32_t brace_app_faults(const brace_app_t *app);

/* The parameters in force. */
const brace_parameters_t *brace_app_parameters(const brace_app_t *app);

void brace_app_counters(const brace_app_t *app, brace_app_counters_t *counters);

/* What the drift check knows: how far measurement and model have drifted apart, and the likeliest cause; and what a
 * person should do next. */
const brace_drift_report_t *brace_app_drift_report(const brace_app_t *app);
brace_drift_next_t brace_app_drift_next_step(const brace_app_t *app);

/* --------------------------------------------------------------------------------------- who may --
 * The program around the controller may do everything below. A wire asks here first, for whoever asks it:
 * docs/security.md says what somebody on a bus can do. */

/* What a request does beside answering. */
typedef enum {
    BRACE_COMMAND_NONE = 0, /* nothing: everybody may */
    BRACE_COMMAND_MOVES, /* the limb: take-ups, loading tests, letting go */
    BRACE_COMMAND_WRITES, /* parameters: CONFIGURATION and all in it */
    BRACE_COMMAND_INFORMS /* the controller of what changes K: where down is, that a fault is over */
} brace_command_t;

typedef struct {
    brace_setting_t setting;
    brace_owner_t owner;
    bool is_held; /* what moves the limb stands */
    uint32_t number; /* the controller's number of now, for a sign of life */
    bool has_begin; /* a motion waits for a sign of life with the number `begin` */
    uint32_t begin;
    bool has_challenge;
    uint64_t challenge;
    uint32_t strangers; /* commands and signs of life that were refused, but for replays */
    uint32_t replays; /* refused with BRACE_REFUSED_REPLAY or BRACE_REFUSED_LATE */
    uint32_t silences; /* how often the limb stood because its owner was silent */
    uint32_t commits_refused; /* too early, or with another CRC */
    uint32_t erases; /* of a slot, since start */
    int32_t last_refusal; /* BRACE_REFUSED_...; 0: none */
} brace_session_report_t;

void brace_app_session(const brace_app_t *app, brace_session_report_t *report);
brace_setting_t brace_app_setting(const brace_app_t *app);

/* A sign of life of whoever moves the limb, which it gives every 100 ms: after 130 ms of silence the limb stands.
 * returns BRACE_OK or why not (brace/refusals.h). At most 700 instructions. */
int32_t brace_app_life(brace_app_t *app, brace_who_t who, const brace_sign_t *sign);

/* May it command that?
 *   seal: null: none has come; bytes: of the command, as the seal was made over them
 * returns BRACE_OK or why not. At most 650 instructions, and 20 for each byte beyond eight. */
int32_t brace_app_may_command(brace_app_t *app, brace_command_t command, brace_who_t who, const brace_seal_t *seal,
                              const uint8_t *bytes, uint32_t count);

/* The other end of a port has gone, or a connection of it: its session is over. */
void brace_app_gone(brace_app_t *app, brace_asker_t port);

/* Everybody on the board's buses may move the limb until the next start: for the board's own console. */
void brace_app_become_bench(brace_app_t *app);

/* Does the controller add anything to a joint's set-point, or is it about to? Then a joint is taken up, held, on its
 * way back, or in a loading test. */
bool brace_app_moves(const brace_app_t *app);

/* Holds every set-point where it is: anybody may, always. A loading test is over; what was taken up stays so; what
 * waits to begin does not. The limb moves again when its owner asks for something, letting go for example.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_MODE: nothing moves the limb, and nothing waits to */
brace_status_t brace_app_stop(brace_app_t *app);

/* ------------------------------------------------------------------------------- what moves the limb --
 * All return BRACE_OK, BRACE_E_NULL, BRACE_E_MODE (not possible in this mode), and what is named. What a wire asks for
 * in its turn of the tick begins when its owner's sign of life comes with the session report's number `begin`; without
 * one within 130 ms it is forgotten. */

/* Takes up the backlash of one joint against a flank. When its take-up holds, another joint may follow. From MONITOR,
 * or in TAKING_UP with every joint asked before holding. snapshot.play[].takeup reports how it went. If one joint
 * fails, every joint is let go in the reverse order.
 *   joint_index: BRACE_COXA, BRACE_FEMUR or BRACE_TIBIA; flank: +1 or -1
 * returns also BRACE_E_RANGE (joint or flank; the joint is taken up already, or in FAULT), BRACE_E_UNSUPPORTED (no
 * play, no joint_command, or drive.takeup_torque_n_mm is too small to prove a side) */
brace_status_t brace_app_take_up(brace_app_t *app, int32_t joint_index, int32_t flank);

/* Lets every joint go, the last taken up first; the mode is MONITOR when the last is back. Ends a loading test too. */
brace_status_t brace_app_let_go(brace_app_t *app);

/* Begins a loading test, from MONITOR or with the backlash taken up: brace/loading.h.
 * returns also BRACE_E_RANGE (setup), BRACE_E_UNSUPPORTED (no joint_command), BRACE_E_SINGULAR (no valid K, or the
 * joints cannot move the tip along the axis at this posture) */
brace_status_t brace_app_loading_start(brace_app_t *app, const brace_loading_setup_t *setup);

/* Ends it; the limb goes back to where the test began. The rows so far stay. */
brace_status_t brace_app_loading_stop(brace_app_t *app);

/* Is the limb on its way back from a loading test that has ended? */
bool brace_app_loading_is_returning(const brace_app_t *app);

/* The last loading test, or the one under way. Never null. */
const brace_loading_result_t *brace_app_loading_result(const brace_app_t *app);

/* Rows of the recorder, oldest first; BRACE_E_RANGE past the end. */
uint32_t brace_app_row_count(const brace_app_t *app);
brace_status_t brace_app_row(const brace_app_t *app, uint32_t index, brace_row_t *row);

/* Clears MODEL_DRIFT (the drift check watches on from the baseline it holds), CRASHED, ENCODER_STUCK (a joint that is
 * frozen is proven so anew by what the limb does next), JUMP_COXA, JUMP_FEMUR and JUMP_TIBIA (what the joint's encoders
 * say next is believed), and OLD_PARAMETERS (the set in force is taken until the next start, though another one was
 * stored after it). faults: BRACE_FAULT_... bits
 * returns also BRACE_E_RANGE: a fault that no request clears */
brace_status_t brace_app_clear(brace_app_t *app, uint32_t faults);

/* --------------------------------------------------------------------------------------- parameters --
 * All return BRACE_OK, BRACE_E_NULL, BRACE_E_MODE (not possible in this mode), and what is named. */

/* Configuration: only here may parameters be stored. Nothing moves the limb and no K is valid. Entered from MONITOR or
 * FAULT, left to START. It ends by itself after BRACE_CONFIGURATION_PATIENCE_US in which nothing was written,
 * uploaded or stored and the mode was not asked for again; what was staged is forgotten then, and the set in force
 * stays. */
enum { BRACE_CONFIGURATION_PATIENCE_US = 10000000 };
brace_status_t brace_app_configuration_enter(brace_app_t *app);
brace_status_t brace_app_configuration_leave(brace_app_t *app);

/* May parameters be written now? That somebody asks keeps CONFIGURATION going.
 * returns also BRACE_E_UNSUPPORTED (a set is being stored) */
brace_status_t brace_app_may_write(brace_app_t *app);

/* The set that is being written, begun as a copy of the set in force. */
const brace_parameters_t *brace_app_parameters_staged(const brace_app_t *app);

/* Has anything been staged since CONFIGURATION was entered, or since the last set was stored? */
bool brace_app_has_staged(const brace_app_t *app);

/* Stages parameters whose numbers on the wire (brace_parameter_index) follow one another: all of them, or none where
 * one is refused. words: each as its 32 bits.
 * returns also what brace_app_may_write returns, BRACE_E_RANGE (no such parameter), BRACE_E_PARAMETER and
 * BRACE_E_NOT_FINITE (not in its own range). At most 450 instructions the first time, and 65 a parameter. */
brace_status_t brace_app_parameters_stage(brace_app_t *app, uint32_t first_number, uint32_t count,
                                          const uint32_t *words);

/* Begins to store what is staged. What members say together is judged at once.
 *   wrong_index (out, may be null): as brace_parameters_check
 * returns also what brace_app_may_write returns, BRACE_E_PARAMETER, BRACE_E_NOT_FINITE. At most 2,000 instructions. */
brace_status_t brace_app_parameters_commit_staged(brace_app_t *app, uint32_t *wrong_index);

/* The same, if what is staged is the set with this brace_parameters_crc; else it ends in BRACE_STORE_E_REFUSED with
 * BRACE_E_CHECKSUM, and nothing is touched. */
brace_status_t brace_app_parameters_commit_named(brace_app_t *app, uint32_t crc, uint32_t *wrong_index);

/* May another commit come over a wire already? Each wears the memory, so they are 10 s apart. A refusal is counted.
 *   wait_ms (out): how long not yet; 0: it may
 * returns BRACE_OK, BRACE_REFUSED_EARLY */
int32_t brace_app_may_commit(brace_app_t *app, uint32_t *wait_ms);

/* Is a set within what the board allows? It may not exceed the board's ceilings, nor take the node's number away.
 * returns the index of the member that is not, or BRACE_PARAMETER_COUNT. At most 100 instructions. */
uint32_t brace_app_beyond_board(const brace_app_t *app, const brace_parameters_t *parameters);

/* Begins to store a set, which is in force once it has been checked, stored and read back; brace_app_store_status
 * reports how it goes. A set that brace_parameters_check refuses fails there, and the one in force stays. What concerns
 * buses (node, bit rates) takes effect at the next start.
 * returns also what brace_app_may_write returns. At most 800 instructions. */
brace_status_t brace_app_parameters_commit(brace_app_t *app, const brace_parameters_t *parameters);

/* Begins to put the set before the one in force back.
 * returns also what brace_app_may_write and brace_store_rollback return */
brace_status_t brace_app_parameters_rollback(brace_app_t *app);

/* Is a set being stored or put in force? */
bool brace_app_is_storing(const brace_app_t *app);
brace_status_t brace_app_store_status(const brace_app_t *app, brace_store_status_t *status);

/* ------------------------------------------------------------------------------------------ questions --
 * What they answer is untouched unless BRACE_OK is returned. */

/* Asks for such a K. It is worked out in the ticks to come: ask the same again in every tick until the answer comes.
 * One question has its answer in the second tick after, of a limb in space in the fifth, or up to the tenth while
 * other ports are asked or process data leave; process data that have waited for long, and a step towards the buckling
 * factor, take one tick more each, and K's own uncertainty each fourth tick.
 * Four that ask at once are worked out one after the other. Whoever
 * does not ask for seven ticks loses its place.
 * returns BRACE_APP_LATER, BRACE_OK, BRACE_E_NULL, what brace_kinematics_inverse and brace_loaded_stiffness return, in
 *   space also BRACE_E_UNSUPPORTED: the limb has no coxa joint. At most 80 instructions. */
int32_t brace_app_ask_k(brace_app_t *app, brace_asker_t asker, const brace_k_question_t *question,
                        brace_k_answer_t *answer);

/* Is the K that was asked for by such an asker still being worked out? It need not be asked for again then: this keeps
 * its place. At most 30 instructions. */
bool brace_app_k_is_coming(brace_app_t *app, brace_asker_t asker);

/* Where down is, from now until the next start: directions as the parameters of [gravity] have them. NaN for both: the
 * parameters' own again.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE (one NaN alone), BRACE_E_RANGE. At most 200 instructions. */
brace_status_t brace_app_set_gravity(brace_app_t *app, float direction_rad, float lean_rad);

/* The direction of down that holds now. */
void brace_app_gravity(const brace_app_t *app, float *direction_rad, float *lean_rad);

/* What the K of now makes of a displacement, and of a load.
 * returns as brace_contact_force and brace_contact_sag; BRACE_E_RANGE also while a gap is open: then nothing carries
 * the tip in some direction. BRACE_E_MODE: there is no valid K */
brace_status_t brace_app_contact_force(const brace_app_t *app, brace_displacement_t displacement,
                                       brace_contact_force_t *contact);
brace_status_t brace_app_sag(const brace_app_t *app, brace_force_t load, brace_displacement_t *sag);

/* How far the force of now is from sliding on a surface.
 *   normal_rad: direction of the surface's normal, towards the limb, from +x [-7.9, 7.9]; friction_ratio [0, 10]
 * returns as brace_contact_grip; BRACE_E_NOT_FINITE also where the force is not known */
brace_status_t brace_app_grip(const brace_app_t *app, float normal_rad, float friction_ratio,
                              brace_contact_grip_t *grip);

#endif
