/* On a bench everybody may command. What needs no intent does not move the limb all the same: stray, late and doubled
 * frames, two masters, a master that dies. And on any board: what an owner itself may not write. */
#include "attack.h"

static const uint8_t other_token = 0x51; /* of another master on the same bus */

void setUp(void)
{
    start_limb(false, NULL);
}

void tearDown(void)
{
    operator_lives = false;
}

static float offset_rad(int joint)
{
    return fake.joint[joint].command.offset_rad;
}

static void says_as(uint8_t token, uint8_t data[8])
{
    data[1] = token;
    says(data);
}

static int32_t status_of(const answer_t *answer)
{
    brace_can_refusal_t refusal = {0};
    TEST_ASSERT_TRUE(answer->count > 0);
    if (!is_refusal(answer->part[0])) {
        return BRACE_OK;
    }
    brace_can_unpack_refusal(answer->part[0], &refusal);
    return refusal.status;
}

static uint32_t silences(void)
{
    brace_session_report_t report;
    brace_app_session(&app, &report);
    return report.silences;
}

/* ----------------------------------------------------------------------------- stray, late, doubled -- */

/* A motion begins with a sign of life: a frame that nobody stands behind moves nothing. */
static void test_a_stray_command_moves_nothing(void)
{
    uint8_t data[8];
    for (int which = 0; which < 2; which++) {
        make_take_up(BRACE_FEMUR, data);
        if (which == 1) {
            const brace_can_loading_test_start_request_t asked = {0, 0, 2, 0.5f, 20};
            brace_can_pack_loading_test_start_request(&asked, data);
        }
        const uint32_t before = silences();
        const answer_t answer = command(data);
        TEST_ASSERT_EQUAL(BRACE_OK, status_of(&answer)); /* commands are open, */
        for (int i = 0; i < 400; i++) {
            ticks(1);
            TEST_ASSERT_EQUAL_FLOAT(0.0f, offset_rad(BRACE_FEMUR));
            TEST_ASSERT_EQUAL_FLOAT(0.0f, offset_rad(BRACE_TIBIA));
        }
        TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode); /* and taken back */
        TEST_ASSERT_EQUAL(before + 1u, silences());
    }
    begin_to_move();
}

static void hold_the_femur(void)
{
    begin_to_move();
    for (int i = 0; i < 5000 && now()->play[BRACE_FEMUR].phase != BRACE_TAKEUP_HOLD; i++) {
        pass(1);
    }
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[BRACE_FEMUR].phase);
    drain();
}

/* What was taken up stays so without its master; a late let_go, or a late take-up of the other joint, changes
 * nothing. */
static void test_late_commands_move_nothing(void)
{
    uint8_t data[8];
    hold_the_femur();
    operator_lives = false;
    ticks(1000);
    TEST_ASSERT_EQUAL(0, silences()); /* nothing moved when it went */
    const float held_rad = offset_rad(BRACE_FEMUR);
    for (int which = 0; which < 3; which++) {
        make_let_go(data);
        if (which == 1) {
            make_take_up(BRACE_TIBIA, data);
        } else if (which == 2) {
            const brace_can_loading_test_start_request_t asked = {0, 0, 2, 0.5f, 20};
            brace_can_pack_loading_test_start_request(&asked, data);
        }
        says_as(OPERATOR_TOKEN, data);
        ticks(500);
        TEST_ASSERT_EQUAL_FLOAT(held_rad, offset_rad(BRACE_FEMUR));
        TEST_ASSERT_EQUAL_FLOAT(0.0f, offset_rad(BRACE_TIBIA));
        TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[BRACE_FEMUR].phase);
        TEST_ASSERT_EQUAL((uint32_t)which + 1u, silences());
        drain();
    }
    operator_lives = true; /* its master comes back, and lets go */
    make_let_go(data);
    accepted_command(data);
    pass(1000);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

static void test_doubled_commands_are_one(void)
{
    uint8_t data[8];
    begin_to_move();
    make_take_up(BRACE_FEMUR, data);
    for (int i = 0; i < 5; i++) {
        const float before_rad = offset_rad(BRACE_FEMUR);
        const answer_t answer = command(data);
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, status_of(&answer));
        TEST_ASSERT_TRUE(offset_rad(BRACE_FEMUR) > before_rad);
    }
}

/* ---------------------------------------------------------------------------------------- two masters -- */

