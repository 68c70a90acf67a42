/* The console at terminals that echo, at other machines, in noise: nothing restarts, nothing is written, no self-test
 * begins, no setting changes, and it falls silent. */
#include "console_board.h"

/* A minute of simulated time on a host; an emulated processor, which takes long for it, plays a tenth. */
enum { PLAYED_MS = ON_BOARD ? 6000 : 60000, TICK_EVERY_MS = ON_BOARD ? 200 : 20 };

static uint8_t memory_before[BRACE_NVM_SLOT_COUNT][BRACE_FAKE_SLOT_BYTES];
static brace_parameters_t in_store;
static const uint8_t the_key[BRACE_HAL_KEY_BYTES] = {9};

static const char *const words[] = {"help", "?",         "k",           "banner", "forget", "restart",
                                    "test", "test slot", "test drives", "key",    "bench"};
enum { WORDS = sizeof words / sizeof words[0] };

static void start_at(far_end_t at_the_end)
{
    in_store = bench_parameters();
    console_board(&in_store, at_the_end);
    brace_fake_guarded(&fake, the_key);
    fake.crashed = true;
    board_starts();
    memcpy(memory_before, fake.nvm, sizeof memory_before);
}

void setUp(void)
{
    draw = 1u;
}

void tearDown(void) {}

static void assert_nothing_changed(const char *which)
{
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0u, fake.calls[BRACE_FAKE_RESTART], which);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1u, fake.calls[BRACE_FAKE_NVM_ERASE], which); /* the test's own set */
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(memory_before, fake.nvm, sizeof memory_before, which);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0u, fake.calls[BRACE_FAKE_JOINT_COMMAND], which);
    TEST_ASSERT_NULL_MESSAGE(strstr(said, "selftest"), which);
    TEST_ASSERT_EQUAL_MESSAGE(BRACE_SETTING_GUARDED, brace_app_setting(&app), which);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(the_key, fake.key, sizeof the_key, which);
    TEST_ASSERT_TRUE_MESSAGE(fake.crashed, which);
}

/* The banner comes back, and nobody types: it says so once, and is silent. */
static void test_a_terminal_that_echoes_changes_nothing_and_is_reported_once(void)
{
    for (uint32_t end = LINUX_TERMINAL; end < FAR_ENDS; end++) {
        char which[24];
        snprintf(which, sizeof which, "far end %u", (unsigned)end);
        start_at((far_end_t)end);
        passes_ms(5000u, TICK_EVERY_MS);
        const uint32_t begun = said_count;
        passes_ms(PLAYED_MS, TICK_EVERY_MS);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(begun, said_count, which);
        /* LOGIN's prompt stands before what it sends back: there each line is a strange one */
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(end == LOGIN ? 0u : 1u, count_of("this terminal echoes"), which);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(1u, count_of("# brace 9.9.9"), which);
        assert_nothing_changed(which);
    }
}

/* A person types every word, again and again, and all answers come back. */
static void test_whatever_a_person_types_at_an_echoing_terminal(void)
{
    for (uint32_t end = LINUX_TERMINAL; end < FAR_ENDS; end++) {
        char which[24];
        snprintf(which, sizeof which, "far end %u", (unsigned)end);
        start_at((far_end_t)end);
        for (uint32_t i = 0; i < PLAYED_MS / 3000u; i++) {
            far_end_types(words[i % (uint32_t)WORDS]);
            far_end_types("\r");
            passes_ms(3000u, TICK_EVERY_MS);
        }
        assert_nothing_changed(which);
        passes_ms(5000u + 2u * LATE_MS, TICK_EVERY_MS);
        const uint32_t begun = said_count;
        passes_ms(35000u, TICK_EVERY_MS); /* a question that is open ends within 30 s */
        TEST_ASSERT_LESS_OR_EQUAL_UINT32_MESSAGE(begun + 60u, said_count, which);
        assert_nothing_changed(which);
    }
}

static void test_it_hears_again_when_it_has_been_quiet_for_2_s(void)
{
    start_at(LINUX_TERMINAL);
    passes_ms(500u, TICK_EVERY_MS);
    TEST_ASSERT_EQUAL_UINT32(1u, count_of("this terminal echoes"));
    far_end = SILENT; /* the port was closed, and a terminal without echo has opened it */
    passes_ms(1000u, TICK_EVERY_MS);
    forget_said();
    person_types("k\r"); /* too early; and now the 2 s begin anew */
    passes_ms(1500u, TICK_EVERY_MS);
    TEST_ASSERT_EQUAL_STRING("", said);
    passes_ms(600u, TICK_EVERY_MS);
    person_types("k\r");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "# k: "), said);
    person_types("restart\r");
    person_confirms();
    TEST_ASSERT_EQUAL_UINT32(1u, fake.calls[BRACE_FAKE_RESTART]);
}

/* The line took nothing for a while, as without a cable; then somebody plugs an echo in. */
static void test_an_echo_is_reported_where_nobody_has_listened(void)
{
    start_at(SILENT);
    console.text.gone = true;
    forget_said();
    far_end_types("# brace\r\n");
    passes_ms(100u, TICK_EVERY_MS);
    TEST_ASSERT_EQUAL_UINT32(1u, count_of("\r\n# this terminal echoes"));
}

