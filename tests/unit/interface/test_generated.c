/* What the dictionary generates for C, as a controller uses it: lists of requests and messages, limits, codes. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "brace/backlash.h"
#include "brace/answering.h"
#include "brace/can_frames.h"
#include "brace/can_snapshot.h"
#include "brace/code_names.h"
#include "brace/codes.h"
#include "brace/drift.h"
#include "brace/parameters.h"
#include "brace/questions.h"
#include "brace/ranges.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

static void test_every_request_has_a_code_and_an_answer(void)
{
#define ROW(CODE, name) {CODE, #name},
    static const struct {
        uint32_t code;
        const char *name;
    } request[] = {BRACE_REQUESTS(ROW)};
#undef ROW
    bool seen[256] = {false};
    uint32_t frames = 0, numbers = 0;
    for (size_t i = 0; i < sizeof request / sizeof *request; i++) {
        TEST_ASSERT_TRUE_MESSAGE(request[i].code <= 255u, request[i].name);
        TEST_ASSERT_TRUE_MESSAGE(brace_can_answer_parts[request[i].code] >= 1u, request[i].name);
        TEST_ASSERT_FALSE_MESSAGE(seen[request[i].code], request[i].name);
        seen[request[i].code] = true;
        frames += brace_can_answer_parts[request[i].code];
    }
    for (uint32_t code = 0; code < 256u; code++) {
        TEST_ASSERT_EQUAL(seen[code], brace_can_answer_parts[code] != 0u);
    }
    for (uint32_t number = 0; number < 256u; number++) {
        const brace_can_answer_frame_t *is = &brace_can_answer_frames[number];
        numbers += is->parts > 0u;
        TEST_ASSERT_TRUE(is->parts == 0u || (is->part < is->parts && is->parts == brace_can_answer_parts[is->code]));
    }
    TEST_ASSERT_EQUAL(frames, numbers);
    TEST_ASSERT_EQUAL(0, brace_can_answer_frames[BRACE_ANSWER_REFUSED].parts);
}

static void test_every_message_has_a_rate_of_the_controller(void)
{
#define ROW(ID, name, rate, coxa) {ID, offsetof(brace_controller_t, rate), coxa},
    static const struct {
        uint32_t id;
        size_t rate;
        bool needs_coxa;
    } message[] = {BRACE_CAN_PROCESS(ROW)}, whole[] = {BRACE_CAN_PROCESS_FD(ROW)};
#undef ROW
    static const uint8_t frames_of_details[] = {
        7, /* space */
        6, /* load */
        2, /* load_across */
        2, /* sigma */
        4, /* sigma_space */
        4, /* interval */
        2, /* interval_across */
    };
    uint32_t details = 0, of_coxa = 0, wanted = 0;
    for (size_t i = 0; i < sizeof frames_of_details; i++) {
        wanted += frames_of_details[i];
    }
    for (size_t i = 0; i < sizeof message / sizeof *message; i++) {
        TEST_ASSERT_EQUAL_HEX32(0, message[i].id & 0x7fu);
        details += message[i].id == (uint32_t)BRACE_CAN_ID_DETAILS;
        of_coxa += message[i].needs_coxa;
    }
    TEST_ASSERT_EQUAL_MESSAGE(wanted, details,
                              "frames of details: the list frames_of_details of this file says how "
                              "many parts each group of messages.toml has");
    TEST_ASSERT_EQUAL_MESSAGE(7 + 2 + 4 + 2, of_coxa, "parts of the groups of messages.toml that have coxa = true");
    TEST_ASSERT_EQUAL_HEX32(BRACE_CAN_ID_DETAILS_FD, whole[1].id);
    TEST_ASSERT_EQUAL(offsetof(brace_controller_t, stiffness_hz), whole[1].rate);
    TEST_ASSERT_TRUE(whole[1].needs_coxa && !whole[0].needs_coxa);
}