static void test_a_second_master_is_refused_while_the_first_moves_the_limb(void)
{
    uint8_t data[8];
    begin_to_move();
    for (int which = 0; which < 4; which++) {
        make_let_go(data);
        if (which == 1) {
            make_take_up(BRACE_TIBIA, data);
        } else if (which == 2) {
            const brace_can_loading_test_start_request_t asked = {0, 0, 2, 0.5f, 20};
            brace_can_pack_loading_test_start_request(&asked, data);
        } else if (which == 3) {
            make_sign(NULL, number_now(), 0, data);
        }
        const state_t before = state_now();
        says_as(other_token, data);
        pass(5);
        TEST_ASSERT_EQUAL(1, refusals_reported());
        const state_t after = state_now();
        TEST_ASSERT_EQUAL(before.refused + 1u, after.refused);
        TEST_ASSERT_TRUE(after.offset_rad[BRACE_FEMUR] > before.offset_rad[BRACE_FEMUR]);
        TEST_ASSERT_EQUAL_FLOAT(0.0f, after.offset_rad[BRACE_TIBIA]);
    }
    const uint32_t value[] = {1};
    TEST_ASSERT_EQUAL(7, write_values(COMMAND_REGISTER(let_go), value, 1).byte[1]); /* another port */
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
}

/* But its stop counts. */
static void test_a_second_master_may_stop_the_limb(void)
{
    uint8_t data[8];
    begin_to_move();
    const uint32_t value[] = {1};
    TEST_ASSERT_EQUAL(5, write_values(COMMAND_REGISTER(stop), value, 1).count);
    const float stood_rad = offset_rad(BRACE_FEMUR);
    pass(2000);
    TEST_ASSERT_EQUAL_FLOAT(stood_rad, offset_rad(BRACE_FEMUR));
    drain();
    TEST_ASSERT_EQUAL(1, read_entry(ENTRY(is_held)));
    make_let_go(data);
    accepted_command(data);
    pass(1000);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

/* Another's signs of life, and another's questions, keep nobody alive. */
static void test_a_second_master_does_not_keep_the_first_alive(void)
{
    uint8_t data[8];
    begin_to_move();
    operator_lives = false;
    const float before_rad = offset_rad(BRACE_FEMUR);
    for (int i = 0; i < 300; i++) {
        if (i % 20 == 0) {
            make_sign(NULL, number_now(), 0, data);
            says_as(other_token, data);
        }
        if (i % 20 == 10) {
            brace_can_pack_read_entry_request(&(brace_can_read_entry_request_t){OPERATOR_TOKEN, ENTRY(mode)}, data);
            says(data);
        }
        ticks(1);
        drain();
    }
    TEST_ASSERT_TRUE(offset_rad(BRACE_FEMUR) - before_rad < 0.1f * 0.15f);
    TEST_ASSERT_EQUAL(1, silences());
}

/* --------------------------------------------------------------------------------- a master that dies -- */

/* Within 150 ms of the last sign of life the set-points stand; they are held, not let go. */
static void stands_within_150_ms(void)
{
    float last_rad[BRACE_LINK_COUNT];
    int stood_ms = 0;
    sign_of_life(); /* the last one */
    ticks(1);
    operator_lives = false;
    memset(last_rad, 0, sizeof last_rad);
    for (int ms = 1; ms <= 1000; ms++) {
        bool moves = false;
        ticks(1);
        drain();
        for (int i = 0; i < BRACE_LINK_COUNT; i++) {
            moves = moves || offset_rad(i) != last_rad[i];
            last_rad[i] = offset_rad(i);
            TEST_ASSERT_TRUE(fake.joint[i].sample.taken_us == fake.now_us || i == BRACE_COXA);
        }
        stood_ms = moves ? ms : stood_ms;
        /* and commanded again and again */
        TEST_ASSERT_TRUE(fake.now_us - fake.joint[BRACE_FEMUR].commanded_us < 100000u);
    }
    TEST_ASSERT_TRUE(stood_ms <= 150);
    TEST_ASSERT_TRUE(offset_rad(BRACE_FEMUR) != 0.0f);
    TEST_ASSERT_EQUAL(1, silences());
}

static void test_a_master_that_dies_while_play_is_taken_up(void)
{
    begin_to_move();
    stands_within_150_ms();
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
}

static void begin_a_test(void)
{
    uint8_t data[8];
    hold_the_femur();
    make_take_up(BRACE_TIBIA, data);
    accepted_command(data);
    for (int i = 0; i < 5000 && now()->play[BRACE_TIBIA].phase != BRACE_TAKEUP_HOLD; i++) {
        pass(1);
    }
    brace_can_pack_loading_test_start_request(&(brace_can_loading_test_start_request_t){0, 0, 2, 0.5f, 20}, data);
    accepted_command(data);
    pass(200);
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, now()->mode);
    TEST_ASSERT_EQUAL(BRACE_LOADING_RUNNING, brace_app_loading_result(&app)->outcome);
    drain();
}

