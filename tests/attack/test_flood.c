/* A stop is heard whatever else comes, and nobody's questions starve another's: judged by what the drives are commanded
 * and by counting frames.
 *
 *     build/host/tests/test_flood [TRIALS]     default 400; trust.md has the figure of 10,000
 *
 * Each trial has a limb on its way, whose owner gives its signs of life; then a bus as full as 1 Mbit/s carries it,
 * eight requests a millisecond; then one stop somewhere among them. After the second tick no set-point may change,
 * though the flood and the signs of life go on. */
#include "flood.h"

void setUp(void) {}
void tearDown(void) {}

/* ---------------------------------------------------------------------------------------------- trials -- */

typedef enum { BY_FRAME, BY_REQUEST, BY_ENTRY, BY_WAYS } by_t;

static void stop_arrives(by_t by)
{
    uint8_t data[8] = {BRACE_REQUEST_LOADING_TEST_STOP, (uint8_t)below(256)};
    switch (by) {
    case BY_FRAME: frame_arrives(1, data, (uint8_t)(below(2) == 0u ? 0u : below(9))); break;
    case BY_REQUEST: frame_arrives(0x600u + NODE, data, 8); break;
    default: make_write(COMMAND_ENTRY(stop), 0, below(256), data); frame_arrives(0x600u + NODE, data, 8);
    }
}

/* returns after how many ticks the limb stood; STANDS_WITHIN + 1: later, or never */
static uint32_t stood_after(flood_t flood, by_t by, uint32_t flooded_ms, uint32_t burst)
{
    const uint32_t before = below(REQUESTS_PER_MS);
    set_points_t commanded = set_points();
    for (uint32_t i = 0; i < flooded_ms; i++) {
        flooded_tick(flood, REQUESTS_PER_MS);
    }
    for (uint32_t i = 0; i < burst / REQUESTS_PER_MS; i++) { /* a burst takes its time on the bus, too */
        flooded_tick(flood, REQUESTS_PER_MS);
    }
    const set_points_t then = set_points();
    if (flooded_ms + burst / REQUESTS_PER_MS > 0u) {
        TEST_ASSERT_FALSE_MESSAGE(are_equal(&commanded, &then), "the limb did not move before the stop");
    }
    noise_arrives(flood, before);
    stop_arrives(by);
    noise_arrives(flood, REQUESTS_PER_MS - 1u - before);
    uint32_t stood = 0;
    commanded = set_points();
    for (uint32_t i = 1; i <= TICKS_AFTER; i++) {
        flooded_tick(flood, i == 1u ? 0u : REQUESTS_PER_MS);
        const set_points_t now_commanded = set_points();
        stood = are_equal(&commanded, &now_commanded) ? stood : i;
        commanded = now_commanded;
    }
    return stood < STANDS_WITHIN ? stood : STANDS_WITHIN + 1u;
}

static void test_a_stop_is_heard_in_every_flood_of_the_bus(void)
{
    uint32_t heard[FLOODS] = {0}, played[FLOODS] = {0};
    for (uint32_t i = 0; i < trials; i++) {
        const flood_t flood = (flood_t)(i % FLOODS);
        const by_t by = (by_t)(i / FLOODS % BY_WAYS);
        begin_trial(below(2) == 0u, below(2) == 0u);
        const uint32_t burst = below(2) == 0u ? 0u : 8u + below(BURST_MOST - 7);
        played[flood]++;
        heard[flood] += stood_after(flood, by, below(40), burst) <= STANDS_WITHIN;
    }
    for (int flood = 0; flood < FLOODS; flood++) {
        printf("stop on CAN, %s: heard in %u of %u\n", flood_name[flood], (unsigned)heard[flood],
               (unsigned)played[flood]);
        TEST_ASSERT_EQUAL(played[flood], heard[flood]);
    }
}

/* A processor that has stood still finds its ring full: requests are lost then, and counted, but no stop. */
static void test_a_ring_that_has_run_over_keeps_the_stop(void)
{
    for (uint32_t i = 0; i < 20u; i++) {
        begin_trial(i % 2u == 0u, i % 4u < 2u);
        noise_arrives(ANY_QUESTIONS, BURST_MOST);
        stop_arrives(BY_FRAME);
        noise_arrives(ANY_QUESTIONS, BURST_MOST);
        TEST_ASSERT_GREATER_THAN(BURST_MOST, fake.can_health.frames_lost);
        const set_points_t commanded = set_points();
        ticks(30);
        const set_points_t then = set_points();
        TEST_ASSERT_TRUE(are_equal(&commanded, &then));
        TEST_ASSERT_EQUAL(fake.can_health.frames_lost, counters().frames_lost);
    }
}

/* What waits since before a stop begins nothing any more, and what comes behind it does. */
static void test_a_command_from_before_a_stop_moves_nothing(void)
{
    uint8_t data[8];
    begin_trial(false, false);
    make_let_go(data);
    data[1] = OPERATOR_TOKEN;
    for (int i = 0; i < 63; i++) {
        says(data);
    }
    stop_arrives(BY_FRAME);
    ticks(1);
    const set_points_t commanded = set_points();
    for (int i = 0; i < 40; i++) {
        ticks(1);
        const set_points_t then = set_points();
        TEST_ASSERT_TRUE(are_equal(&commanded, &then));
        empty_the_bus();
    }
    operator_lives = true;
    make_let_go(data);
    accepted_command(data);
    pass(300);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

/* A limb that waits for its number obeys a stop too; one whose stop has another number obeys that one alone. */
static void test_who_a_stop_is_for(void)
{
    static const struct {
        uint32_t stop_id, sent, stands;
    } row[] = {{1, 1, 1}, {1, 2, 0}, {0x7f, 0x7f, 1}, {0x7f, 1, 0}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        begin_trial(false, false);
        fake.can_filters = false; /* also what a filter lets through by mistake */
        app.wires.can.bus.setup.urgent_id = row[i].stop_id;
        fake.can_setup.urgent_id = row[i].stop_id;
        frame_arrives(row[i].sent, NULL, 0);
        const set_points_t commanded = set_points();
        pass(10);
        const set_points_t then = set_points();
        TEST_ASSERT_EQUAL(row[i].stands, are_equal(&commanded, &then));
    }
}

int main(int count, char **arguments)
{
    read_trials(count, arguments);
    UNITY_BEGIN();
    RUN_TEST(test_a_stop_is_heard_in_every_flood_of_the_bus);
    RUN_TEST(test_a_ring_that_has_run_over_keeps_the_stop);
    RUN_TEST(test_a_command_from_before_a_stop_moves_nothing);
    RUN_TEST(test_who_a_stop_is_for);
    return UNITY_END();
}
