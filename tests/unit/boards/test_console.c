/* The console as a person uses it: words, questions, a self-test that moves nothing, a key. What echoes do to it:
 * test_console_echo.c. */
#include "console_board.h"

#define KEY "000102030405060708090a0b0c0d0e0f"

static brace_parameters_t with_play(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_FEMUR].gap_rad = p.limb.joint[BRACE_TIBIA].gap_rad = 0.01f;
    return p;
}

/* A motor follows its set-point, and its load rises behind the gap. */
static void play(void *user, brace_fake_t *board, int32_t joint)
{
    (void)user;
    brace_fake_joint_t *ours = &board->joint[joint];
    const float beyond = ours->command.offset_rad - 0.005f;
    ours->sample.motor_rad = (joint == BRACE_FEMUR ? 1.0f : 1.4f) + ours->command.offset_rad;
    ours->sample.torque_n_mm = beyond > 0.0f ? fminf(1e6f * beyond, 4000.0f) : 0.0f;
}

static brace_parameters_t in_store;

void setUp(void)
{
    in_store = with_play();
    console_board(&in_store, SILENT);
    board_starts();
    passes_ms(200u, 1u);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    forget_said();
}

void tearDown(void) {}

static void take_up_and_hold(void)
{
    passes_ms(200u, 1u);
    fake.play = play;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_FEMUR, 1));
    for (uint32_t i = 0; i < 10000u && now()->play[BRACE_FEMUR].phase != BRACE_TAKEUP_HOLD; i++) {
        passes_ms(1u, 1u);
    }
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[BRACE_FEMUR].phase);
    TEST_ASSERT_TRUE(fake.joint[BRACE_FEMUR].command.offset_rad > 0.005f);
}

static void assert_nothing_happened(void)
{
    TEST_ASSERT_EQUAL_UINT32(0u, fake.calls[BRACE_FAKE_RESTART]);
    TEST_ASSERT_NULL(strstr(said, "selftest"));
    TEST_ASSERT_EQUAL_UINT32(1u, fake.calls[BRACE_FAKE_NVM_ERASE]); /* the test's own set */
}

static void test_words_answer(void)
{
    person_types("k\r");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# k: valid k_xx_n_per_mm "), said);
    person_types("banner\n");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# brace 9.9.9 (0123456789ab, Test) on fake\r\n"), said);
    person_types("  help \r\n");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# restart: starts the processor anew\r\n"), said);
    forget_said();
    person_types("?\r");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# bench: "), said);
    assert_nothing_happened();
}

/* Whatever is printed begins with the prefix. */
static void test_every_line_has_its_prefix(void)
{
    static const char *const all[] = {"help\r", "k\r", "banner\r", "restart\r", "no\r", "what is this\r", "key\r"};
    for (uint32_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        person_types(all[i]);
    }
    for (const char *at = said; *at != '\0'; at = strchr(at, '\n') + 1) {
        TEST_ASSERT_TRUE_MESSAGE(strncmp(at, "# ", 2) == 0 || strncmp(at, "\r\n", 2) == 0, at);
    }
}

/* The letters of an older console, and every other character. */
static void test_no_single_character_changes_anything(void)
{
    for (uint32_t byte = 0; byte < 256u; byte++) {
        const char line[] = {(char)byte, '\r', '\0'};
        if (byte != (uint32_t)'#' && byte != 0u) {
            far_end_types(line);
            passes_ms(20u, 10u);
            TEST_ASSERT_NULL_MESSAGE(strstr(said, "sure?"), said);
        }
    }
    assert_nothing_happened();
}

static const char *const changing[] = {"restart\r", "test\r", "test slot\r", "test drives\r"};

static void test_what_changes_something_asks_first(void)
{
    for (uint32_t i = 0; i < sizeof changing / sizeof changing[0]; i++) {
        forget_said();
        person_types(changing[i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "sure? type these four digits"), said);
        assert_nothing_happened();
        person_types("yes\r");
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "nothing is changed"), said);
        assert_nothing_happened();
    }
}

static void test_only_the_digits_of_this_question_are_its_answer(void)
{
    char old[6], digits[6];
    person_types("restart\r");
    read_digits(old);
    person_types("no\r");
    person_types("restart\r");
    read_digits(digits);
    TEST_ASSERT_NOT_EQUAL(0, strcmp(old, digits));
    person_types(old);
    assert_nothing_happened();
    person_types(digits); /* its question is over */
    assert_nothing_happened();
    person_types("restart\r");
    person_confirms();
    TEST_ASSERT_EQUAL_UINT32(1u, fake.calls[BRACE_FAKE_RESTART]);
}

