/* The session machine alone: who becomes the owner, what a seal must say, when a session ends. */
#include "session/session.h"

#include <string.h>

#include "brace/refusals.h"
#include "brace/status.h"
#include "unity.h"

static const uint8_t key[SIPHASH_KEY_BYTES] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
static const uint8_t other_key[SIPHASH_KEY_BYTES] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 17};
static const uint8_t order[8] = {15, 7, 1, 1, 0, 0, 0, 0};
static const brace_who_t we = {BRACE_ASKER_CAN, 0}, they = {BRACE_ASKER_CAN, 3};
static const brace_who_t elsewhere = {BRACE_ASKER_MODBUS_TCP, 0};

static session_t session;

void setUp(void)
{
    session_start(&session, false, key, 77);
    session_challenge(&session, 12345);
}

void tearDown(void) {}

static void bench(void)
{
    session_start(&session, true, NULL, 77);
}

static uint32_t mac(const uint8_t *with, uint64_t challenge, uint32_t counter, session_kind_t kind,
                    const uint8_t *bytes, uint32_t count)
{
    siphash_t hash;
    siphash_start(&hash, with);
    siphash_word(&hash, challenge);
    siphash_word(&hash, (uint64_t)kind << 32 | counter);
    return (uint32_t)siphash_end(&hash, bytes, count);
}

static brace_sign_t sign_of(uint32_t number)
{
    return (brace_sign_t){number, 32, mac(key, session.challenge, number, SESSION_LIFE, NULL, 0)};
}

static brace_seal_t seal_of(uint32_t counter)
{
    return (brace_seal_t){true, counter, 32, mac(key, session.challenge, counter, SESSION_COMMAND, order, 8), NULL};
}

static int32_t life_with(brace_who_t who, uint32_t number)
{
    const brace_sign_t sign = sign_of(number);
    return session_life(&session, who, &sign);
}

static void passes(uint32_t us)
{
    for (uint32_t at = 0; at < us; at += 1000u) {
        session_pass(&session, us - at < 1000u ? us - at : 1000u);
    }
}

/* A sign of life with a number that has not counted yet. */
static int32_t life(brace_who_t who)
{
    passes(SESSION_LIFE_US / SESSION_SLOTS_PER_LIFE);
    return life_with(who, session_number(&session));
}

static int32_t command(brace_who_t who, uint32_t counter)
{
    const brace_seal_t seal = seal_of(counter);
    return session_command(&session, who, &seal, order, 8);
}

static int32_t command_on_a_bench(brace_who_t who)
{
    return session_command(&session, who, NULL, order, 8);
}

/* -------------------------------------------------------------------------------------- numbers -- */

/* A number counts for as long as the owner may be silent, whenever in its time it was sent, and at most a fifth
 * more. */
static void test_a_number_is_good_for_a_short_time(void)
{
    const uint32_t slot_us = SESSION_LIFE_US / SESSION_SLOTS_PER_LIFE;
    for (int is_bench = 0; is_bench < 2; is_bench++) {
        for (uint32_t sent_us = 0; sent_us < slot_us; sent_us += 500u) {
            for (uint32_t late_us = 0; late_us < 3u * SESSION_LIFE_US; late_us += 1000u) {
                if (is_bench == 1) {
                    bench();
                    (void)command_on_a_bench(we);
                } else {
                    setUp();
                }
                passes(sent_us);
                const uint32_t number = session_number(&session);
                passes(late_us);
                const int32_t status = life_with(we, number);
                if (late_us < SESSION_LIFE_US) {
                    TEST_ASSERT_EQUAL(BRACE_OK, status);
                } else if (late_us > SESSION_LIFE_US + slot_us) {
                    TEST_ASSERT_EQUAL(BRACE_REFUSED_LATE, status);
                }
            }
        }
    }
}

/* What stands still for long, and passes as one step, makes all numbers old. */
static void test_numbers_grow_old_while_the_processor_stands_still(void)
{
    static const uint32_t stood_us[] = {160000, 2000000, 0x7fffffff, UINT32_MAX};
    for (uint32_t i = 0; i < 4u; i++) {
        setUp();
        const uint32_t before = session_number(&session);
        session_pass(&session, stood_us[i]);
        TEST_ASSERT_EQUAL(BRACE_REFUSED_LATE, life_with(we, before));
        TEST_ASSERT_EQUAL(BRACE_REFUSED_LATE, life_with(we, before));
        TEST_ASSERT_EQUAL(2, session.counts.replays);
        TEST_ASSERT_FALSE(session.is_open);
    }
}