static void test_limits_are_what_a_frame_can_carry(void)
{
    uint8_t data[8];
    brace_can_stiffness_a_t a = {.k_xx_n_per_mm = BRACE_CAN_STIFFNESS_A_K_XX_N_PER_MM_MOST,
                                 .k_xz_n_per_mm = -BRACE_CAN_STIFFNESS_A_K_XZ_N_PER_MM_MOST};
    TEST_ASSERT_EQUAL(0, brace_can_pack_stiffness_a(&a, data));
    a.k_xx_n_per_mm += 0.001f;
    a.k_xz_n_per_mm -= 0.001f;
    TEST_ASSERT_EQUAL(2, brace_can_pack_stiffness_a(&a, data));
    brace_can_eigenvalues_t e = {.lambda_min_n_per_mm = BRACE_CAN_EIGENVALUES_LAMBDA_MIN_N_PER_MM_MOST};
    TEST_ASSERT_EQUAL(0, brace_can_pack_eigenvalues(&e, data));
    e.lambda_min_n_per_mm += 0.001f;
    TEST_ASSERT_EQUAL(1, brace_can_pack_eigenvalues(&e, data));
    a = (brace_can_stiffness_a_t){.age_ms = BRACE_CAN_STIFFNESS_A_AGE_MS_MOST};
    TEST_ASSERT_EQUAL(0, brace_can_pack_stiffness_a(&a, data));
}

/* Flags as a frame made from measured values carries them. */
static uint32_t flags_in_plane(const brace_measured_t *measured)
{
    uint8_t data[8];
    brace_can_stiffness_b_t frame;
    brace_can_make_stiffness_b(measured, 0.0f, data);
    brace_can_unpack_stiffness_b(data, &frame);
    return frame.flags;
}

static uint32_t flags_in_space(const brace_measured_t *measured)
{
    uint8_t data[8];
    brace_can_space_4_t frame;
    brace_can_make_space_4(measured, 0.0f, data);
    brace_can_unpack_space_4(data, &frame);
    return frame.flags;
}

static void test_a_value_that_any_frame_of_the_snapshot_limits_is_flagged(void)
{
    brace_measured_t measured = {.flags = BRACE_FLAG_STALE, .space_flags = BRACE_FLAG_GAP_OPEN};
    const struct {
        float *value;
        float most;
        bool is_in_space;
    } reported[] = {
        {&measured.k_xx_n_per_mm, BRACE_CAN_STIFFNESS_A_K_XX_N_PER_MM_MOST, false},
        {&measured.k_xz_n_per_mm, BRACE_CAN_STIFFNESS_A_K_XZ_N_PER_MM_MOST, false},
        {&measured.k_zz_n_per_mm, BRACE_CAN_STIFFNESS_B_K_ZZ_N_PER_MM_MOST, false},
        {&measured.lambda_min_n_per_mm, BRACE_CAN_EIGENVALUES_LAMBDA_MIN_N_PER_MM_MOST, false},
        {&measured.lambda_max_n_per_mm, BRACE_CAN_EIGENVALUES_LAMBDA_MAX_N_PER_MM_MOST, false},
        {&measured.stiff_axis_rad, BRACE_CAN_EIGENVALUES_STIFF_AXIS_RAD_MOST, false},
        {&measured.space_k_xx_n_per_mm, BRACE_CAN_SPACE_0_K_XX_N_PER_MM_MOST, true},
        {&measured.space_k_xy_n_per_mm, BRACE_CAN_SPACE_0_K_XY_N_PER_MM_MOST, true},
        {&measured.space_k_xz_n_per_mm, BRACE_CAN_SPACE_1_K_XZ_N_PER_MM_MOST, true},
        {&measured.space_k_yy_n_per_mm, BRACE_CAN_SPACE_1_K_YY_N_PER_MM_MOST, true},
        {&measured.space_k_yz_n_per_mm, BRACE_CAN_SPACE_2_K_YZ_N_PER_MM_MOST, true},
        {&measured.space_k_zz_n_per_mm, BRACE_CAN_SPACE_2_K_ZZ_N_PER_MM_MOST, true},
        {&measured.space_lambda_3_n_per_mm, BRACE_CAN_SPACE_4_LAMBDA_3_N_PER_MM_MOST, true},
    };
    const uint32_t in_plane = BRACE_FLAG_STALE, in_space = BRACE_FLAG_GAP_OPEN, saturated = BRACE_FLAG_SATURATED;
    for (size_t i = 0; i < sizeof reported / sizeof *reported; i++) {
        *reported[i].value = reported[i].most;
        TEST_ASSERT_EQUAL_HEX32(in_plane, flags_in_plane(&measured));
        TEST_ASSERT_EQUAL_HEX32(in_space, flags_in_space(&measured));
        *reported[i].value = -1.001f * reported[i].most;
        TEST_ASSERT_EQUAL_HEX32(in_plane | (reported[i].is_in_space ? 0u : saturated), flags_in_plane(&measured));
        TEST_ASSERT_EQUAL_HEX32(in_space | (reported[i].is_in_space ? saturated : 0u), flags_in_space(&measured));
        *reported[i].value = NAN;
        TEST_ASSERT_EQUAL_HEX32(in_plane, flags_in_plane(&measured));
        TEST_ASSERT_EQUAL_HEX32(in_space, flags_in_space(&measured));
    }
}

