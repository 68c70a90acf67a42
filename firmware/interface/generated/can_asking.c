/* Written by tools/interface from messages.toml; do not edit. */
#include "brace/answering.h"

#include "can_bits.h"

void brace_can_unpack_request(const uint8_t data[8], brace_request_t *asked)
{
    const uint64_t bits = brace_bits_load(data);
    *asked = (brace_request_t){.word = {0}};
    switch (data[0]) {
    case BRACE_REQUEST_READ_ENTRY:
        asked->read_entry.index = brace_value_number(bits, 16u, 16u);
        break;
    case BRACE_REQUEST_WRITE_ENTRY:
        asked->write_entry.index = brace_value_number(bits, 16u, 16u);
        asked->write_entry.value = brace_value_number(bits, 32u, 32u);
        break;
    case BRACE_REQUEST_K_AT_POSTURE:
        asked->k_at_posture.theta1_rad = brace_value_signed(bits, 16u, 24u, 1e-06f);
        asked->k_at_posture.theta2_rad = brace_value_signed(bits, 40u, 24u, 1e-06f);
        break;
    case BRACE_REQUEST_K_AT_TIP_KNEE_UP:
        asked->k_at_tip_knee_up.x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
        asked->k_at_tip_knee_up.z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
        break;
    case BRACE_REQUEST_K_AT_TIP_KNEE_DOWN:
        asked->k_at_tip_knee_down.x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
        asked->k_at_tip_knee_down.z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
        break;
    case BRACE_REQUEST_CONTACT_FORCE:
        asked->contact_force.dx_mm = brace_value_signed(bits, 16u, 24u, 0.0001f);
        asked->contact_force.dz_mm = brace_value_signed(bits, 40u, 24u, 0.0001f);
        break;
    case BRACE_REQUEST_SAG_FOR_LOAD:
        asked->sag_for_load.fx_n = brace_value_signed(bits, 16u, 24u, 0.001f);
        asked->sag_for_load.fz_n = brace_value_signed(bits, 40u, 24u, 0.001f);
        break;
    case BRACE_REQUEST_FRICTION_MARGIN:
        asked->friction_margin.normal_rad = brace_value_signed(bits, 16u, 16u, 0.0001f);
        asked->friction_margin.friction_ratio = brace_value_unsigned(bits, 32u, 16u, 0.001f);
        break;
    case BRACE_REQUEST_SET_MODE:
        asked->set_mode.mode = brace_value_number(bits, 16u, 8u);
        asked->set_mode.key = brace_value_number(bits, 24u, 16u);
        break;
    case BRACE_REQUEST_UPLOAD_BEGIN:
        asked->upload_begin.bytes = brace_value_number(bits, 16u, 16u);
        asked->upload_begin.crc = brace_value_number(bits, 32u, 32u);
        break;
    case BRACE_REQUEST_UPLOAD_WORD:
        asked->upload_word.word = brace_value_number(bits, 16u, 16u);
        asked->upload_word.data = brace_value_number(bits, 32u, 32u);
        break;
    case BRACE_REQUEST_COMMIT:
        asked->commit.crc = brace_value_number(bits, 16u, 32u);
        break;
    case BRACE_REQUEST_DOWNLOAD_WORD:
        asked->download_word.word = brace_value_number(bits, 16u, 16u);
        break;
    case BRACE_REQUEST_TAKE_UP:
        asked->take_up.joint = brace_value_number(bits, 16u, 8u);
        asked->take_up.flank = brace_value_whole(bits, 24u, 8u);
        break;
    case BRACE_REQUEST_LOADING_TEST_START:
        asked->loading_test_start.axis = brace_value_number(bits, 16u, 8u);
        asked->loading_test_start.steps_per_side = brace_value_number(bits, 24u, 8u);
        asked->loading_test_start.step_mm = brace_value_unsigned(bits, 32u, 16u, 0.001f);
        asked->loading_test_start.dwell_ms = brace_value_number(bits, 48u, 16u);
        break;
    case BRACE_REQUEST_FETCH_ROW:
        asked->fetch_row.row = brace_value_number(bits, 16u, 16u);
        asked->fetch_row.column = brace_value_number(bits, 32u, 8u);
        break;
    case BRACE_REQUEST_LOADING_TEST_RESULT:
        asked->loading_test_result.item = brace_value_number(bits, 16u, 8u);
        break;
    case BRACE_REQUEST_CLEAR:
        asked->clear.faults = brace_value_number(bits, 16u, 32u);
        break;
    case BRACE_REQUEST_K_IN_SPACE_AT_POSTURE:
        asked->k_in_space_at_posture.theta0_rad = brace_value_signed(bits, 16u, 16u, 0.0001f);
        asked->k_in_space_at_posture.theta1_rad = brace_value_signed(bits, 32u, 16u, 0.0001f);
        asked->k_in_space_at_posture.theta2_rad = brace_value_signed(bits, 48u, 16u, 0.0001f);
        break;
    case BRACE_REQUEST_TAKE_UP_RESULT:
        asked->take_up_result.joint = brace_value_number(bits, 16u, 8u);
        break;
    case BRACE_REQUEST_SET_GRAVITY:
        asked->set_gravity.direction_rad = brace_value_signed(bits, 16u, 24u, 1e-06f);
        asked->set_gravity.lean_rad = brace_value_signed(bits, 40u, 24u, 1e-06f);
        break;
    case BRACE_REQUEST_TIP_FORCE:
        asked->tip_force.fx_n = brace_value_signed(bits, 16u, 24u, 0.001f);
        asked->tip_force.fz_n = brace_value_signed(bits, 40u, 24u, 0.001f);
        break;
    case BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE:
        asked->k_under_load_at_posture.theta1_rad = brace_value_signed(bits, 16u, 24u, 1e-06f);
        asked->k_under_load_at_posture.theta2_rad = brace_value_signed(bits, 40u, 24u, 1e-06f);
        break;
    case BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP:
        asked->k_under_load_at_tip_knee_up.x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
        asked->k_under_load_at_tip_knee_up.z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
        break;
    case BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN:
        asked->k_under_load_at_tip_knee_down.x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
        asked->k_under_load_at_tip_knee_down.z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
        break;
    case BRACE_REQUEST_TIP_FORCE_IN_SPACE:
        asked->tip_force_in_space.fx_n = brace_value_signed(bits, 16u, 16u, 0.01f);
        asked->tip_force_in_space.fy_n = brace_value_signed(bits, 32u, 16u, 0.01f);
        asked->tip_force_in_space.fz_n = brace_value_signed(bits, 48u, 16u, 0.01f);
        break;
    case BRACE_REQUEST_SIGN_OF_LIFE:
        asked->sign_of_life.heard = brace_value_number(bits, 16u, 16u);
        asked->sign_of_life.check = brace_value_number(bits, 32u, 32u);
        break;
    default: break;
    }
}