static void test_a_number_counts_once_and_none_before_it(void)
{
    for (int is_bench = 0; is_bench < 2; is_bench++) {
        setUp();
        if (is_bench == 1) {
            bench();
            (void)command_on_a_bench(we);
        }
        const uint32_t first = session_number(&session);
        TEST_ASSERT_EQUAL(BRACE_OK, life_with(we, first));
        const uint32_t second = (passes(30000), session_number(&session));
        passes(30000);
        TEST_ASSERT_EQUAL(BRACE_OK, life_with(we, session_number(&session)));
        session.silent_us = 1000;
        TEST_ASSERT_EQUAL(BRACE_OK, life_with(we, first));
        TEST_ASSERT_EQUAL(BRACE_OK, life_with(we, second));
        TEST_ASSERT_EQUAL(BRACE_OK, life_with(we, session_number(&session)));
        TEST_ASSERT_EQUAL(1000, session.silent_us); /* none of the three counts */
        passes(30000);
        TEST_ASSERT_EQUAL(BRACE_OK, life_with(we, session_number(&session)));
        TEST_ASSERT_EQUAL(0, session.silent_us);
    }
}

/* A board that gives its owners more time gives its numbers more. */
static void test_the_board_s_own_silence_is_the_numbers_too(void)
{
    bench();
    session.life_us = 10u * SESSION_LIFE_US;
    (void)command_on_a_bench(we);
    const uint32_t number = session_number(&session);
    passes(10u * SESSION_LIFE_US - 1000u);
    TEST_ASSERT_EQUAL(BRACE_OK, life_with(we, number));
}

/* None of a bench's numbers comes twice, and another start has others. */
static void test_no_number_comes_again(void)
{
    enum { NUMBERS = 2000 };
    static uint32_t seen[NUMBERS];
    bench();
    for (uint32_t i = 0; i < (uint32_t)NUMBERS; i++) {
        session_pass(&session, SESSION_LIFE_US / SESSION_SLOTS_PER_LIFE);
        seen[i] = session_number(&session);
        for (uint32_t j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(seen[i] != seen[j]);
        }
    }
    session_start(&session, true, NULL, 78000);
    for (uint32_t i = 0; i < (uint32_t)NUMBERS; i++) {
        session_pass(&session, SESSION_LIFE_US / SESSION_SLOTS_PER_LIFE);
        TEST_ASSERT_TRUE(session_number(&session) != seen[i]);
    }
}

/* Over CAN a guarded board's number comes back with its low half, and is checked as a whole. */
static void test_half_a_number_is_checked_as_a_whole(void)
{
    const uint32_t number = session_number(&session);
    brace_sign_t sign = sign_of(number);
    sign.heard &= 0xffffu;
    sign.heard_bits = 16;
    sign.check ^= 1u;
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &sign));
    sign.check = mac(key, session.challenge, number & 0xffffu, SESSION_LIFE, NULL, 0);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &sign));
    sign.check = sign_of(number).check;
    TEST_ASSERT_EQUAL(BRACE_OK, session_life(&session, we, &sign));
}

/* ---------------------------------------------------------------------------------------- motions -- */

/* Only the number that the command was answered with begins what was asked for; all others only keep it alive. */
static void test_a_motion_begins_with_its_own_number(void)
{
    for (int is_bench = 0; is_bench < 2; is_bench++) {
        setUp();
        if (is_bench == 1) {
            bench();
            (void)command_on_a_bench(we);
        }
        TEST_ASSERT_EQUAL(BRACE_OK, life(we));
        session_await(&session);
        const uint32_t begin = session.begin;
        TEST_ASSERT_EQUAL(BRACE_OK, life(we));
        TEST_ASSERT_EQUAL(BRACE_OK, life(we));
        TEST_ASSERT_TRUE(session.has_begin && !session.has_begun);
        TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, life_with(elsewhere, begin));
        TEST_ASSERT_TRUE(session.has_begin && !session.has_begun);
        TEST_ASSERT_EQUAL(BRACE_OK, life_with(we, begin));
        TEST_ASSERT_TRUE(!session.has_begin && session.has_begun);
        session.has_begun = false; /* it has been seen to */
        TEST_ASSERT_EQUAL(BRACE_OK, life_with(we, begin)); /* its answer was lost */
        TEST_ASSERT_FALSE(session.has_begun);
        TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    }
}

