/* Commands of the robot's computer to a limb controller: what moves the limb, stop, clear; and the key of a guarded
 * board. docs/security.md says who may command.
 *
 *   (void)brace_client_begin_take_up(limb, 1, +1, 500, 30000); // what comes of it, brace_client_step reports
 *   while (brace_client_step(limb, 20, &motion) == BRACE_CLIENT_OK && motion.state <= BRACE_MOTION_RUNNING) {
 *       control_the_robot();
 *   }
 *
 * While the limb moves, the controller wants a sign of life at least every 100 ms; after 130 ms without one the limb
 * stands. brace_client_step gives the signs: call it at least every 50 ms. Every other call of the client gives them
 * too while it waits. A program that hangs gives none, so the limb stands. Each sign carries a number that the
 * controller has sent within the last 130 ms, so that nothing that was held up on its way moves the limb: with calls
 * every 50 ms the round trip to the controller may be 80 ms.
 *
 * A client follows one motion at a time, the one that was begun last. It allocates nothing for it.
 */
#ifndef BRACE_CLIENT_MOTION_H
#define BRACE_CLIENT_MOTION_H

#include "brace/client.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    BRACE_CLIENT_KEY_BYTES = 16,
    BRACE_CLIENT_STOP_ID = 1 /* the default of controller.stop_id */
};

typedef enum {
    BRACE_MOTION_NONE = 0,      /* nothing was asked for */
    BRACE_MOTION_ASKED = 1,     /* asked for; brace_client_step finds out whether it runs */
    BRACE_MOTION_RUNNING = 2,   /* the limb moves */
    BRACE_MOTION_DONE = 3,      /* it ended as it should */
    BRACE_MOTION_REFUSED = 4,   /* the controller did not begin it */
    BRACE_MOTION_FAILED = 5,    /* it began and failed, or a fault ended it; what was taken up is let go */
    BRACE_MOTION_STOPPED = 6,   /* somebody has stopped it: the limb stands */
    BRACE_MOTION_TIMED_OUT = 7, /* it took longer than its limit, and the client has asked it to stop; or it
                                   has not begun, because no answer came or the controller heard no sign of
                                   life in time: brace_client_why says which */
    BRACE_MOTION_OWNER_LOST = 8, /* the controller heard no sign of life in time: the limb stands */
    BRACE_MOTION_NOT_BEGUN = 9  /* the call that was to begin it failed before it asked for anything */
} brace_motion_state_t;

/* brace_client_why has the line for people. */
typedef struct {
    brace_motion_state_t state;
    int32_t reason; /* REFUSED: as brace_client_refusal; FAILED: a number of brace_take_up_outcome_text or
                       brace_loading_outcome_text, 0 where a fault ended it; NOT_BEGUN: the call's status; else
                       0 */
} brace_motion_t;

typedef struct {
    uint32_t axis;           /* the tip moves along it: 0 x, 1 z */
    uint32_t steps_per_side; /* [2, 60] */
    float step_mm;           /* [0.001, 50] */
    uint32_t dwell_ms;       /* time at each step [20, 10 000] */
} brace_loading_plan_t;

/* The key of a guarded board. A bench needs none, and reading needs none. The session is opened with the first command
 * and opened anew when the controller has ended it.
 *   path: a file with 32 hexadecimal digits, as `brace --key` takes it
 * returns OK, E_USAGE */
brace_client_status_t brace_client_load_key(brace_client_t *client, const char *path);
void brace_client_set_key(brace_client_t *client, const uint8_t key[BRACE_CLIENT_KEY_BYTES]);

/* Each asks for a motion and waits at most timeout_ms for the controller's answer.
 *   limit_ms: the whole motion may take so long [1, 3 600 000]; then the client asks the limb to stop
 * returns OK: the controller has taken it, and it begins with the next sign of life; call brace_client_step. E_REFUSED:
 *   the controller does not begin it. E_USAGE, E_UNSUPPORTED: it was not asked for. E_TIMEOUT and other failures to
 *   answer: it may have begun; brace_client_step finds out, and reports NOT_BEGUN where the call failed before it
 *   asked. Where a motion runs already, that one goes on unless a new one has begun, and brace_client_step reports
 *   it. */