static uint32_t flags_of_load(const brace_measured_t *measured)
{
    uint8_t data[8];
    brace_can_load_1_t frame;
    brace_can_make_load_1(measured, 0.0f, data);
    brace_can_unpack_load_1(data, &frame);
    return frame.flags;
}

static uint32_t flags_of_load_across(const brace_measured_t *measured)
{
    uint8_t data[8];
    brace_can_load_across_1_t frame;
    brace_can_make_load_across_1(measured, 0.0f, data);
    brace_can_unpack_load_across_1(data, &frame);
    return frame.flags;
}

static void test_a_value_that_any_frame_of_the_load_limits_is_flagged(void)
{
    brace_measured_t measured = {.flags = BRACE_FLAG_STALE, .space_flags = BRACE_FLAG_GAP_OPEN};
    const struct {
        float *value;
        float most;
        bool is_across;
    } reported[] = {
        {&measured.unloaded_k_xx_n_per_mm, BRACE_CAN_LOAD_0_UNLOADED_K_XX_N_PER_MM_MOST, false},
        {&measured.unloaded_k_xz_n_per_mm, BRACE_CAN_LOAD_0_UNLOADED_K_XZ_N_PER_MM_MOST, false},
        {&measured.unloaded_k_zz_n_per_mm, BRACE_CAN_LOAD_1_UNLOADED_K_ZZ_N_PER_MM_MOST, false},
        {&measured.gravity_lean_rad, BRACE_CAN_LOAD_5_GRAVITY_LEAN_RAD_MOST, false},
        {&measured.counted_force_x_n, BRACE_CAN_LOAD_2_COUNTED_FORCE_X_N_MOST, false},
        {&measured.counted_force_z_n, BRACE_CAN_LOAD_2_COUNTED_FORCE_Z_N_MOST, false},
        {&measured.moved_x_mm, BRACE_CAN_LOAD_3_MOVED_X_MM_MOST, false},
        {&measured.moved_z_mm, BRACE_CAN_LOAD_3_MOVED_Z_MM_MOST, false},
        {&measured.counted_force_y_n, BRACE_CAN_LOAD_ACROSS_0_COUNTED_FORCE_Y_N_MOST, true},
        {&measured.moved_y_mm, BRACE_CAN_LOAD_ACROSS_0_MOVED_Y_MM_MOST, true},
        {&measured.unloaded_k_across_n_per_mm, BRACE_CAN_LOAD_ACROSS_1_UNLOADED_K_ACROSS_N_PER_MM_MOST, true},
    };
    const uint32_t in_plane = BRACE_FLAG_STALE, across = BRACE_FLAG_GAP_OPEN, saturated = BRACE_FLAG_SATURATED;
    for (size_t i = 0; i < sizeof reported / sizeof *reported; i++) {
        *reported[i].value = -reported[i].most;
        TEST_ASSERT_EQUAL_HEX32(in_plane, flags_of_load(&measured));
        TEST_ASSERT_EQUAL_HEX32(across, flags_of_load_across(&measured));
        *reported[i].value = 1.001f * reported[i].most;
        TEST_ASSERT_EQUAL_HEX32(in_plane | (reported[i].is_across ? 0u : saturated), flags_of_load(&measured));
        TEST_ASSERT_EQUAL_HEX32(across | (reported[i].is_across ? saturated : 0u), flags_of_load_across(&measured));
        *reported[i].value = NAN;
    }
}