static void test_a_motion_waits_for_as_long_as_an_owner_may_be_silent(void)
{
    for (uint32_t late_us = SESSION_LIFE_US; late_us <= SESSION_LIFE_US + 1000u; late_us += 1000u) {
        setUp();
        TEST_ASSERT_EQUAL(BRACE_OK, life(we));
        session_await(&session);
        const uint32_t begin = session.begin;
        passes(late_us);
        const bool is_late = late_us > SESSION_LIFE_US;
        TEST_ASSERT_EQUAL(is_late ? BRACE_REFUSED_LATE : BRACE_OK, life_with(we, begin));
        TEST_ASSERT_EQUAL(!is_late, session.has_begun);
    }
    session_await(&session);
    session_pass(&session, UINT32_MAX); /* the processor has stood still */
    TEST_ASSERT_FALSE(session.has_begin);
}

/* Each motion has another number, in the same moment too; the one that has waited before waits no longer. */
static void test_each_motion_has_its_own_number(void)
{
    bench();
    (void)command_on_a_bench(we);
    session_await(&session);
    const uint32_t before = session.begin;
    session_await(&session);
    TEST_ASSERT_TRUE(before != session.begin);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_LATE, life_with(we, before));
    TEST_ASSERT_TRUE(session.has_begin);
    session_end(&session);
    TEST_ASSERT_FALSE(session.has_begin);
    (void)command_on_a_bench(we);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_LATE, life_with(we, session.begin)); /* with the session it was over */
    TEST_ASSERT_FALSE(session.has_begun);
}

/* --------------------------------------------------------------------------------------- sessions -- */

static void test_a_session_opens_with_the_check_of_its_challenge(void)
{
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, command(we, 1));
    TEST_ASSERT_FALSE(session_may_move(&session));
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_TRUE(session_may_move(&session));
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 1));
    TEST_ASSERT_EQUAL(1, session.counts.strangers);
}

static void test_without_the_key_nothing_opens(void)
{
    const uint32_t number = session_number(&session);
    for (uint32_t bit = 0; bit < 32u; bit++) {
        brace_sign_t sign = sign_of(number);
        sign.check ^= 1u << bit;
        TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &sign));
    }
    const brace_sign_t wrong = {number, 32, mac(other_key, session.challenge, number, SESSION_LIFE, NULL, 0)};
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &wrong));
    TEST_ASSERT_FALSE(session.is_open);
    TEST_ASSERT_EQUAL(33, session.counts.strangers);
    session.has_challenge = false; /* the next one is being made */
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, life_with(we, number));
}

/* A challenge that nobody answers is renewed, so that an opening that was held up on its way finds another one. */
static void test_a_challenge_without_a_session_is_renewed(void)
{
    passes(SESSION_CHALLENGE_US - 1000u);
    TEST_ASSERT_TRUE(session.has_challenge);
    passes(1000u);
    TEST_ASSERT_FALSE(session.has_challenge);
    session_challenge(&session, 54321);
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    passes(3u * SESSION_CHALLENGE_US); /* that of an open session stays, however long it lasts */
    TEST_ASSERT_TRUE(session.has_challenge);
    session_end(&session);
    session_challenge(&session, 99);
    session_pass(&session, UINT32_MAX);
    TEST_ASSERT_FALSE(session.has_challenge);
}

static void test_counters_only_rise(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 5));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, command(we, 5));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, command(we, 4));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, command(we, 0));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_REPLAY, command(we, 0x80000006u)); /* more than half the numbers ahead */
    TEST_ASSERT_EQUAL(4, session.counts.replays);
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 6));
}

/* At the end of its numbers a session ends too: none comes round. */
static void test_the_last_number_has_no_next_one(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
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
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    session_end(&session);
    TEST_ASSERT_FALSE(session.has_challenge);
    session_end(&session);
    TEST_ASSERT_FALSE(session.has_challenge);
}

/* What was begun in a session is over with it. */
static void test_a_session_that_ends_takes_its_counters_along(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 7));
    TEST_ASSERT_TRUE(session_tick(&session, 1000, 0));
    TEST_ASSERT_EQUAL_UINT32(0, session.counter);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, command(we, 8));
}

static void test_low_bits_stand_for_the_next_number_that_has_them(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
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
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    const brace_seal_t seal = seal_of(1);
    const brace_seal_t lifes = {true, 1, 32, mac(key, session.challenge, 1, SESSION_LIFE, NULL, 0), NULL};
    for (uint32_t bit = 0; bit < 64u; bit++) {
        uint8_t changed[8];
        memcpy(changed, order, sizeof changed);
        changed[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &seal, changed, 8));
    }
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &seal, order, 7)); /* cut short */
    /* a life sign's check */
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &lifes, order, 8));
    passes(30000);
    const uint32_t number = session_number(&session);
    const brace_sign_t sign = {number, 32, mac(key, session.challenge, number, SESSION_COMMAND, NULL, 0)};
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &sign)); /* a command's check */
    brace_seal_t later = seal;
    later.counter = 2;
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &later, order, 8));
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, &seal, order, 8));
}