/* The motor of a joint (0 coxa, 1 femur, 2 tibia) moves through its backlash until one side of it, `flank` [+1, -1],
 * is loaded, and holds that. DONE: it holds, and needs no further signs of life. */
brace_client_status_t brace_client_begin_take_up(brace_client_t *client, uint32_t joint, int flank, int timeout_ms,
                                                 int limit_ms);

/* All joints go back to where they were before they were taken up; a loading test ends. */
brace_client_status_t brace_client_begin_let_go(brace_client_t *client, int timeout_ms, int limit_ms);

/* The controller's loading test. The tip must stand on something that does not yield. DONE: the limb is back where it
 * began; brace_client_entry_f32 reads the results (loading_k_x_n_per_mm and on). CAN only. */
brace_client_status_t brace_client_begin_loading_test(brace_client_t *client, const brace_loading_plan_t *plan,
                                                      int timeout_ms, int limit_ms);

/* A loading test that runs, or was stopped and stands, goes back to where it began. What was taken up is held. */
brace_client_status_t brace_client_begin_end_test(brace_client_t *client, int timeout_ms, int limit_ms);

/* Gives a sign of life when one is due, asks the controller how the motion goes, and reports it. At most timeout_ms,
 * and 100 ms more when it has to stop the limb; 20 suffices over CAN, 50 over Modbus. Without a motion it does nothing.
 *   motion: written whatever is returned; null is allowed
 * returns OK; at once E_DOWN, E_FULL, E_VERSION, E_REFUSED (an exception over Modbus); after a second without an answer
 * E_TIMEOUT, E_SILENT, E_NODE, E_BIT_RATE */
brace_client_status_t brace_client_step(brace_client_t *client, int timeout_ms, brace_motion_t *motion);

/* Steps until the motion has ended, which its limit bounds.
 *   motion: written whatever is returned; null is allowed
 * returns OK: DONE. E_REFUSED: REFUSED, FAILED, STOPPED or OWNER_LOST. E_TIMEOUT: TIMED_OUT. E_USAGE: no motion was
 *   begun. NOT_BEGUN: what the call returned that was to begin it. Else as brace_client_step */
brace_client_status_t brace_client_wait(brace_client_t *client, brace_motion_t *motion);

/* The limb stands where it is. Anybody may, without a key too. Nothing is let go: brace_client_begin_let_go does that
 * later, brace_client_begin_end_test after a loading test. OK where nothing moves, too. */
brace_client_status_t brace_client_stop(brace_client_t *client, int timeout_ms);

/* Every limb of the client's CAN bus stands where it is, whoever moves it: sends a frame of the identifier stop_id,
 * which wins over all others. Then the client's own limb is asked as brace_client_stop does, so OK says that this one
 * stands; of the others no answer comes, and a frame that finds no bus is not heard. It may be called again and again.
 *   stop_id: what the limbs have as controller.stop_id [1, 127], BRACE_CLIENT_STOP_ID unless it was set otherwise
 * returns E_UNSUPPORTED over Modbus, where each limb is stopped by its own client. Else as brace_client_stop */
brace_client_status_t brace_client_stop_all(brace_client_t *client, uint32_t stop_id, int timeout_ms);

/* Clears faults that stay until somebody clears them: ENCODER_STUCK (bit 2; it comes
 * again while its cause lasts), MODEL_DRIFT (bit 7), CRASHED (bit 8).
 *   left: the faults that are there now; null is allowed */
brace_client_status_t brace_client_clear(brace_client_t *client, uint32_t faults, int timeout_ms, uint32_t *left);

#ifdef __cplusplus
}
#endif
#endif