static void test_a_master_that_dies_in_a_loading_test(void)
{
    uint8_t data[8];
    begin_a_test();
    stands_within_150_ms();
    TEST_ASSERT_EQUAL(BRACE_LOADING_STOPPED, brace_app_loading_result(&app)->outcome);
    operator_lives = true; /* end_test: back to where it began; the play stays taken up */
    make_write(COMMAND_ENTRY(end_test), 1, 0, data);
    accepted_command(data);
    pass(4000);
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[BRACE_FEMUR].phase);
}

static void test_bus_off_stops_the_limb(void)
{
    begin_to_move();
    fake.can_health.bus_off = true;
    const float before_rad = offset_rad(BRACE_FEMUR);
    operator_lives = false;
    ticks(150);
    const float stood_rad = offset_rad(BRACE_FEMUR);
    TEST_ASSERT_TRUE(stood_rad - before_rad < 0.1f * 0.15f);
    ticks(6000);
    TEST_ASSERT_EQUAL_FLOAT(stood_rad, offset_rad(BRACE_FEMUR));
}

/* A sign of life by Modbus TCP, with the number that the registers show. */
static reply_t lives_by_tcp(void)
{
    const uint32_t number = sign_now().heard;
    const uint8_t life[14] = {16,
                              0x40,
                              0x48,
                              0,
                              4,
                              8,
                              (uint8_t)(number >> 24),
                              (uint8_t)(number >> 16),
                              (uint8_t)(number >> 8),
                              (uint8_t)number};
    return tcp_asks(UNIT, life, 14);
}

static void test_a_closed_connection_stops_the_limb(void)
{
    uint8_t asks[10] = {16, 0x40, 0x08, 0, 2, 4, 0, 0, 1, 1};
    fake.peer = 7;
    TEST_ASSERT_EQUAL(5, tcp_asks(UNIT, asks, 10).count);
    TEST_ASSERT_EQUAL(5, lives_by_tcp().count);
    ticks(30);
    TEST_ASSERT_TRUE(offset_rad(BRACE_FEMUR) > 0.0f);
    fake.open_from = 8;
    ticks(150);
    const float stood_rad = offset_rad(BRACE_FEMUR);
    ticks(1000);
    TEST_ASSERT_EQUAL_FLOAT(stood_rad, offset_rad(BRACE_FEMUR));
    TEST_ASSERT_EQUAL(1, silences());
}

/* Connections are those of Modbus TCP: of a master on CAN none can close. */
static void test_a_closed_connection_is_nothing_to_a_master_on_can(void)
{
    begin_to_move();
    fake.open_from = 1000; /* every connection of Modbus TCP has been closed */
    pass(300);
    TEST_ASSERT_EQUAL(0, silences());
    TEST_ASSERT_TRUE(now()->play[BRACE_FEMUR].phase != BRACE_TAKEUP_IDLE);
    brace_session_report_t report;
    brace_app_session(&app, &report);
    TEST_ASSERT_EQUAL(BRACE_OWNER_CAN, report.owner);
}

/* By hand each write has a connection of its own: the next one goes on for the one that has closed, and for no
 * other. */
static void test_connections_by_hand_follow_one_another(void)
{
    const uint8_t asks[10] = {16, 0x40, 0x08, 0, 2, 4, 0, 0, 1, 1};
    fake.peer = 1;
    TEST_ASSERT_EQUAL(5, tcp_asks(UNIT, asks, 10).count);
    for (uint32_t peer = 2; peer < 30u; peer++) {
        fake.peer = fake.open_from = peer;
        TEST_ASSERT_EQUAL(5, lives_by_tcp().count);
        ticks(40);
    }
    TEST_ASSERT_TRUE(offset_rad(BRACE_FEMUR) > 0.5f * GAP_RAD);
    fake.peer = 30; /* while 29 is still there */
    const reply_t reply = lives_by_tcp();
    TEST_ASSERT_EQUAL(2, reply.count);
    TEST_ASSERT_EQUAL(7, reply.byte[1]);
}