static void test_a_question_ends_after_30_s(void)
{
    person_types("restart\r");
    char digits[6];
    read_digits(digits);
    passes_ms(30000u, 100u);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "no answer in 30 s"), said);
    person_types(digits);
    assert_nothing_happened();
}

static void test_the_crash_is_forgotten_when_confirmed(void)
{
    fake.crashed = true;
    person_types("forget\r");
    TEST_ASSERT_TRUE(fake.crashed);
    person_confirms();
    TEST_ASSERT_FALSE(fake.crashed);
}

static void test_a_partial_line_waits(void)
{
    far_end_types("k");
    for (uint32_t hours = 0; hours < 3u; hours++) {
        passes_ms(3600u, 100u);
        fake.now_us += 3600000000u - 3600000u; /* the clock wraps */
    }
    TEST_ASSERT_EQUAL_STRING("", said);
    person_types("\r");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# k: "), said);
}

static void test_keys_that_take_back(void)
{
    static const char *const lines[] = {"kx\b\r", "\b\bxy\x7f\x7fk\r", "restart\x03k\r", "rest\x15k\r", "\tk\t\r"};
    for (uint32_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        forget_said();
        person_types(lines[i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# k: "), lines[i]);
        TEST_ASSERT_EQUAL_UINT32(1u, count_of("# "));
    }
}

static void test_a_line_that_is_too_long_is_dropped_with_one_message(void)
{
    for (uint32_t i = 0; i < 1000u; i++) {
        far_end_types("restart ");
        passes_ms(2u, 10u);
    }
    TEST_ASSERT_EQUAL_STRING("", said);
    person_types("\r");
    TEST_ASSERT_EQUAL_UINT32(1u, count_of("# "));
    person_types("k\r");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# k: "), said);
    assert_nothing_happened();
}

static uint32_t running_clock(void *context)
{
    (void)context;
    fake.now_us++;
    return fake.now_us;
}

/* From here on each look at the clock takes a microsecond, as the self-test needs it. */
static void clock_runs(void)
{
    fake.hal.now_us = running_clock;
}

static void test_the_self_test_runs_when_confirmed_and_moves_nothing(void)
{
    clock_runs();
    const uint32_t commands = fake.calls[BRACE_FAKE_JOINT_COMMAND];
    person_types("test\r");
    person_confirms();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "selftest: pass joint_read(1)"), said);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "selftest: note joint_command: not tried"), said);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "selftest: note nvm_write: not tried"), said);
    TEST_ASSERT_EQUAL_UINT32(1u, fake.calls[BRACE_FAKE_RESTART]);
    TEST_ASSERT_EQUAL_UINT32(commands, fake.calls[BRACE_FAKE_JOINT_COMMAND]);
    TEST_ASSERT_EQUAL_UINT32(1u, fake.calls[BRACE_FAKE_NVM_ERASE]);
}

/* A joint that is held, is moved, stands after a stop, or is on its way back: no word of the self-test begins. */
static void refused_while_it_moves(void)
{
    const float offset_rad = fake.joint[BRACE_FEMUR].command.offset_rad;
    for (uint32_t i = 1; i < sizeof changing / sizeof changing[0]; i++) {
        forget_said();
        far_end_types(changing[i]);
        passes_ms(10u, 1u);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# not now: a joint moves or is held"), said);
        TEST_ASSERT_NULL_MESSAGE(strstr(said, "sure?"), said);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.004f, offset_rad, fake.joint[BRACE_FEMUR].command.offset_rad); /* 30 ms at 0.1 rad/s */
}

static void test_no_self_test_begins_while_a_joint_moves_or_is_held(void)
{
    take_up_and_hold();
    refused_while_it_moves();
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_stop(&app));
    passes_ms(100u, 1u);
    refused_while_it_moves();
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_let_go(&app));
    passes_ms(10u, 1u);
    refused_while_it_moves();
    passes_ms(2000u, 1u);
    forget_said();
    person_types("test\r");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "sure?"), said);
    assert_nothing_happened();
}

static void test_what_begins_behind_the_question_stops_the_self_test(void)
{
    person_types("test slot\r");
    char digits[6];
    read_digits(digits);
    take_up_and_hold();
    forget_said();
    far_end_types(digits);
    passes_ms(50u, 1u);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# not now: a joint moves or is held"), said);
    assert_nothing_happened();
}

/* A restart is possible, and says what becomes of a joint that is held. */
static void test_a_restart_says_that_a_joint_is_held(void)
{
    take_up_and_hold();
    far_end_types("restart\r");
    passes_ms(50u, 1u);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "a joint moves or is held by this controller"), said);
    assert_nothing_happened();
}