static void test_a_frame_carries_the_measured_values(void)
{
    uint8_t data[8];
    brace_can_stiffness_a_t a;
    brace_can_stiffness_b_t b;
    brace_can_posture_t posture;
    const brace_measured_t measured = {
        .sequence = 0x1234u, .play_tibia = UINT32_MAX, .parameter_crc = 0xabcdef01u, .flags = 0x8001u};
    brace_can_make_stiffness_a(&measured, 2.5f, data);
    brace_can_unpack_stiffness_a(data, &a);
    TEST_ASSERT_EQUAL_HEX32(0x34, a.sequence);
    TEST_ASSERT_EQUAL_FLOAT(2.5f, a.age_ms);
    brace_can_make_stiffness_b(&measured, 2.5f, data);
    brace_can_unpack_stiffness_b(data, &b);
    TEST_ASSERT_EQUAL_HEX32(0x8001, b.flags);
    TEST_ASSERT_EQUAL_HEX32(0xf, b.play_tibia);
    brace_can_make_posture(&measured, 2.5f, data);
    brace_can_unpack_posture(data, &posture);
    TEST_ASSERT_EQUAL_HEX32(0xef01, posture.parameter_tag);
}

/* An uncertainty never seems smaller than it is: beyond what its frame carries it is not known. */
static void test_an_uncertainty_that_is_too_large_is_not_known(void)
{
    uint8_t data[8];
    brace_measured_t measured = {0};
    float *const reported[] = {&measured.sigma_k_xx_n_per_mm, &measured.sigma_k_xz_n_per_mm,
                               &measured.sigma_k_zz_n_per_mm};
    for (uint32_t i = 0; i < 3u; i++) {
        brace_can_sigma_0_t frame;
        *reported[i] = BRACE_CAN_SIGMA_0_K_XX_N_PER_MM_MOST;
        brace_can_make_sigma_0(&measured, 0.0f, data);
        brace_can_unpack_sigma_0(data, &frame);
        const float *got[] = {&frame.k_xx_n_per_mm, &frame.k_xz_n_per_mm, &frame.k_zz_n_per_mm};
        TEST_ASSERT_FLOAT_WITHIN(0.001f, BRACE_CAN_SIGMA_0_K_XX_N_PER_MM_MOST, *got[i]);
        *reported[i] = i == 1u ? INFINITY : BRACE_CAN_SIGMA_0_K_XX_N_PER_MM_MOST + 0.01f;
        brace_can_make_sigma_0(&measured, 0.0f, data);
        brace_can_unpack_sigma_0(data, &frame);
        TEST_ASSERT_TRUE(isnan(*got[i]));
    }
}

/* Sixteen flags and thirty-two faults: each bit arrives in the bit that it left in. */
static void test_every_flag_and_every_fault_has_room(void)
{
    uint8_t data[64];
    for (uint32_t bit = 0; bit < 32u; bit++) {
        const brace_measured_t measured = {.flags = 1u << bit, .faults = 1u << bit};
        brace_can_snapshot_fd_t whole;
        brace_can_make_snapshot_fd(&measured, 0.0f, data);
        brace_can_unpack_snapshot_fd(data, &whole);
        TEST_ASSERT_EQUAL_HEX32(1u << bit, whole.faults);
        TEST_ASSERT_EQUAL_HEX32(bit < 16u ? 1u << bit : UINT16_MAX, whole.flags);
        brace_can_condition_t condition = {.faults = 1u << bit};
        TEST_ASSERT_EQUAL(0, brace_can_pack_condition(&condition, data));
        brace_can_unpack_condition(data, &condition);
        TEST_ASSERT_EQUAL_HEX32(1u << bit, condition.faults);
    }
}