static void test_letting_go_afterwards_is_a_parameter(void)
{
    app.controller.parameters.in_force.controller.let_go_after_ms = 500;
    app.controller.parameters.comes_in_force = true; /* so the guard takes it for what was meant */
    app.controller.configure_part = BRACE_LINK_COUNT + 3;
    ticks(5);
    begin_to_move();
    operator_lives = false;
    ticks(600);
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
    ticks(1000);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, offset_rad(BRACE_FEMUR));
}

/* ------------------------------------------------------------------------------------ what is written -- */

static void configure(void)
{
    uint8_t data[8];
    make_set_mode(BRACE_MODE_CONFIGURATION, data);
    accepted_command(data);
}

/* A second master's value is refused by another port, and does not go in by the same one where the commit names its
 * set. */
static void test_a_stranger_s_value_does_not_go_in_with_the_operator_s_commit(void)
{
    uint8_t data[8];
    brace_parameters_t meant = *brace_app_parameters(&app);
    meant.limb.femur_mm = 190.0f;
    configure();
    stage(1, bits(190.0f));
    const uint32_t value[] = {bits(7.9f)};
    TEST_ASSERT_EQUAL(7, write_values(2, value, 1).byte[1]);
    make_write(brace_parameter_number(BRACE_PARAMETER_CONTROLLER_AGE_LIMIT_US), 50000, other_token, data);
    says(data); /* another node's, on the same bus */
    ticks(5);
    drain();
    make_commit(brace_parameters_crc(&meant), data);
    says_as(OPERATOR_TOKEN, data);
    ticks(400);
    drain();
    TEST_ASSERT_EQUAL_FLOAT(185.0f, brace_app_parameters(&app)->limb.femur_mm);
    brace_session_report_t report;
    brace_app_session(&app, &report);
    TEST_ASSERT_EQUAL(0, report.erases);
    stage(brace_parameter_number(BRACE_PARAMETER_CONTROLLER_AGE_LIMIT_US), 20000); /* as it was meant */
    says_as(OPERATOR_TOKEN, data);
    ticks(400);
    TEST_ASSERT_EQUAL_FLOAT(190.0f, brace_app_parameters(&app)->limb.femur_mm);
}

/* By register too, with nothing staged even. */
static void test_a_commit_by_register_names_its_set(void)
{
    uint32_t value[] = {0xc0de0002};
    TEST_ASSERT_EQUAL(5, write_values(COMMAND_REGISTER(set_mode), value, 1).count);
    value[0] = 0; /* names none */
    TEST_ASSERT_EQUAL(2, write_values(COMMAND_REGISTER(commit_crc), value, 1).count);
    value[0] = 0x12345678;
    TEST_ASSERT_EQUAL(5, write_values(COMMAND_REGISTER(commit_crc), value, 1).count);
    ticks(400);
    reply_t reply = read_asks(3, COMMAND_REGISTER(commit_crc), 2);
    TEST_ASSERT_EQUAL(256 + (int)BRACE_STORE_E_REFUSED, value_at(&reply, 0));
    value[0] = bits(190.0f);
    TEST_ASSERT_EQUAL(5, write_values(2, value, 1).count);
    brace_parameters_t meant = *brace_app_parameters(&app);
    meant.limb.femur_mm = 190.0f;
    value[0] = brace_parameters_crc(&meant);
    TEST_ASSERT_EQUAL(5, write_values(COMMAND_REGISTER(commit_crc), value, 1).count);
    ticks(400);
    reply = read_asks(3, COMMAND_REGISTER(commit_crc), 2);
    TEST_ASSERT_EQUAL(0, value_at(&reply, 0));
    TEST_ASSERT_EQUAL_FLOAT(190.0f, brace_app_parameters(&app)->limb.femur_mm);
}

static void test_seventy_commits_erase_once(void)
{
    uint8_t data[8];
    uint32_t taken = 0, early = 0;
    configure();
    for (uint32_t i = 0; i < 70u; i++) {
        stage(1, bits(190.0f + (float)i));
        make_commit(0, data);
        data[1] = OPERATOR_TOKEN;
        answer_t answer = ask_within(data, 113);
        const int32_t status = status_of(&answer);
        taken += status == BRACE_OK;
        early += status == BRACE_REFUSED_EARLY;
        ticks(113 - 1);
        drain();
    }
    brace_session_report_t report;
    brace_app_session(&app, &report);
    TEST_ASSERT_TRUE(report.erases <= 2u);
    TEST_ASSERT_TRUE(taken <= 2u);
    TEST_ASSERT_EQUAL(70u - taken, early);
    TEST_ASSERT_EQUAL(early, report.commits_refused);
    TEST_ASSERT_EQUAL(report.erases, read_entry(ENTRY(erases)));
}

