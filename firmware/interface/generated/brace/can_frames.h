/* Written by tools/interface from messages.toml; do not edit. */
#ifndef BRACE_CAN_FRAMES_H
#define BRACE_CAN_FRAMES_H

/* Every message of messages.toml, as lists for the preprocessor. A controller makes its tables from them, so a new
 * message needs no hand-written line.
 *
 * BRACE_CAN_PROCESS(X)     X(identifier, name, rate, coxa): classic frames of measured values, name as in
 *                          brace_can_make_<name>; rate is the member of brace_controller_t that says how often; coxa is
 *                          1 where only a limb whose coxa joint is fitted sends the frame, else 0. Each part of a
 *                          multiplexed message stands by itself, in order.
 * BRACE_CAN_PROCESS_FD(X)  the same of CAN FD
 * BRACE_CAN_BY_HAND(X)     X(identifier, name): classic frames that hand-written code fills and sends
 * BRACE_CAN_FRAMES(X)      X(name, bytes): every frame there is, requests and answers too; name as in
 *                          brace_can_pack_<name>
 */
#include "brace/can_messages.h"

#define BRACE_CAN_PROCESS(X) \
    X(BRACE_CAN_ID_STIFFNESS_A, stiffness_a, stiffness_hz, 0) \
    X(BRACE_CAN_ID_STIFFNESS_B, stiffness_b, stiffness_hz, 0) \
    X(BRACE_CAN_ID_EIGENVALUES, eigenvalues, posture_hz, 0) \
    X(BRACE_CAN_ID_POSTURE, posture, posture_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, space_0, stiffness_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, space_1, stiffness_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, space_2, stiffness_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, space_3, stiffness_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, space_4, stiffness_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, space_5, stiffness_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, space_6, stiffness_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, load_0, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, load_1, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, load_2, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, load_3, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, load_4, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, load_5, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, load_across_0, load_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, load_across_1, load_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, sigma_0, sigma_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, sigma_1, sigma_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, sigma_space_0, sigma_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, sigma_space_1, sigma_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, sigma_space_2, sigma_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, sigma_space_3, sigma_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, interval_0, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, interval_1, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, interval_2, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, interval_3, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS, interval_across_0, load_hz, 1) \
    X(BRACE_CAN_ID_DETAILS, interval_across_1, load_hz, 1)

#define BRACE_CAN_PROCESS_FD(X) \
    X(BRACE_CAN_ID_SNAPSHOT_FD, snapshot_fd, stiffness_hz, 0) \
    X(BRACE_CAN_ID_DETAILS_FD, space_fd, stiffness_hz, 1) \
    X(BRACE_CAN_ID_DETAILS_FD, load_fd, load_hz, 0) \
    X(BRACE_CAN_ID_DETAILS_FD, sigma_fd, sigma_hz, 0) \
    X(BRACE_CAN_ID_DETAILS_FD, interval_fd, load_hz, 0)

#define BRACE_CAN_BY_HAND(X) \
    X(BRACE_CAN_ID_EMERGENCY, emergency) \
    X(BRACE_CAN_ID_HEARTBEAT, heartbeat) \
    X(BRACE_CAN_ID_DETAILS, condition)