static void test_an_answer_s_frames_carry_its_fields(void)
{
    uint8_t parts[BRACE_CAN_ANSWER_PARTS_MOST][8];
    brace_answer_t k = {
        .k_at_tip_knee_up = {
            .k_xx_n_per_mm = 12.5f, .lambda_min_n_per_mm = NAN, .stiff_axis_rad = -0.25f, .flags = BRACE_FLAG_STALE}};
    brace_can_k_at_tip_knee_up_answer_0_t first;
    brace_can_k_at_tip_knee_up_answer_1_t second;
    brace_can_k_at_tip_knee_up_answer_2_t third;
    brace_can_k_at_tip_knee_up_answer_3_t last;
    brace_can_pack_answer(BRACE_REQUEST_K_AT_TIP_KNEE_UP, &k, 0x1a5u, parts);
    for (uint32_t part = 0; part < 4u; part++) {
        TEST_ASSERT_EQUAL_HEX8(BRACE_K_AT_TIP_KNEE_UP_ANSWER_0 + part, parts[part][0]);
        TEST_ASSERT_EQUAL_HEX8(0xa5, parts[part][1]);
    }
    brace_can_unpack_k_at_tip_knee_up_answer_0(parts[0], &first);
    brace_can_unpack_k_at_tip_knee_up_answer_1(parts[1], &second);
    brace_can_unpack_k_at_tip_knee_up_answer_2(parts[2], &third);
    brace_can_unpack_k_at_tip_knee_up_answer_3(parts[3], &last);
    TEST_ASSERT_EQUAL_FLOAT(12.5f, first.k_xx_n_per_mm);
    TEST_ASSERT_TRUE(isnan(second.lambda_min_n_per_mm));
    TEST_ASSERT_EQUAL_FLOAT(-0.25f, third.stiff_axis_rad);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_STALE, last.flags);
    k.k_at_tip_knee_up.k_xz_n_per_mm = -1e6f; /* more than part 0 can carry */
    brace_can_pack_answer(BRACE_REQUEST_K_AT_TIP_KNEE_UP, &k, 0, parts);
    brace_can_unpack_k_at_tip_knee_up_answer_3(parts[3], &last);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_STALE | BRACE_FLAG_SATURATED, last.flags);
}

static void test_a_request_s_frame_carries_its_fields(void)
{
    const brace_can_take_up_request_t sent = {.token = 7, .joint = 2, .flank = -1};
    uint8_t data[8];
    brace_request_t asked;
    (void)brace_can_pack_take_up_request(&sent, data);
    brace_can_unpack_request(data, &asked);
    TEST_ASSERT_EQUAL(2, asked.take_up.joint);
    TEST_ASSERT_EQUAL(-1, asked.take_up.flank);
    data[0] = 0; /* there is none of this code */
    brace_can_unpack_request(data, &asked);
    TEST_ASSERT_EQUAL(0, asked.word[0]);
    TEST_ASSERT_EQUAL(0, asked.word[1]);
}

static uint32_t word_at(const void *values, uint32_t place)
{
    uint32_t word;
    memcpy(&word, (const uint8_t *)values + 4u * place, sizeof word);
    return word;
}

/* Which register reads as what: docs/modbus.md, and IEEE 754's quiet NaN. */
static void test_what_nobody_has_asked_is_not_known(void)
{
    enum {
        NOT_A_NUMBER = 0x7fc00000,
        FLAGS = (4108 - 4096) / 2,
        CONTACT = (4126 - 4096) / 2,
        KNEE = (16404 - 16384) / 2,
        LOADED_FLAGS = (4146 - 4096) / 2,
        LOADED_KNEE = (16438 - 16384) / 2,
        STOP = (16452 - 16384) / 2,
        SPACE_FLAGS = (4170 - 4096) / 2,
        SPACE_FORCE_IS_TOLD = (4172 - 4096) / 2
    };
    for (uint32_t i = 0; i < (uint32_t)BRACE_ANSWERED_COUNT; i++) {
        const bool is_whole =
            i == FLAGS || i == CONTACT || i == LOADED_FLAGS || i == SPACE_FLAGS || i == SPACE_FORCE_IS_TOLD;
        TEST_ASSERT_EQUAL_HEX32(is_whole ? UINT32_MAX : NOT_A_NUMBER, word_at(&brace_answered_unknown, i));
    }
    for (uint32_t i = 0; i < (uint32_t)BRACE_COMMANDS_COUNT; i++) {
        TEST_ASSERT_EQUAL_HEX32(i < 6u || i >= STOP             ? 0u
                                : i == KNEE || i == LOADED_KNEE ? UINT32_MAX
                                                                : NOT_A_NUMBER,
                                word_at(&brace_commands_unknown, i));
    }
}