static void refused_at_commit(uint32_t number, uint32_t value)
{
    uint8_t data[8];
    configure();
    stage(number, value);
    make_commit(0, data);
    const answer_t answer = command(data);
    brace_can_refusal_t refusal;
    TEST_ASSERT_EQUAL(BRACE_REFUSED_CEILING, status_of(&answer));
    brace_can_unpack_refusal(answer.part[0], &refusal);
    TEST_ASSERT_EQUAL(number, refusal.detail);
    make_set_mode(BRACE_MODE_MONITOR, data);
    accepted_command(data);
    pass(30);
}

static void test_no_parameter_passes_the_board_s_ceilings(void)
{
    static const brace_hal_ceiling_t ceiling[3] = {
        {12000.0f, -2.5f, 3.2f, 0.2f}, {12000.0f, -2.5f, 3.2f, 0.2f}, {12000.0f, -2.5f, 3.2f, 0.2f}};
    fake.hal.ceiling = ceiling;
    refused_at_commit(brace_parameter_number(BRACE_PARAMETER_CONTROLLER_NODE_ID), 0);
    for (uint32_t i = 0; i < 3u; i++) {
        const uint32_t words_each = (uint32_t)sizeof(brace_drive_t) / 4u;
        const uint32_t first = (uint32_t)offsetof(brace_parameters_t, drive) / 4u + i * words_each;
        refused_at_commit(brace_parameter_number(first + offsetof(brace_drive_t, torque_range_n_mm) / 4u), bits(1e6f));
        refused_at_commit(brace_parameter_number(first + offsetof(brace_drive_t, angle_max_rad) / 4u), bits(3.3f));
        refused_at_commit(brace_parameter_number(first + offsetof(brace_drive_t, angle_min_rad) / 4u), bits(-2.6f));
    }
    TEST_ASSERT_EQUAL(5, brace_app_parameters(&app)->controller.node_id);
}

/* A set that was stored before the board's file was written: the drives are commanded no more than the board allows. */
static void test_drives_are_commanded_no_more_than_the_board_allows(void)
{
    static const brace_hal_ceiling_t ceiling[3] = {
        {900.0f, -2.5f, 3.2f, 0.05f}, {900.0f, -2.5f, 3.2f, 0.05f}, {900.0f, -2.5f, 3.2f, 0.05f}};
    fake.hal.ceiling = ceiling;
    begin_to_move();
    float last_rad = offset_rad(BRACE_FEMUR);
    for (int i = 0; i < 300; i++) {
        pass(1);
        TEST_ASSERT_TRUE(offset_rad(BRACE_FEMUR) - last_rad <= 0.05f * 1e-3f * 1.001f);
        TEST_ASSERT_TRUE(fake.joint[BRACE_FEMUR].command.torque_limit_n_mm <= 900.0f);
        last_rad = offset_rad(BRACE_FEMUR);
    }
}

/* Slower than a take-up's own pace, so that the drives are behind what the take-up asks for. */
static const brace_hal_ceiling_t slow_ceiling[3] = {
    {900.0f, -2.5f, 3.2f, 0.02f}, {900.0f, -2.5f, 3.2f, 0.02f}, {900.0f, -2.5f, 3.2f, 0.02f}};

static void goes_on_within_the_slow_ceiling(int count)
{
    float last_rad = offset_rad(BRACE_FEMUR);
    for (int i = 0; i < count; i++) {
        pass(1);
        TEST_ASSERT_TRUE(fabsf(offset_rad(BRACE_FEMUR) - last_rad) <= 0.02f * 1e-3f * 1.001f);
        last_rad = offset_rad(BRACE_FEMUR);
    }
}

