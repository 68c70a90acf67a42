/* The session machine alone: who becomes the owner, what a seal must say, when a session ends. */
#include "session/session.h"

#include <string.h>

#include "brace/refusals.h"
#include "brace/status.h"
#include "unity.h"

static const uint8_t key[SIPHASH_KEY_BYTES] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
static const uint8_t other_key[SIPHASH_KEY_BYTES] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 17};
static const uint8_t order[8] = {15, 7, 1, 1, 0, 0, 0, 0};
static const brace_who_t we = {BRACE_ASKER_CAN, 0}, they = {BRACE_ASKER_CAN, 3}, elsewhere = {BRACE_ASKER_MODBUS_TCP, 0};

static session_t session;

void setUp(void)
{
    session_start(&session, false, key);
    session_challenge(&session, 12345);
}

void tearDown(void) {}

static uint32_t mac(const uint8_t *with, uint64_t challenge, uint32_t counter, session_kind_t kind,
                    const uint8_t *bytes, uint32_t count)
{
    siphash_t hash;
    siphash_start(&hash, with);
    siphash_word(&hash, challenge);
    siphash_word(&hash, (uint64_t)kind << 32 | counter);
    return (uint32_t)siphash_end(&hash, bytes, count);
}

static brace_seal_t life_of(uint32_t counter)
{
    return (brace_seal_t){true, counter, 32, mac(key, session.challenge, counter, SESSION_LIFE, NULL, 0)};
}

static brace_seal_t seal_of(uint32_t counter)
{
    return (brace_seal_t){true, counter, 32, mac(key, session.challenge, counter, SESSION_COMMAND, order, 8)};
}

static int32_t life(brace_who_t who, uint32_t counter)
{
    const brace_seal_t seal = life_of(counter);
    return session_life(&session, who, &seal);
}

static int32_t command(brace_who_t who, uint32_t counter)
{
    const brace_seal_t seal = seal_of(counter);
    return session_command(&session, who, &seal, order, 8);
}

static void test_a_session_opens_with_the_check_of_its_challenge(void)
{
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, command(we, 1));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, life(we, 1)); /* only number 0 opens */
    TEST_ASSERT_FALSE(session_may_move(&session));
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    TEST_ASSERT_TRUE(session_may_move(&session));
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 1));
    TEST_ASSERT_EQUAL(2, session.counts.strangers);
}

static void test_without_the_key_nothing_opens(void)
{
    for (uint32_t bit = 0; bit < 32u; bit++) {
        brace_seal_t seal = life_of(0);
        seal.mac ^= 1u << bit;
        TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &seal));
    }
    const brace_seal_t wrong = {true, 0, 32, mac(other_key, session.challenge, 0, SESSION_LIFE, NULL, 0)};
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &wrong));
    TEST_ASSERT_FALSE(session.is_open);
    TEST_ASSERT_EQUAL(33, session.counts.strangers);
}

static void test_counters_only_rise(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 5));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, command(we, 5));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, life(we, 4));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, life(we, 0));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, command(we, 0x80000006u)); /* more than half the numbers ahead */
    TEST_ASSERT_EQUAL(4, session.counts.replays);
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 6));
}

/* At the end of its numbers a session ends too: none comes round. */
static void test_the_last_number_has_no_next_one(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    session.counter = UINT32_MAX - 1u;
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, UINT32_MAX));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, command(we, 0));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, command(we, 1));
    brace_seal_t low = seal_of(2);
    low.counter_bits = 8;
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, session_command(&session, we, &low, order, 8));
}

/* A challenge that nobody has answered stays good; one that a session was opened with does not. */
static void test_each_session_has_its_own_challenge(void)
{
    session_end(&session);
    TEST_ASSERT_TRUE(session.has_challenge);
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    session_end(&session);
    TEST_ASSERT_FALSE(session.has_challenge);
    session_end(&session);
    TEST_ASSERT_FALSE(session.has_challenge);
}

/* On a bench, who falls silent in what it began but lives still may begin the next thing; on a guarded board, not. */
static void test_who_lives_on_may_begin_the_next_thing_on_a_bench(void)
{
    session_start(&session, true, NULL);
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
    TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, we, NULL));
    TEST_ASSERT_TRUE(session_tick(&session, 1000, 0)); /* what it began has ended */
    TEST_ASSERT_FALSE(session.is_open);
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
    TEST_ASSERT_TRUE(session_may_move(&session));
    setUp();
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    TEST_ASSERT_TRUE(session_tick(&session, 1000, 0));
    TEST_ASSERT_FALSE(session.has_heard);
    TEST_ASSERT_EQUAL_UINT32(0, session.counter);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, command(we, 1));
}

