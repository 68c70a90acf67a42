/* May what somebody has begun go on moving the limb? Who has begun it, who stopped it, and for how long it is held. */
#include "session/ownership.h"

#include <string.h>

#include "brace/refusals.h"
#include "brace/status.h"
#include "unity.h"

enum { TICK_US = 1000 };

static const brace_who_t we = {BRACE_ASKER_CAN, 0};
static const brace_who_t they = {BRACE_ASKER_MODBUS_TCP, 7}, others = {BRACE_ASKER_MODBUS_TCP, 8};

static ownership_t ownership;

void setUp(void)
{
    memset(&ownership, 0, sizeof ownership);
    session_start(&ownership.session, true, NULL, 77);
}

void tearDown(void) {}

static ownership_step_t moves(uint32_t let_go_after_us)
{
    const ownership_inputs_t inputs = {
        .runs = true, .moves = true, .since_us = TICK_US, .let_go_after_us = let_go_after_us};
    session_pass(&ownership.session, TICK_US);
    return ownership_step(&ownership, &inputs);
}

static ownership_step_t rests(void)
{
    const ownership_inputs_t inputs = {.since_us = TICK_US};
    session_pass(&ownership.session, TICK_US);
    return ownership_step(&ownership, &inputs);
}

static void asks(brace_who_t who)
{
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&ownership.session, who, NULL, NULL, 0));
    ownership.is_by_wire = true;
    ownership_wait(&ownership);
}

/* Hears what it was answered, and begins. */
static void begins(brace_who_t who)
{
    const brace_sign_t sign = {.heard = ownership.session.begin, .heard_bits = 32};
    TEST_ASSERT_EQUAL(BRACE_OK, session_life(&ownership.session, who, &sign));
    TEST_ASSERT_EQUAL(OWNERSHIP_BEGINS, rests());
    ownership_begin(&ownership);
}

static void lives(brace_who_t who)
{
    session_pass(&ownership.session, SESSION_LIFE_US / SESSION_SLOTS_PER_LIFE); /* another number */
    const brace_sign_t sign = {.heard = session_number(&ownership.session), .heard_bits = 32};
    TEST_ASSERT_EQUAL(BRACE_OK, session_life(&ownership.session, who, &sign));
}

/* How long an owner that lives may be silent: by what goes on, and on which board. */
static void test_the_patience_with_an_owner(void)
{
    static const struct {
        brace_setting_t setting;
        bool moves, runs, configures;
        uint32_t limit_us;
    } row[] = {{BRACE_SETTING_BENCH, true, true, false, SESSION_LIFE_US},
               {BRACE_SETTING_BENCH, false, true, false, SESSION_LIFE_US},
               {BRACE_SETTING_BENCH, true, false, false, SESSION_LIFE_US},
               {BRACE_SETTING_BENCH, false, false, false, 0},
               {BRACE_SETTING_BENCH, false, false, true, 0},
               {BRACE_SETTING_GUARDED, true, true, false, SESSION_LIFE_US},
               {BRACE_SETTING_GUARDED, true, false, true, SESSION_LIFE_US},
               {BRACE_SETTING_GUARDED, false, true, false, SESSION_IDLE_US},
               {BRACE_SETTING_GUARDED, false, false, false, SESSION_IDLE_US},
               {BRACE_SETTING_GUARDED, false, true, true, SESSION_CLOSED_US},
               {BRACE_SETTING_GUARDED, false, false, true, SESSION_CLOSED_US}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        setUp();
        ownership.session.setting = row[i].setting;
        ownership.session.is_open = ownership.session.is_alive = true;
        ownership_inputs_t inputs = {
            .moves = row[i].moves, .runs = row[i].runs, .configures = row[i].configures, .since_us = row[i].limit_us};
        (void)ownership_step(&ownership, &inputs);
        TEST_ASSERT_TRUE(ownership.session.is_open);
        inputs.since_us = 1;
        (void)ownership_step(&ownership, &inputs);
        TEST_ASSERT_FALSE(ownership.session.is_open);
    }
}