/* An old reader takes the byte for one number, which is not 0 while any fault is there. */
static void test_an_emergency_reports_the_cause_of_a_drift(void)
{
    uint8_t data[8];
    const brace_can_emergency_t sent = {.error_code = 0xff01,
                                        .error_register = 1,
                                        .drift_cause = BRACE_DRIFT_CAUSE_FEMUR_JOINT_OR_BASE,
                                        .mode = BRACE_MODE_MONITOR,
                                        .faults = BRACE_FAULT_MODEL_DRIFT};
    TEST_ASSERT_EQUAL(0, brace_can_pack_emergency(&sent, data));
    TEST_ASSERT_EQUAL_HEX8(0x31, data[2]);
    brace_can_emergency_t read;
    brace_can_unpack_emergency(data, &read);
    TEST_ASSERT_EQUAL_MEMORY(&sent, &read, sizeof sent);
}

static void test_names_and_sentences(void)
{
    TEST_ASSERT_EQUAL_STRING("LOADING_TEST", brace_mode_name(BRACE_MODE_LOADING_TEST));
    TEST_ASSERT_EQUAL_STRING("SENSOR_COXA", brace_fault_name(9));
    TEST_ASSERT_EQUAL_STRING("TRAVEL", brace_take_up_outcome_name(BRACE_TAKEUP_E_TRAVEL));
    TEST_ASSERT_EQUAL_STRING("Inspect the femur link.",
                             brace_drift_next_step_text(BRACE_DRIFT_NEXT_INSPECT_FEMUR_LINK));
    TEST_ASSERT_EQUAL_STRING("?", brace_mode_name(-1));
    TEST_ASSERT_EQUAL_STRING("?", brace_flag_text(31));
}

/* The wire's cause is the core's plus one; its bits are the core's own. */
static void test_causes_of_a_drift_are_those_of_the_core(void)
{
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_FEMUR_LINK, BRACE_DRIFT_FEMUR + 1);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_TIBIA_LINK_OR_KNEE_JOINT, BRACE_DRIFT_TIBIA_OR_KNEE + 1);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_FEMUR_JOINT_OR_BASE, BRACE_DRIFT_FEMUR_JOINT_OR_BASE + 1);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_UNEXPLAINED, BRACE_DRIFT_UNEXPLAINED + 1);
    for (int32_t cause = BRACE_DRIFT_FEMUR; cause <= BRACE_DRIFT_UNEXPLAINED; cause++) {
        TEST_ASSERT_EQUAL_STRING(brace_drift_cause_name(cause + 1), brace_drift_could_be_name(cause));
    }
}

static void test_ranges_of_the_limb_are_in_its_order(void)
{
#define ROW(member, least, most) {offsetof(brace_limb_t, member), least, most},
    static const struct {
        size_t offset;
        float least, most;
    } range[] = {BRACE_LIMB_RANGES(ROW)};
#undef ROW
    TEST_ASSERT_EQUAL(sizeof(brace_limb_t), 4u * (sizeof range / sizeof *range));
    for (size_t i = 0; i < sizeof range / sizeof *range; i++) {
        TEST_ASSERT_EQUAL(4u * i, range[i].offset);
        TEST_ASSERT_TRUE(range[i].least < range[i].most);
        uint32_t word;
        const float beyond = nextafterf(range[i].most, INFINITY);
        memcpy(&word, &range[i].most, 4);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_parameter_in_range((uint32_t)i, word));
        memcpy(&word, &beyond, 4);
        TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_parameter_in_range((uint32_t)i, word));
    }
    TEST_ASSERT_TRUE(BRACE_RANGE_JOINT_GAP_RAD_MIN >= 0.0f && BRACE_RANGE_JOINT_GAP_RAD_MAX <= 0.5f);
}

/* A question over Modbus writes the fields of its request, those of the request that is asked before, and which of two
 * requests it is; its answer's values follow one another. Each command that is not known at first belongs to one
 * question, and each value of an answer to one at least. */