/* Of several seals with the command's counter one has to fit, wherever it stands; of more than there may be, the rest
 * is not looked at. */
static void test_one_of_several_seals_has_to_fit(void)
{
    enum { SEALS = BRACE_SEALS_MOST + 1 };
    uint32_t counter = 0;
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    for (int right = 0; right <= SEALS; right++) {
        brace_seal_t seal[SEALS];
        counter++;
        for (int i = 0; i < SEALS; i++) {
            seal[i] = seal_of(counter);
            seal[i].mac ^= i == right ? 0u : 1u << i;
            seal[i].next = i + 1 < SEALS ? &seal[i + 1] : NULL;
        }
        TEST_ASSERT_EQUAL(right < BRACE_SEALS_MOST ? BRACE_OK : BRACE_REFUSED_STRANGER,
                          session_command(&session, we, &seal[0], order, 8));
        counter = session.counter;
    }
}

static void test_there_is_one_owner_at_a_time(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, life(they));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, life(elsewhere));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, command(elsewhere, 1));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_command(&session, they, NULL, order, 8));
    TEST_ASSERT_EQUAL(0, session.counter);
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 1));
}

static void test_silence_ends_a_session_and_its_seals(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_FALSE(session_tick(&session, SESSION_LIFE_US, SESSION_LIFE_US));
    const brace_seal_t late = seal_of(1);
    const brace_sign_t again = sign_of(session_number(&session));
    const uint64_t challenge = session.challenge;
    TEST_ASSERT_TRUE(session_tick(&session, 1, SESSION_LIFE_US));
    TEST_ASSERT_FALSE(session.is_open);
    TEST_ASSERT_FALSE(session.has_challenge);
    TEST_ASSERT_EQUAL_UINT32(0, session.silent_us);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &again)); /* without a challenge */
    session_challenge(&session, 54321);
    TEST_ASSERT_TRUE(challenge != session.challenge);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_life(&session, we, &again)); /* of the session before */
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STRANGER, session_command(&session, we, &late, order, 8));
    TEST_ASSERT_FALSE(session_tick(&session, 1, SESSION_LIFE_US));
}

static void test_refused_signs_do_not_keep_a_session(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    bool ended = false;
    for (uint32_t i = 0; i < 14u; i++) {
        brace_sign_t forged = sign_of(session_number(&session));
        forged.check++;
        (void)session_life(&session, we, &forged);
        (void)life(they);
        session_pass(&session, 10000);
        ended = session_tick(&session, 10000, SESSION_LIFE_US);
    }
    TEST_ASSERT_TRUE(ended);
}

static void test_a_guarded_board_without_a_key_refuses_everybody(void)
{
    session_start(&session, false, NULL, 77);
    session_challenge(&session, 1);
    TEST_ASSERT_EQUAL(BRACE_SETTING_NO_KEY, session.setting);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_NO_KEY, life(we));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_NO_KEY, command(we, 1));
    TEST_ASSERT_FALSE(session_may_move(&session));
}

static void test_on_a_bench_a_command_waits_for_a_sign_of_life(void)
{
    bench();
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
    TEST_ASSERT_FALSE(session_may_move(&session));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, life(they));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_command(&session, they, NULL, order, 8));
    TEST_ASSERT_FALSE(session_may_move(&session));
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_TRUE(session_may_move(&session));
    TEST_ASSERT_TRUE(session_tick(&session, SESSION_LIFE_US + 1, SESSION_LIFE_US));
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, they, NULL, order, 8));
}

/* A sign of life opens nothing on a bench, and none of before its owner's command counts for it. */
static void test_on_a_bench_a_command_opens_and_its_owner_lives_then(void)
{
    bench();
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_FALSE(session.is_open || session.is_alive);
    TEST_ASSERT_EQUAL(BRACE_OK, command_on_a_bench(we));
    TEST_ASSERT_FALSE(session_may_move(&session));
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_TRUE(session_may_move(&session));
}

static void test_who_hangs_up_is_the_owner_no_longer(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    TEST_ASSERT_EQUAL(BRACE_OK, command(we, 7));
    session_hang_up(&session);
    TEST_ASSERT_FALSE(session.is_open);
    session_challenge(&session, 99);
    TEST_ASSERT_EQUAL(BRACE_OK, life(elsewhere));
    TEST_ASSERT_EQUAL(BRACE_OK, command(elsewhere, 1)); /* numbers begin anew */
}