/* A bench waits for as long as a guarded board does. */
static void test_it_waits_for_life_and_is_forgotten_without(void)
{
    static const uint8_t key[SIPHASH_KEY_BYTES] = {1};
    for (int is_bench = 0; is_bench < 2; is_bench++) {
        setUp();
        session_start(&ownership.session, is_bench == 1, is_bench == 1 ? NULL : key, 77);
        ownership.session.is_open = ownership.session.is_alive = true;
        ownership.session.owner = we;
        ownership_wait(&ownership);
        for (uint32_t us = 0; us < SESSION_LIFE_US; us += TICK_US) {
            TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, rests());
            TEST_ASSERT_TRUE(ownership.waits);
        }
        TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, rests());
        TEST_ASSERT_FALSE(ownership.waits);
        TEST_ASSERT_EQUAL(1, ownership.session.counts.silences);
    }
}

static void test_the_sign_with_its_number_sets_it_going(void)
{
    asks(we);
    lives(we); /* with another number */
    TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, rests());
    TEST_ASSERT_TRUE(ownership.waits);
    begins(we);
    TEST_ASSERT_FALSE(ownership.waits || ownership.is_held);
    TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(0));
    TEST_ASSERT_EQUAL(0, ownership.session.counts.silences);
}

/* What the limb does goes on while something else waits. */
static void test_what_moves_goes_on_while_something_waits(void)
{
    asks(we);
    begins(we);
    TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(0));
    asks(we);
    for (uint32_t us = 0; us < 2u * SESSION_LIFE_US; us += TICK_US) {
        if (us % 40000u == 0u) {
            lives(we);
        }
        TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(0));
        TEST_ASSERT_FALSE(ownership.is_held);
    }
    TEST_ASSERT_FALSE(ownership.waits);
}

static void test_a_silent_owner_is_held_counted_and_let_go_as_asked(void)
{
    const uint32_t let_go_after_us = 20u * TICK_US;
    asks(we);
    begins(we);
    for (uint32_t us = TICK_US; us < SESSION_LIFE_US; us += TICK_US) {
        TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(let_go_after_us));
    }
    TEST_ASSERT_EQUAL(OWNERSHIP_STOPS, moves(let_go_after_us));
    TEST_ASSERT_TRUE(ownership.is_held);
    TEST_ASSERT_EQUAL(1, ownership.session.counts.silences);
    for (uint32_t us = TICK_US; us < let_go_after_us; us += TICK_US) {
        TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(let_go_after_us));
    }
    TEST_ASSERT_EQUAL(OWNERSHIP_LETS_GO, moves(let_go_after_us));
}

static void test_what_somebody_has_stopped_is_not_let_go(void)
{
    asks(we);
    begins(we);
    (void)moves(TICK_US);
    ownership_stop(&ownership, true);
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(TICK_US));
        TEST_ASSERT_TRUE(ownership.is_held);
    }
    asks(we);
    TEST_ASSERT_TRUE(ownership.is_held);
    begins(we);
    TEST_ASSERT_FALSE(ownership.is_held);
}

/* Even in the tick in which its sign of life has come. */
static void test_stop_takes_back_what_waits(void)
{
    for (int has_come = 0; has_come < 2; has_come++) {
        asks(we);
        const brace_sign_t sign = {.heard = ownership.session.begin, .heard_bits = 32};
        if (has_come == 1) {
            TEST_ASSERT_EQUAL(BRACE_OK, session_life(&ownership.session, we, &sign));
        }
        ownership_stop(&ownership, false);
        TEST_ASSERT_FALSE(ownership.waits || ownership.is_held);
        TEST_ASSERT_EQUAL(BRACE_REFUSED_LATE, session_life(&ownership.session, we, &sign));
        TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, rests());
    }
}

static void test_the_program_needs_no_signs_of_life(void)
{
    asks(we);
    begins(we);
    ownership.is_by_wire = false;
    ownership_begin(&ownership);
    TEST_ASSERT_FALSE(ownership.session.is_open); /* nobody else owns it then */
    TEST_ASSERT_FALSE(ownership_is_idle(&ownership));
    for (uint32_t us = 0; us < 3u * SESSION_LIFE_US; us += TICK_US) {
        TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(0));
        TEST_ASSERT_FALSE(ownership.is_held);
    }
    TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, rests());
    TEST_ASSERT_TRUE(ownership_is_idle(&ownership));
}