static void test_no_self_test_begins_in_configuration(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    passes_ms(50u, 1u);
    for (uint32_t i = 1; i < sizeof changing / sizeof changing[0]; i++) {
        forget_said();
        person_types(changing[i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# not now: parameters are being written"), said);
    }
    assert_nothing_happened();
}

static void test_the_slot_test_leaves_the_set_in_force(void)
{
    clock_runs();
    const brace_parameter_origin_t origin = now()->parameter_origin;
    const uint32_t in_force = origin == BRACE_PARAMETERS_SLOT_B ? 1u : 0u, crc = now()->parameter_crc;
    TEST_ASSERT_NOT_EQUAL(BRACE_PARAMETERS_DEFAULT, origin);
    static uint8_t before[BRACE_FAKE_SLOT_BYTES];
    memcpy(before, fake.nvm[in_force], sizeof before);
    person_types("test slot\r");
    const char *const named = in_force == 1u ? "parameter slot A is erased" : "parameter slot B is erased";
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, named), said);
    person_confirms();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "selftest: pass nvm_erase: the other slot stays as it is"), said);
    TEST_ASSERT_EQUAL_MEMORY(before, fake.nvm[in_force], sizeof before);
    TEST_ASSERT_EACH_EQUAL_HEX8(0xff, fake.nvm[1u - in_force], BRACE_FAKE_SLOT_BYTES);
    board_starts();
    passes_ms(100u, 1u);
    TEST_ASSERT_EQUAL(origin, now()->parameter_origin);
    TEST_ASSERT_EQUAL_HEX32(crc, now()->parameter_crc);
}

/* Else the next start would find the older set alone, and believe it without a flag. */
static void test_the_slot_of_a_set_that_was_lost_is_not_erased(void)
{
    brace_parameters_t newer = in_store;
    newer.controller.age_limit_us += 1000u;
    bench_store(&newer);
    board_starts();
    passes_ms(100u, 1u);
    const uint32_t slot = now()->parameter_origin == BRACE_PARAMETERS_SLOT_B ? 1u : 0u;
    fake.nvm[slot][100] ^= 4u;
    board_starts();
    passes_ms(100u, 1u);
    TEST_ASSERT_BITS(BRACE_FAULT_OLD_PARAMETERS, BRACE_FAULT_OLD_PARAMETERS, now()->faults);
    const uint32_t erases = fake.calls[BRACE_FAKE_NVM_ERASE];
    forget_said();
    person_types("test slot\r");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# not now: OLD_PARAMETERS stands"), said);
    TEST_ASSERT_NULL_MESSAGE(strstr(said, "sure?"), said);
    TEST_ASSERT_EQUAL_UINT32(erases, fake.calls[BRACE_FAKE_NVM_ERASE]);
}

static void test_drives_are_asked_on_a_bench_alone(void)
{
    clock_runs();
    person_types("test drives\r");
    person_confirms();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "selftest: pass joint_command: no offset is accepted"), said);
    brace_fake_guarded(&fake, (const uint8_t[BRACE_HAL_KEY_BYTES]){9});
    board_starts();
    passes_ms(100u, 1u);
    forget_said();
    person_types("test drives\r");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# not now: drives are tested on a bench only"), said);
}

static void guarded_starts(const uint8_t *key)
{
    brace_fake_guarded(&fake, key);
    forget_said();
    board_starts();
    passes_ms(100u, 1u);
}

static void test_a_guarded_board_becomes_a_bench_when_confirmed(void)
{
    guarded_starts((const uint8_t[BRACE_HAL_KEY_BYTES]){9});
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# key: kept, and its memory is locked\r\n"), said);
    person_types("bench\r");
    TEST_ASSERT_EQUAL(BRACE_SETTING_GUARDED, brace_app_setting(&app));
    person_confirms();
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, brace_app_setting(&app));
    board_starts();
    TEST_ASSERT_EQUAL(BRACE_SETTING_GUARDED, brace_app_setting(&app));
}

static int32_t found_key;

static int32_t find_key(void *context, uint8_t key[BRACE_HAL_KEY_BYTES])
{
    (void)context;
    (void)key;
    return found_key;
}