static void test_low_bits_stand_for_the_next_number_that_has_them(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    for (uint32_t counter = 100; counter < 2000u; counter += 100u) {
        brace_seal_t seal = seal_of(counter);
        seal.counter &= 0xffu;
        seal.counter_bits = 8;
        TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, &seal, order, 8));
        TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, session_command(&session, we, &seal, order, 8));
    }
    brace_seal_t old = seal_of(1900 - 256); /* the same low bits as a number that is still to come */
    old.counter = (1900u + 1u) & 0xffu;
    old.counter_bits = 8;
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &old, order, 8));
}

static void test_the_check_is_over_counter_kind_and_command(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    const brace_seal_t seal = seal_of(1), sign = life_of(1);
    for (uint32_t bit = 0; bit < 64u; bit++) {
        uint8_t changed[8];
        memcpy(changed, order, sizeof changed);
        changed[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &seal, changed, 8));
    }
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &seal, order, 7)); /* cut short */
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &sign, order, 8)); /* a life sign's check */
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &seal));              /* a command's check */
    brace_seal_t later = seal;
    later.counter = 2;
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &later, order, 8));
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, &seal, order, 8));
}

static void test_there_is_one_owner_at_a_time(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, life(they, 0));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, life(elsewhere, 1));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, command(elsewhere, 1));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_command(&session, they, NULL, order, 8));
    TEST_ASSERT_EQUAL(0, session.counter);
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 1));
}

static void test_silence_ends_a_session_and_its_seals(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    TEST_ASSERT_FALSE(session_tick(&session, SESSION_LIFE_US, SESSION_LIFE_US));
    const brace_seal_t late = seal_of(1), again = life_of(0);
    const uint64_t challenge = session.challenge;
    TEST_ASSERT_TRUE(session_tick(&session, 1, SESSION_LIFE_US));
    TEST_ASSERT_FALSE(session.is_open);
    TEST_ASSERT_FALSE(session.has_challenge);
    TEST_ASSERT_EQUAL_UINT32(0, session.silent_us);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &again));
    session_challenge(&session, 54321);
    TEST_ASSERT_TRUE(challenge != session.challenge);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &again)); /* of the session before */
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &late, order, 8));
    TEST_ASSERT_FALSE(session_tick(&session, 1, SESSION_LIFE_US));
}

static void test_refused_signs_do_not_keep_a_session(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    bool ended = false;
    for (uint32_t i = 0; i < 14u; i++) {
        brace_seal_t forged = life_of(i + 1u);
        forged.mac++;
        (void)session_life(&session, we, &forged);
        (void)life(they, i);
        ended = session_tick(&session, 10000, SESSION_LIFE_US);
    }
    TEST_ASSERT_TRUE(ended);
}

static void test_a_guarded_board_without_a_key_refuses_everybody(void)
{
    session_start(&session, false, NULL);
    session_challenge(&session, 1);
    TEST_ASSERT_EQUAL(BRACE_SETTING_NO_KEY, session.setting);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_NO_KEY, life(we, 0));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_NO_KEY, command(we, 1));
    TEST_ASSERT_FALSE(session_may_move(&session));
}

static void test_on_a_bench_a_command_waits_for_a_sign_of_life(void)
{
    session_start(&session, true, NULL);
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
    TEST_ASSERT_FALSE(session_may_move(&session));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_life(&session, they, NULL));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_command(&session, they, NULL, order, 8));
    TEST_ASSERT_FALSE(session_may_move(&session));
    TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, we, NULL));
    TEST_ASSERT_TRUE(session_may_move(&session));
    TEST_ASSERT_TRUE(session_tick(&session, SESSION_LIFE_US + 1, SESSION_LIFE_US));
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, they, NULL, order, 8));
}

static void test_on_a_bench_who_lives_already_may_move_at_once(void)
{
    session_start(&session, true, NULL);
    TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, we, NULL));
    TEST_ASSERT_FALSE(session.is_open); /* nothing is begun by a sign of life, */
    TEST_ASSERT_FALSE(session.is_alive); /* and no session lives before there is one */
    (void)session_tick(&session, 100000, SESSION_LIFE_US);
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
    TEST_ASSERT_TRUE(session_may_move(&session));
    TEST_ASSERT_TRUE(session_tick(&session, 30001, SESSION_LIFE_US)); /* from the sign of life on */
    TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, they, NULL));
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8)); /* another's life is not ours */
    TEST_ASSERT_FALSE(session_may_move(&session));
}

/* What an owner has begun ends, and it may begin something else as long as its last sign of life counts. */
static void test_on_a_bench_the_last_sign_of_life_counts_on(void)
{
    for (int is_late = 0; is_late < 2; is_late++) {
        session_start(&session, true, NULL);
        TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, we, NULL));
        TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
        TEST_ASSERT_FALSE(session_tick(&session, SESSION_LIFE_US - 1000u, SESSION_LIFE_US));
        TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, we, NULL));
        TEST_ASSERT_TRUE(session_tick(&session, 50000, 0)); /* it has ended */
        TEST_ASSERT_FALSE(session.is_open);
        TEST_ASSERT_FALSE(session_tick(&session, SESSION_LIFE_US - 50000u + (uint32_t)is_late, 0));
        TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
        TEST_ASSERT_EQUAL(is_late == 0, session_may_move(&session));
    }
}

