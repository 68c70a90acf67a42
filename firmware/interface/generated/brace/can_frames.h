/* Written by tools/interface from messages.toml; do not edit. */
#ifndef BRACE_CAN_FRAMES_H
#define BRACE_CAN_FRAMES_H

/* Every message of messages.toml, as lists for the preprocessor. A controller makes its tables from them, so a new
 * message needs no hand-written line.
 *
 * BRACE_CAN_PROCESS(X)     X(identifier, name, rate): classic frames of measured values, name as in
 *                          brace_can_make_<name>; rate is the member of brace_controller_t that says how often.
 *                          Each part of a multiplexed message stands by itself, in order.
 * BRACE_CAN_PROCESS_FD(X)  the same of CAN FD
 * BRACE_CAN_BY_HAND(X)     X(identifier, name): classic frames that hand-written code fills and sends
 */
#include "brace/can_messages.h"

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
    X(BRACE_CAN_ID_SPACE, space_6, stiffness_hz) \
    X(BRACE_CAN_ID_LOAD, load_0, load_hz) \
    X(BRACE_CAN_ID_LOAD, load_1, load_hz) \
    X(BRACE_CAN_ID_LOAD, load_2, load_hz) \
    X(BRACE_CAN_ID_LOAD, load_3, load_hz) \
    X(BRACE_CAN_ID_LOAD, load_4, load_hz) \
    X(BRACE_CAN_ID_LOAD_ACROSS, load_across_0, load_hz) \
    X(BRACE_CAN_ID_LOAD_ACROSS, load_across_1, load_hz)

#define BRACE_CAN_PROCESS_FD(X) \
    X(BRACE_CAN_ID_SNAPSHOT_FD, snapshot_fd, stiffness_hz) \
    X(BRACE_CAN_ID_SPACE_FD, space_fd, stiffness_hz) \
    X(BRACE_CAN_ID_LOAD_FD, load_fd, load_hz)

#define BRACE_CAN_BY_HAND(X) \
    X(BRACE_CAN_ID_EMERGENCY, emergency) \
    X(BRACE_CAN_ID_HEARTBEAT, heartbeat)

#endif
