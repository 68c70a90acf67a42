/* Written by tools/interface from messages.toml; do not edit. */
#ifndef BRACE_CAN_REQUESTS_H
#define BRACE_CAN_REQUESTS_H

/* Every request and every message of messages.toml, as lists for the preprocessor. A controller makes its tables from
 * them, so a new request needs no hand-written line besides the function that answers it, and a new message none:
 *
 *     #define HANDLER(CODE, name) [CODE] = request_##name,
 *     static const handler_t handlers[32] = {BRACE_CAN_REQUESTS(HANDLER)};
 *
 * BRACE_CAN_REQUESTS(X)    X(code, name): the request's code, and its name, as in brace_can_unpack_<name>_request
 * BRACE_CAN_PROCESS(X)     X(identifier, name, rate): classic frames of measured values, name as in
 *                          brace_can_make_<name>; rate is the member of brace_controller_t that says how often.
 *                          Each part of a multiplexed message stands by itself, in order.
 * BRACE_CAN_PROCESS_FD(X)  the same of CAN FD
 * BRACE_CAN_BY_HAND(X)     X(identifier, name): classic frames that hand-written code fills and sends
 */
#include "brace/can_messages.h"

#define BRACE_CAN_REQUESTS(X) \
    X(BRACE_REQUEST_READ_ENTRY, read_entry) \
    X(BRACE_REQUEST_WRITE_ENTRY, write_entry) \
    X(BRACE_REQUEST_K_AT_POSTURE, k_at_posture) \
    X(BRACE_REQUEST_K_AT_TIP_KNEE_UP, k_at_tip_knee_up) \
    X(BRACE_REQUEST_K_AT_TIP_KNEE_DOWN, k_at_tip_knee_down) \
    X(BRACE_REQUEST_CONTACT_FORCE, contact_force) \
    X(BRACE_REQUEST_SAG_FOR_LOAD, sag_for_load) \
    X(BRACE_REQUEST_FRICTION_MARGIN, friction_margin) \
    X(BRACE_REQUEST_SET_MODE, set_mode) \
    X(BRACE_REQUEST_UPLOAD_BEGIN, upload_begin) \
    X(BRACE_REQUEST_UPLOAD_WORD, upload_word) \
    X(BRACE_REQUEST_COMMIT, commit) \
    X(BRACE_REQUEST_ROLLBACK, rollback) \
    X(BRACE_REQUEST_DOWNLOAD_WORD, download_word) \
    X(BRACE_REQUEST_TAKE_UP, take_up) \
    X(BRACE_REQUEST_LET_GO, let_go) \
    X(BRACE_REQUEST_LOADING_TEST_START, loading_test_start) \
    X(BRACE_REQUEST_LOADING_TEST_STOP, loading_test_stop) \
    X(BRACE_REQUEST_FETCH_ROW, fetch_row) \
    X(BRACE_REQUEST_IDENTIFY, identify) \
    X(BRACE_REQUEST_LOADING_TEST_RESULT, loading_test_result) \
    X(BRACE_REQUEST_CLEAR, clear) \
    X(BRACE_REQUEST_K_IN_SPACE_AT_POSTURE, k_in_space_at_posture) \
    X(BRACE_REQUEST_DRIFT, drift) \
    X(BRACE_REQUEST_TAKE_UP_RESULT, take_up_result)

#define BRACE_CAN_PROCESS(X) \
    X(BRACE_CAN_ID_STIFFNESS_A, stiffness_a, stiffness_hz) \
    X(BRACE_CAN_ID_STIFFNESS_B, stiffness_b, stiffness_hz) \
    X(BRACE_CAN_ID_EIGENVALUES, eigenvalues, posture_hz) \
    X(BRACE_CAN_ID_POSTURE, posture, posture_hz) \
    X(BRACE_CAN_ID_SPACE, space_0, stiffness_hz) \
    X(BRACE_CAN_ID_SPACE, space_1, stiffness_hz) \
    X(BRACE_CAN_ID_SPACE, space_2, stiffness_hz) \
    X(BRACE_CAN_ID_SPACE, space_3, stiffness_hz) \
    X(BRACE_CAN_ID_SPACE, space_4, stiffness_hz) \
    X(BRACE_CAN_ID_SPACE, space_5, stiffness_hz) \
    X(BRACE_CAN_ID_SPACE, space_6, stiffness_hz)

#define BRACE_CAN_PROCESS_FD(X) \
    X(BRACE_CAN_ID_SNAPSHOT_FD, snapshot_fd, stiffness_hz) \
    X(BRACE_CAN_ID_SPACE_FD, space_fd, stiffness_hz)

#define BRACE_CAN_BY_HAND(X) \
    X(BRACE_CAN_ID_EMERGENCY, emergency) \
    X(BRACE_CAN_ID_HEARTBEAT, heartbeat)

#endif