/* What a wire begins after the program needs signs of life again. */
static void test_after_the_program_a_wire_s_owner_needs_them(void)
{
    ownership.is_by_wire = false;
    ownership_begin(&ownership);
    TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(0));
    asks(we);
    begins(we);
    ownership_step_t last = OWNERSHIP_GOES_ON;
    for (uint32_t us = TICK_US; us <= SESSION_LIFE_US; us += TICK_US) {
        last = moves(0);
    }
    TEST_ASSERT_EQUAL(OWNERSHIP_STOPS, last);
    TEST_ASSERT_TRUE(ownership.is_held && ownership.fell_silent);
}

static void test_one_master_writes_until_it_has_gone(void)
{
    const ownership_inputs_t configures = {.configures = true, .since_us = TICK_US};
    TEST_ASSERT_EQUAL(BRACE_OK, ownership_may_write(&ownership, they, false));
    TEST_ASSERT_FALSE(ownership_is_idle(&ownership));
    (void)ownership_step(&ownership, &configures);
    TEST_ASSERT_EQUAL(BRACE_OK, ownership_may_write(&ownership, they, false));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, ownership_may_write(&ownership, others, false));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, ownership_may_write(&ownership, we, true)); /* of another port */
    TEST_ASSERT_EQUAL(2, ownership.session.counts.strangers);
    TEST_ASSERT_EQUAL(BRACE_OK, ownership_may_write(&ownership, others, true));
    (void)rests(); /* CONFIGURATION has ended */
    TEST_ASSERT_EQUAL(BRACE_OK, ownership_may_write(&ownership, we, false));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, ownership_may_write(&ownership, they, true));
}

static void test_storing_is_no_silence(void)
{
    const ownership_inputs_t stores = {.runs = true, .moves = true, .stores = true, .since_us = 10u * SESSION_LIFE_US};
    asks(we);
    begins(we);
    TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, ownership_step(&ownership, &stores));
    TEST_ASSERT_TRUE(ownership.session.is_open);
}

/* What was held is held on while the next motion waits, and when it is forgotten. */
static void test_what_was_held_stays_held_when_the_next_motion_is_forgotten(void)
{
    asks(we);
    begins(we);
    (void)moves(0);
    ownership_stop(&ownership, true);
    session_end(&ownership.session);
    asks(we);
    asks(we);
    for (uint32_t us = 0; us < 2u * SESSION_LIFE_US; us += TICK_US) {
        TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(0));
        TEST_ASSERT_TRUE(ownership.is_held);
    }
    TEST_ASSERT_FALSE(ownership.waits);
}

/* A loading test that is over and a take-up that holds are at rest already: the owner that goes stops neither, and no
 * silence is counted. */
static void test_an_owner_that_goes_while_nothing_moves_is_no_silence(void)
{
    const ownership_inputs_t holds = {.runs = true, .since_us = SESSION_LIFE_US + TICK_US};
    asks(we);
    begins(we);
    (void)moves(0);
    TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, ownership_step(&ownership, &holds));
    TEST_ASSERT_TRUE(ownership.is_held);
    TEST_ASSERT_EQUAL(0, ownership.session.counts.silences);
}

/* Counters stop at their greatest number; a limb may be held for longer than a word counts. */
static void test_nothing_is_counted_beyond_a_word(void)
{
    ownership.session.counts.silences = UINT32_MAX;
    asks(we);
    begins(we);
    for (uint32_t us = 0; us <= SESSION_LIFE_US; us += TICK_US) {
        (void)moves(0);
    }
    TEST_ASSERT_TRUE(ownership.is_held);
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, ownership.session.counts.silences);
    const uint32_t most_us = 3000000u;
    ownership.held_us = UINT32_MAX / 2u;
    TEST_ASSERT_EQUAL(OWNERSHIP_LETS_GO, moves(most_us));
    for (int i = 0; i < 3; i++) {
        (void)moves(0);
    }
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX / 2u, ownership.held_us);
    ownership.session.counts.strangers = UINT32_MAX;
    TEST_ASSERT_EQUAL(BRACE_OK, ownership_may_write(&ownership, they, false));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, ownership_may_write(&ownership, others, false));
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, ownership.session.counts.strangers);
}