#define BRACE_CAN_FRAMES(X) \
    X(emergency, 8) \
    X(stiffness_a, 8) \
    X(stiffness_b, 8) \
    X(eigenvalues, 8) \
    X(posture, 8) \
    X(heartbeat, 8) \
    X(condition, 8) \
    X(space_0, 8) \
    X(space_1, 8) \
    X(space_2, 8) \
    X(space_3, 8) \
    X(space_4, 8) \
    X(space_5, 8) \
    X(space_6, 8) \
    X(load_0, 8) \
    X(load_1, 8) \
    X(load_2, 8) \
    X(load_3, 8) \
    X(load_4, 8) \
    X(load_5, 8) \
    X(load_across_0, 8) \
    X(load_across_1, 8) \
    X(sigma_0, 8) \
    X(sigma_1, 8) \
    X(sigma_space_0, 8) \
    X(sigma_space_1, 8) \
    X(sigma_space_2, 8) \
    X(sigma_space_3, 8) \
    X(interval_0, 8) \
    X(interval_1, 8) \
    X(interval_2, 8) \
    X(interval_3, 8) \
    X(interval_across_0, 8) \
    X(interval_across_1, 8) \
    X(snapshot_fd, 64) \
    X(space_fd, 64) \
    X(load_fd, 64) \
    X(sigma_fd, 64) \
    X(interval_fd, 64) \
    X(read_entry_request, 8) \
    X(read_entry_answer_0, 8) \
    X(write_entry_request, 8) \
    X(write_entry_answer_0, 8) \
    X(k_at_posture_request, 8) \
    X(k_at_posture_answer_0, 8) \
    X(k_at_posture_answer_1, 8) \
    X(k_at_posture_answer_2, 8) \
    X(k_at_posture_answer_3, 8) \
    X(k_at_tip_knee_up_request, 8) \
    X(k_at_tip_knee_up_answer_0, 8) \
    X(k_at_tip_knee_up_answer_1, 8) \
    X(k_at_tip_knee_up_answer_2, 8) \
    X(k_at_tip_knee_up_answer_3, 8) \
    X(k_at_tip_knee_down_request, 8) \
    X(k_at_tip_knee_down_answer_0, 8) \
    X(k_at_tip_knee_down_answer_1, 8) \
    X(k_at_tip_knee_down_answer_2, 8) \
    X(k_at_tip_knee_down_answer_3, 8) \
    X(contact_force_request, 8) \
    X(contact_force_answer_0, 8) \
    X(contact_force_answer_1, 8) \
    X(sag_for_load_request, 8) \
    X(sag_for_load_answer_0, 8) \
    X(friction_margin_request, 8) \
    X(friction_margin_answer_0, 8) \
    X(set_mode_request, 8) \
    X(set_mode_answer_0, 8) \
    X(upload_begin_request, 8) \
    X(upload_begin_answer_0, 8) \
    X(upload_word_request, 8) \
    X(upload_word_answer_0, 8) \
    X(commit_request, 8) \
    X(commit_answer_0, 8) \
    X(commit_answer_1, 8) \
    X(rollback_request, 8) \
    X(rollback_answer_0, 8) \
    X(rollback_answer_1, 8) \
    X(download_word_request, 8) \
    X(download_word_answer_0, 8) \
    X(take_up_request, 8) \
    X(take_up_answer_0, 8) \
    X(let_go_request, 8) \
    X(let_go_answer_0, 8) \
    X(loading_test_start_request, 8) \
    X(loading_test_start_answer_0, 8) \
    X(loading_test_stop_request, 8) \
    X(loading_test_stop_answer_0, 8) \
    X(fetch_row_request, 8) \
    X(fetch_row_answer_0, 8) \
    X(identify_request, 8) \
    X(identify_answer_0, 8) \
    X(identify_answer_1, 8) \
    X(identify_answer_2, 8) \
    X(identify_answer_3, 8) \
    X(identify_answer_4, 8) \
    X(loading_test_result_request, 8) \
    X(loading_test_result_answer_0, 8) \
    X(clear_request, 8) \
    X(clear_answer_0, 8) \
    X(k_in_space_at_posture_request, 8) \
    X(k_in_space_at_posture_answer_0, 8) \
    X(k_in_space_at_posture_answer_1, 8) \
    X(k_in_space_at_posture_answer_2, 8) \
    X(k_in_space_at_posture_answer_3, 8) \
    X(k_in_space_at_posture_answer_4, 8) \
    X(k_in_space_at_posture_answer_5, 8) \
    X(drift_request, 8) \
    X(drift_answer_0, 8) \
    X(drift_answer_1, 8) \
    X(drift_answer_2, 8) \
    X(take_up_result_request, 8) \
    X(take_up_result_answer_0, 8) \
    X(set_gravity_request, 8) \
    X(set_gravity_answer_0, 8) \
    X(tip_force_request, 8) \
    X(tip_force_answer_0, 8) \
    X(k_under_load_at_posture_request, 8) \
    X(k_under_load_at_posture_answer_0, 8) \
    X(k_under_load_at_posture_answer_1, 8) \
    X(k_under_load_at_posture_answer_2, 8) \
    X(k_under_load_at_posture_answer_3, 8) \
    X(k_under_load_at_posture_answer_4, 8) \
    X(k_under_load_at_tip_knee_up_request, 8) \
    X(k_under_load_at_tip_knee_up_answer_0, 8) \
    X(k_under_load_at_tip_knee_up_answer_1, 8) \
    X(k_under_load_at_tip_knee_up_answer_2, 8) \
    X(k_under_load_at_tip_knee_up_answer_3, 8) \
    X(k_under_load_at_tip_knee_up_answer_4, 8) \
    X(k_under_load_at_tip_knee_down_request, 8) \
    X(k_under_load_at_tip_knee_down_answer_0, 8) \
    X(k_under_load_at_tip_knee_down_answer_1, 8) \
    X(k_under_load_at_tip_knee_down_answer_2, 8) \
    X(k_under_load_at_tip_knee_down_answer_3, 8) \
    X(k_under_load_at_tip_knee_down_answer_4, 8) \
    X(tip_force_in_space_request, 8) \
    X(tip_force_in_space_answer_0, 8) \
    X(sign_of_life_request, 8) \
    X(sign_of_life_answer_0, 8) \
    X(refusal, 8)

#endif