/* By hand, each thing that is written has a connection of its own. */
static void test_on_a_bench_another_connection_of_the_port_goes_on(void)
{
    const brace_who_t next = {BRACE_ASKER_CAN, 4};
    bench();
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
    session_hang_up(&session);
    TEST_ASSERT_TRUE(session.is_open);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, life(elsewhere)); /* not of another port */
    TEST_ASSERT_EQUAL(BRACE_OK, life(they));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, life(next)); /* they have not hung up */
    session_end(&session);
    session_hang_up(&session); /* of a session that is over: the next owner has hung up nothing */
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, we, NULL, order, 8));
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_command(&session, they, NULL, order, 8));
}

static void test_a_board_that_becomes_a_bench_is_open_to_all(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    session_become_bench(&session);
    TEST_ASSERT_FALSE(session.is_open);
    TEST_ASSERT_FALSE(session.has_challenge);
    TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, they, NULL, order, 8));
    TEST_ASSERT_EQUAL(BRACE_OK, life(they));
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
    TEST_ASSERT_EQUAL(BRACE_OK, life(we));
    session_become_bench(&session);
    TEST_ASSERT_FALSE(session.has_challenge || session.is_open || session.is_alive);
}

/* An owner that hung up may come back. Until then nobody else on its port acts in its place. */
static void test_an_owner_that_comes_back_has_not_hung_up(void)
{
    for (int by_life = 0; by_life < 2; by_life++) {
        bench();
        TEST_ASSERT_EQUAL(BRACE_OK, session_command(&session, elsewhere, NULL, order, 8));
        session_hang_up(&session);
        TEST_ASSERT_TRUE(session.has_hung_up);
        TEST_ASSERT_EQUAL(BRACE_OK,
                          by_life != 0 ? life(elsewhere) : session_command(&session, elsewhere, NULL, order, 8));
        TEST_ASSERT_FALSE(session.has_hung_up);
        const brace_who_t neighbour = {elsewhere.port, elsewhere.master + 1u};
        TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, life(neighbour));
        TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, session_command(&session, neighbour, NULL, order, 8));
        session_hang_up(&session);
        TEST_ASSERT_EQUAL(BRACE_OK, life(neighbour));
        TEST_ASSERT_EQUAL(neighbour.master, session.owner.master);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_number_is_good_for_a_short_time);
    RUN_TEST(test_numbers_grow_old_while_the_processor_stands_still);
    RUN_TEST(test_a_number_counts_once_and_none_before_it);
    RUN_TEST(test_the_board_s_own_silence_is_the_numbers_too);
    RUN_TEST(test_no_number_comes_again);
    RUN_TEST(test_half_a_number_is_checked_as_a_whole);
    RUN_TEST(test_a_motion_begins_with_its_own_number);
    RUN_TEST(test_a_motion_waits_for_as_long_as_an_owner_may_be_silent);
    RUN_TEST(test_each_motion_has_its_own_number);
    RUN_TEST(test_a_session_opens_with_the_check_of_its_challenge);
    RUN_TEST(test_without_the_key_nothing_opens);
    RUN_TEST(test_a_challenge_without_a_session_is_renewed);
    RUN_TEST(test_counters_only_rise);
    RUN_TEST(test_the_last_number_has_no_next_one);
    RUN_TEST(test_each_session_has_its_own_challenge);
    RUN_TEST(test_a_session_that_ends_takes_its_counters_along);
    RUN_TEST(test_low_bits_stand_for_the_next_number_that_has_them);
    RUN_TEST(test_the_check_is_over_counter_kind_and_command);
    RUN_TEST(test_one_of_several_seals_has_to_fit);
    RUN_TEST(test_there_is_one_owner_at_a_time);
    RUN_TEST(test_silence_ends_a_session_and_its_seals);
    RUN_TEST(test_refused_signs_do_not_keep_a_session);
    RUN_TEST(test_a_guarded_board_without_a_key_refuses_everybody);
    RUN_TEST(test_on_a_bench_a_command_waits_for_a_sign_of_life);
    RUN_TEST(test_on_a_bench_a_command_opens_and_its_owner_lives_then);
    RUN_TEST(test_who_hangs_up_is_the_owner_no_longer);
    RUN_TEST(test_on_a_bench_another_connection_of_the_port_goes_on);
    RUN_TEST(test_a_board_that_becomes_a_bench_is_open_to_all);
    RUN_TEST(test_a_bench_keeps_nothing_of_the_guard);
    RUN_TEST(test_an_owner_that_comes_back_has_not_hung_up);
    return UNITY_END();
}