static void test_idle_is_who_has_nothing_to_mind(void)
{
    TEST_ASSERT_TRUE(ownership_is_idle(&ownership));
    lives(we); /* heard, and nothing more */
    TEST_ASSERT_TRUE(ownership_is_idle(&ownership));
    asks(we);
    TEST_ASSERT_FALSE(ownership_is_idle(&ownership));
    setUp();
    ownership_stop(&ownership, true); /* held */
    TEST_ASSERT_FALSE(ownership_is_idle(&ownership));
    setUp();
    ownership.program_moves = true;
    TEST_ASSERT_FALSE(ownership_is_idle(&ownership));
    setUp();
    TEST_ASSERT_EQUAL(BRACE_OK, ownership_may_write(&ownership, they, false));
    TEST_ASSERT_FALSE(ownership_is_idle(&ownership));
    static const uint8_t key[SIPHASH_KEY_BYTES] = {1};
    setUp();
    session_start(&ownership.session, false, key, 77);
    TEST_ASSERT_FALSE(ownership_is_idle(&ownership)); /* it still waits for the challenge of the next session */
    session_challenge(&ownership.session, 1);
    TEST_ASSERT_TRUE(ownership_is_idle(&ownership));
}

/* The limb holds for the same time after every silence before it lets go. */
static void test_every_silence_is_held_as_long(void)
{
    enum { LET_GO_TICKS = 40 };
    for (int round = 0; round < 3; round++) {
        int held = 0;
        asks(we);
        begins(we);
        TEST_ASSERT_EQUAL(OWNERSHIP_GOES_ON, moves(LET_GO_TICKS * TICK_US));
        TEST_ASSERT_FALSE(ownership.is_held);
        ownership_step_t step = OWNERSHIP_GOES_ON;
        for (int i = 0; i < 500 && step == OWNERSHIP_GOES_ON; i++) {
            step = moves(LET_GO_TICKS * TICK_US);
        }
        TEST_ASSERT_EQUAL(OWNERSHIP_STOPS, step);
        for (step = OWNERSHIP_GOES_ON; held < 500 && step == OWNERSHIP_GOES_ON; held++) {
            step = moves(LET_GO_TICKS * TICK_US);
        }
        TEST_ASSERT_EQUAL(OWNERSHIP_LETS_GO, step);
        TEST_ASSERT_EQUAL(LET_GO_TICKS, held);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_patience_with_an_owner);
    RUN_TEST(test_it_waits_for_life_and_is_forgotten_without);
    RUN_TEST(test_the_sign_with_its_number_sets_it_going);
    RUN_TEST(test_what_moves_goes_on_while_something_waits);
    RUN_TEST(test_a_silent_owner_is_held_counted_and_let_go_as_asked);
    RUN_TEST(test_what_somebody_has_stopped_is_not_let_go);
    RUN_TEST(test_stop_takes_back_what_waits);
    RUN_TEST(test_the_program_needs_no_signs_of_life);
    RUN_TEST(test_after_the_program_a_wire_s_owner_needs_them);
    RUN_TEST(test_one_master_writes_until_it_has_gone);
    RUN_TEST(test_storing_is_no_silence);
    RUN_TEST(test_what_was_held_stays_held_when_the_next_motion_is_forgotten);
    RUN_TEST(test_an_owner_that_goes_while_nothing_moves_is_no_silence);
    RUN_TEST(test_nothing_is_counted_beyond_a_word);
    RUN_TEST(test_idle_is_who_has_nothing_to_mind);
    RUN_TEST(test_every_silence_is_held_as_long);
    return UNITY_END();
}