/* A question ends when the console hears itself: the digits that were right before are not its answer any more. */
static void test_an_echo_ends_a_question(void)
{
    start_at(SILENT);
    person_types("restart\r");
    char digits[6];
    read_digits(digits);
    person_types("# some line of its own\r\n");
    passes_ms(2500u, TICK_EVERY_MS);
    person_types(digits);
    assert_nothing_changed("question");
}

static void test_random_bytes_change_nothing(void)
{
    start_at(SILENT);
    for (uint32_t i = 0; i < (ON_BOARD ? 20000u : 400000u); i++) {
        comes_back((uint8_t)any(256u), 0u);
        if (i % 10u == 0u) {
            passes_ms(1u, TICK_EVERY_MS);
        }
    }
    passes_ms(3000u, TICK_EVERY_MS);
    assert_nothing_changed("bytes");
    TEST_ASSERT_LESS_THAN_UINT32(3000u, said_count);
}

/* Every word there is, prefixes, and lines of up to five digits in a random order. */
static void test_random_words_change_nothing(void)
{
    start_at(SILENT);
    for (uint32_t i = 0; i < (ON_BOARD ? 200u : 5000u); i++) {
        forget_said();
        switch (any(8u)) {
        case 0: far_end_types("# "); break;
        case 1: far_end_types("^M"); break;
        case 2:
            for (uint32_t digits = any(6u); digits > 0u; digits--) {
                comes_back((uint8_t)('0' + any(10u)), 0u);
            }
            break;
        default: far_end_types(words[any(WORDS)]); break;
        }
        far_end_types(any(2u) == 0u ? "\r\n" : any(4u) == 0u ? " " : "\n");
        passes_ms(any(40u) == 0u ? 2500u : 40u, TICK_EVERY_MS);
        assert_nothing_changed("words");
    }
}

/* All that a console has ever said, with every prefix and every beginning of a line cut away. */
static void test_its_own_words_without_their_beginnings_change_nothing(void)
{
    static char all[SAID_BYTES];
    start_at(SILENT);
    for (uint32_t i = 0; i < (uint32_t)WORDS; i++) {
        person_types(words[i]);
        person_types("\rnobody's word\r");
    }
    memcpy(all, said, sizeof all);
    for (uint32_t cut = 0; cut < (ON_BOARD ? 8u : 80u); cut++) {
        start_at(SILENT);
        static char copy[SAID_BYTES];
        memcpy(copy, all, sizeof copy);
        for (char *line = strtok(copy, "\r\n"); line != NULL; line = strtok(NULL, "\r\n")) {
            if (strlen(line) > cut) {
                far_end_types(line + cut);
                far_end_types("\r\n");
                passes_ms(20u, TICK_EVERY_MS);
            }
        }
        assert_nothing_changed("cut");
    }
}

/* The console and its own copy, at a line whose two ends they are. */
static void test_two_consoles_on_one_line_fall_silent(void)
{
    static console_t other;
    static brace_fake_t other_board;
    brace_fake_start(&other_board);
    start_at(SILENT);
    other = (console_t){.text = {.hal = &other_board.hal}};
    text_keep(&other.text);
    banner_image(&other.text);
    uint32_t lines = 0u;
    for (uint32_t i = 0; i < PLAYED_MS; i++) {
        forget_said();
        passes_ms(1u, TICK_EVERY_MS);
        (void)brace_fake_bytes_arrive(&other_board, BRACE_SERIAL_CONSOLE, (const uint8_t *)said, said_count);
        other_board.now_us += 1000u;
        console_serve(&other, &app);
        uint8_t bytes[BRACE_FAKE_SERIAL_BYTES];
        const uint32_t count = brace_fake_bytes_take(&other_board, BRACE_SERIAL_CONSOLE, bytes, sizeof bytes);
        for (uint32_t at = 0; at < count; at++) {
            comes_back(bytes[at], 0u);
            lines += bytes[at] == (uint8_t)'\n';
        }
        if (i == 2000u) {
            lines = 0u;
        }
        TEST_ASSERT_TRUE(i < 2000u || said_count == 0u);
    }
    TEST_ASSERT_EQUAL_UINT32(0u, lines);
    TEST_ASSERT_EQUAL_UINT32(0u, other_board.calls[BRACE_FAKE_RESTART]);
    assert_nothing_changed("two");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_terminal_that_echoes_changes_nothing_and_is_reported_once);
    RUN_TEST(test_whatever_a_person_types_at_an_echoing_terminal);
    RUN_TEST(test_it_hears_again_when_it_has_been_quiet_for_2_s);
    RUN_TEST(test_an_echo_is_reported_where_nobody_has_listened);
    RUN_TEST(test_an_echo_ends_a_question);
    RUN_TEST(test_random_bytes_change_nothing);
    RUN_TEST(test_random_words_change_nothing);
    RUN_TEST(test_its_own_words_without_their_beginnings_change_nothing);
    RUN_TEST(test_two_consoles_on_one_line_fall_silent);
    return UNITY_END();
}