/* The way back is the firmware's, too, to its end. */
static void test_the_way_back_is_no_faster_than_the_board_allows(void)
{
    uint8_t data[8];
    fake.hal.ceiling = slow_ceiling;
    begin_to_move();
    goes_on_within_the_slow_ceiling(200);
    const float reached_rad = offset_rad(BRACE_FEMUR);
    TEST_ASSERT_TRUE(reached_rad > 0.003f);
    make_let_go(data);
    accepted_command(data);
    TEST_ASSERT_TRUE(reached_rad - offset_rad(BRACE_FEMUR) < 5.0f * 0.02f * 1e-3f);
    goes_on_within_the_slow_ceiling(1000);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, offset_rad(BRACE_FEMUR));
    TEST_ASSERT_TRUE(isinf(fake.joint[BRACE_FEMUR].command.torque_limit_n_mm));
}

/* Whoever stops the limb stops it where it is, not where the take-up wanted it. */
static void test_a_drive_that_is_behind_stands_too(void)
{
    uint8_t data[8];
    for (int which = 0; which < 2; which++) {
        start_limb(false, NULL);
        fake.hal.ceiling = slow_ceiling;
        begin_to_move();
        goes_on_within_the_slow_ceiling(50);
        if (which == 0) {
            operator_lives = false; /* 130 ms, and the last sign of life may be 40 ms old */
            goes_on_within_the_slow_ceiling(140);
        } else {
            make_write(COMMAND_ENTRY(stop), 0, 0, data);
            says_as(other_token, data);
            pass(2);
        }
        const float stopped_rad = offset_rad(BRACE_FEMUR);
        for (int i = 0; i < 500; i++) {
            pass(1);
            TEST_ASSERT_EQUAL_FLOAT(stopped_rad, offset_rad(BRACE_FEMUR));
        }
    }
}

/* A bit of RAM flips while play is held: the set is made anew, the take-up with it; the limb goes back at its pace. */
static void test_a_flipped_bit_makes_no_jump(void)
{
    uint8_t data[8];
    hold_the_femur();
    const float held_rad = offset_rad(BRACE_FEMUR);
    app.controller.parameters.in_force.limb.femur_mm += 8.0f;
    float last_rad = held_rad;
    for (int i = 0; i < 1000; i++) {
        pass(1);
        TEST_ASSERT_TRUE(fabsf(offset_rad(BRACE_FEMUR) - last_rad) <= 1.001e-4f);
        last_rad = offset_rad(BRACE_FEMUR);
    }
    TEST_ASSERT_TRUE(held_rad > 0.005f);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, last_rad);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    make_set_mode(BRACE_MODE_CONFIGURATION, data);
    accepted_command(data);
}

static void test_every_heartbeat_and_answer_says_bench(void)
{
    uint8_t data[8];
    configure();
    make_set_mode(BRACE_MODE_MONITOR, data);
    answer_t answer = command(data);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.part[0][3]);
    pass(20);
    make_take_up(BRACE_FEMUR, data);
    answer = command(data);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.part[0][3]);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, read_entry(ENTRY(setting)));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_stray_command_moves_nothing);
    RUN_TEST(test_late_commands_move_nothing);
    RUN_TEST(test_doubled_commands_are_one);
    RUN_TEST(test_a_second_master_is_refused_while_the_first_moves_the_limb);
    RUN_TEST(test_a_second_master_may_stop_the_limb);
    RUN_TEST(test_a_second_master_does_not_keep_the_first_alive);
    RUN_TEST(test_a_master_that_dies_while_play_is_taken_up);
    RUN_TEST(test_a_master_that_dies_in_a_loading_test);
    RUN_TEST(test_bus_off_stops_the_limb);
    RUN_TEST(test_a_closed_connection_stops_the_limb);
    RUN_TEST(test_a_closed_connection_is_nothing_to_a_master_on_can);
    RUN_TEST(test_connections_by_hand_follow_one_another);
    RUN_TEST(test_letting_go_afterwards_is_a_parameter);
    RUN_TEST(test_a_stranger_s_value_does_not_go_in_with_the_operator_s_commit);
    RUN_TEST(test_a_commit_by_register_names_its_set);
    RUN_TEST(test_seventy_commits_erase_once);
    RUN_TEST(test_no_parameter_passes_the_board_s_ceilings);
    RUN_TEST(test_drives_are_commanded_no_more_than_the_board_allows);
    RUN_TEST(test_the_way_back_is_no_faster_than_the_board_allows);
    RUN_TEST(test_a_drive_that_is_behind_stands_too);
    RUN_TEST(test_a_flipped_bit_makes_no_jump);
    RUN_TEST(test_every_heartbeat_and_answer_says_bench);
    return UNITY_END();
}