static void test_a_question_is_its_request_s_fields(void)
{
#define ROW(CODE, name) [CODE] = {sizeof(brace_##name##_request_t) / 4u, sizeof(brace_##name##_answer_t) / 4u},
    static const struct {
        uint32_t asked, answered;
    } values_of[256] = {BRACE_REQUESTS(ROW)};
#undef ROW
    enum { COMMANDS = sizeof(brace_commands_t) / 4, ANSWERS = sizeof(brace_answered_t) / 4 };
    uint32_t questions_of[COMMANDS] = {0}, answers_of[ANSWERS] = {0};
    for (uint32_t q = 0; q < (uint32_t)BRACE_QUESTION_COUNT; q++) {
        const brace_question_t *question = &brace_questions[q];
        const bool picks = question->codes > 1u;
        TEST_ASSERT_TRUE(question->codes == 1u || question->codes == 2u);
        TEST_ASSERT_EQUAL(picks, question->code[1] != 0u);
        if (picks) { /* 0: the knee points up */
            const bool is_loaded = question->code[0] == BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP;
            const uint32_t plain[] = {BRACE_REQUEST_K_AT_TIP_KNEE_UP, BRACE_REQUEST_K_AT_TIP_KNEE_DOWN};
            const uint32_t loaded[] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP,
                                       BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN};
            for (int i = 0; i < 2; i++) {
                TEST_ASSERT_EQUAL(is_loaded ? loaded[i] : plain[i], question->code[i]);
            }
        }
        for (uint32_t o = 0; o < q; o++) { /* answers lie in the same values, or in others */
            const brace_question_t *other = &brace_questions[o];
            TEST_ASSERT_TRUE(other->answer_first == question->answer_first ||
                             other->answer_first >= question->answer_first + question->answer_count ||
                             question->answer_first >= other->answer_first + other->answer_count);
        }
        for (uint32_t i = 0; i < question->codes; i++) {
            TEST_ASSERT_EQUAL(values_of[question->code[i]].asked, question->fields);
            TEST_ASSERT_EQUAL(values_of[question->code[i]].answered, question->answer_count);
        }
        TEST_ASSERT_EQUAL(question->begin_code != 0u ? values_of[question->begin_code].asked : 0u,
                          question->begin_fields);
        TEST_ASSERT_EQUAL(question->begin_fields + question->fields + picks, question->count);
        for (uint32_t i = 0; i < question->count; i++) {
            TEST_ASSERT_LESS_THAN(COMMANDS, question->first + i);
            questions_of[question->first + i]++;
        }
        for (uint32_t i = 0; i < question->answer_count; i++) {
            TEST_ASSERT_LESS_THAN(ANSWERS, question->answer_first + i);
            answers_of[question->answer_first + i]++;
        }
    }
    for (uint32_t i = 0; i < COMMANDS; i++) {
        uint32_t word;
        memcpy(&word, (const uint8_t *)&brace_commands_unknown + 4u * i, sizeof word);
        TEST_ASSERT_EQUAL(word != 0u, questions_of[i]);
    }
    for (uint32_t i = 0; i < ANSWERS; i++) {
        TEST_ASSERT_GREATER_THAN(0, answers_of[i]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_request_has_a_code_and_an_answer);
    RUN_TEST(test_every_message_has_a_rate_of_the_controller);
    RUN_TEST(test_limits_are_what_a_frame_can_carry);
    RUN_TEST(test_a_value_that_any_frame_of_the_snapshot_limits_is_flagged);
    RUN_TEST(test_a_value_that_any_frame_of_the_load_limits_is_flagged);
    RUN_TEST(test_a_frame_carries_the_measured_values);
    RUN_TEST(test_an_uncertainty_that_is_too_large_is_not_known);
    RUN_TEST(test_every_flag_and_every_fault_has_room);
    RUN_TEST(test_an_answer_s_frames_carry_its_fields);
    RUN_TEST(test_a_request_s_frame_carries_its_fields);
    RUN_TEST(test_what_nobody_has_asked_is_not_known);
    RUN_TEST(test_an_emergency_reports_the_cause_of_a_drift);
    RUN_TEST(test_names_and_sentences);
    RUN_TEST(test_causes_of_a_drift_are_those_of_the_core);
    RUN_TEST(test_ranges_of_the_limb_are_in_its_order);
    RUN_TEST(test_a_question_is_its_request_s_fields);
    return UNITY_END();
}