static void test_who_hangs_up_is_the_owner_no_longer(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 7));
    session_hang_up(&session);
    TEST_ASSERT_FALSE(session.is_open);
    session_challenge(&session, 99);
    TEST_ASSERT_EQUAL(BRACE_OK, life(elsewhere, 0));
    TEST_ASSERT_EQUAL(BRACE_OK, command(elsewhere, 1)); /* numbers begin anew */
}

/* By hand, each thing that is written has a connection of its own. */
static void test_on_a_bench_another_connection_of_the_port_goes_on(void)
{
    const brace_who_t next = {BRACE_ASKER_CAN, 4};
    session_start(&session, true, NULL);
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
    session_hang_up(&session);
    TEST_ASSERT_TRUE(session.is_open);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_life(&session, elsewhere, NULL)); /* not of another port */
    TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, they, NULL));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_life(&session, next, NULL)); /* they have not hung up */
    session_end(&session);
    session_hang_up(&session); /* of a session that is over: the next owner has hung up nothing */
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_command(&session, they, NULL, order, 8));
}

static void test_a_board_that_becomes_a_bench_is_open_to_all(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    session_become_bench(&session);
    TEST_ASSERT_FALSE(session.is_open);
    TEST_ASSERT_FALSE(session.has_challenge);
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, they, NULL, order, 8));
    TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, they, NULL));
    TEST_ASSERT_TRUE(session_may_move(&session));
}

/* A board that becomes a bench needs no challenge, and its session ends. */
static void test_a_bench_keeps_nothing_of_the_guard(void)
{
    TEST_ASSERT_TRUE(session.has_challenge);
    session_become_bench(&session);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, session.setting);
    TEST_ASSERT_FALSE(session.has_challenge || session.is_open || session.is_alive);
    setUp();
    TEST_ASSERT_EQUAL(BRACE_OK, life(we, 0));
    session_become_bench(&session);
    TEST_ASSERT_FALSE(session.has_challenge || session.is_open || session.is_alive);
}

/* An owner that hung up may come back. Until then nobody else on its port acts in its place. */
static void test_an_owner_that_comes_back_has_not_hung_up(void)
{
    for (int by_life = 0; by_life < 2; by_life++) {
        session_start(&session, true, NULL);
        TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, elsewhere, NULL, order, 8));
        session_hang_up(&session);
        TEST_ASSERT_TRUE(session.has_hung_up);
        TEST_ASSERT_EQUAL(BRACE_OK, by_life != 0 ? session_life(&session, elsewhere, NULL)
                                                 : session_command(&session, elsewhere, NULL, order, 8));
        TEST_ASSERT_FALSE(session.has_hung_up);
        const brace_who_t neighbour = {elsewhere.port, elsewhere.master + 1u};
        TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_life(&session, neighbour, NULL));
        TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_command(&session, neighbour, NULL, order, 8));
        session_hang_up(&session);
        TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, neighbour, NULL));
        TEST_ASSERT_EQUAL(neighbour.master, session.owner.master);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_session_opens_with_the_check_of_its_challenge);
    RUN_TEST(test_without_the_key_nothing_opens);
    RUN_TEST(test_counters_only_rise);
    RUN_TEST(test_the_last_number_has_no_next_one);
    RUN_TEST(test_each_session_has_its_own_challenge);
    RUN_TEST(test_who_lives_on_may_begin_the_next_thing_on_a_bench);
    RUN_TEST(test_low_bits_stand_for_the_next_number_that_has_them);
    RUN_TEST(test_the_check_is_over_counter_kind_and_command);
    RUN_TEST(test_there_is_one_owner_at_a_time);
    RUN_TEST(test_silence_ends_a_session_and_its_seals);
    RUN_TEST(test_refused_signs_do_not_keep_a_session);
    RUN_TEST(test_a_guarded_board_without_a_key_refuses_everybody);
    RUN_TEST(test_on_a_bench_a_command_waits_for_a_sign_of_life);
    RUN_TEST(test_on_a_bench_who_lives_already_may_move_at_once);
    RUN_TEST(test_on_a_bench_the_last_sign_of_life_counts_on);
    RUN_TEST(test_who_hangs_up_is_the_owner_no_longer);
    RUN_TEST(test_on_a_bench_another_connection_of_the_port_goes_on);
    RUN_TEST(test_a_board_that_becomes_a_bench_is_open_to_all);
    RUN_TEST(test_a_bench_keeps_nothing_of_the_guard);
    RUN_TEST(test_an_owner_that_comes_back_has_not_hung_up);
    return UNITY_END();
}