/* Whatever is no whole key is none: the board refuses motion, and says why. */
static void test_a_damaged_key_is_none(void)
{
    static const struct {
        int32_t found;
        brace_setting_t setting;
        const char *words;
    } all[] = {
        {BRACE_HAL_KEY_LOCKED, BRACE_SETTING_GUARDED, "# key: kept, and its memory is locked\r\n"},
        {BRACE_HAL_KEY_OPEN, BRACE_SETTING_GUARDED, "# key: kept, but its memory is not locked"},
        {BRACE_HAL_KEY_NONE, BRACE_SETTING_NO_KEY, "# key: none yet"},
        {BRACE_HAL_E_DAMAGED, BRACE_SETTING_NO_KEY, "# key: none: its memory holds a piece of one"},
        {BRACE_HAL_E_DEVICE, BRACE_SETTING_NO_KEY, "# key: its memory does not answer"},
    };
    for (uint32_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        brace_fake_guarded(&fake, NULL);
        fake.hal.key_read = find_key;
        found_key = all[i].found;
        forget_said();
        board_starts();
        passes_ms(100u, 1u);
        TEST_ASSERT_EQUAL_MESSAGE(all[i].setting, brace_app_setting(&app), all[i].words);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, all[i].words), said);
    }
}

static void test_a_key_is_typed_in_two_lines(void)
{
    guarded_starts(NULL);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# key: none yet"), said);
    person_types("key\r");
    person_types(KEY "\r"); /* no answer to the question */
    TEST_ASSERT_FALSE(fake.has_key);
    person_types("key\r");
    person_confirms();
    person_types(KEY "\r");
    person_types(KEY "\r");
    TEST_ASSERT_TRUE(fake.has_key);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# key: kept, and its memory is locked."), said);
    TEST_ASSERT_NULL_MESSAGE(strstr(said, "0e0f"), said);
    TEST_ASSERT_EACH_EQUAL_HEX8(0, console.typed.line, sizeof console.typed.line);
}

static void test_a_key_is_not_taken_from_a_terminal_that_echoes(void)
{
    guarded_starts(NULL);
    person_types("key\r");
    person_confirms();
    far_end = LINUX_TERMINAL; /* somebody else opens the port between the two lines */
    person_types(KEY "\r");
    person_types(KEY "\r");
    TEST_ASSERT_FALSE(fake.has_key);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "a key is not taken from it"), said);
    setUp();
    guarded_starts(NULL);
    person_types("key\r");
    char digits[6];
    read_digits(digits);
    far_end = LINUX_TERMINAL;
    person_types(digits);
    person_types(KEY "\r");
    person_types(KEY "\r");
    TEST_ASSERT_FALSE(fake.has_key);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "a key is not taken from it"), said);
}

static void test_a_key_that_nobody_types_is_not_waited_for_for_ever(void)
{
    guarded_starts(NULL);
    person_types("key\r");
    person_confirms();
    passes_ms(120000u, 1000u);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "nobody typed it for 120 s"), said);
    person_types(KEY "\r");
    person_types(KEY "\r");
    TEST_ASSERT_FALSE(fake.has_key);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_words_answer);
    RUN_TEST(test_every_line_has_its_prefix);
    RUN_TEST(test_no_single_character_changes_anything);
    RUN_TEST(test_what_changes_something_asks_first);
    RUN_TEST(test_only_the_digits_of_this_question_are_its_answer);
    RUN_TEST(test_a_question_ends_after_30_s);
    RUN_TEST(test_the_crash_is_forgotten_when_confirmed);
    RUN_TEST(test_a_partial_line_waits);
    RUN_TEST(test_keys_that_take_back);
    RUN_TEST(test_a_line_that_is_too_long_is_dropped_with_one_message);
    RUN_TEST(test_the_self_test_runs_when_confirmed_and_moves_nothing);
    RUN_TEST(test_no_self_test_begins_while_a_joint_moves_or_is_held);
    RUN_TEST(test_what_begins_behind_the_question_stops_the_self_test);
    RUN_TEST(test_a_restart_says_that_a_joint_is_held);
    RUN_TEST(test_no_self_test_begins_in_configuration);
    RUN_TEST(test_the_slot_test_leaves_the_set_in_force);
    RUN_TEST(test_the_slot_of_a_set_that_was_lost_is_not_erased);
    RUN_TEST(test_drives_are_asked_on_a_bench_alone);
    RUN_TEST(test_a_guarded_board_becomes_a_bench_when_confirmed);
    RUN_TEST(test_a_damaged_key_is_none);
    RUN_TEST(test_a_key_is_typed_in_two_lines);
    RUN_TEST(test_a_key_is_not_taken_from_a_terminal_that_echoes);
    RUN_TEST(test_a_key_that_nobody_types_is_not_waited_for_for_ever);
    return UNITY_END();
}
