/* A stop is heard whatever else comes, and nobody's questions starve another's: judged by what the drives are told and
 * by counting frames.
 *
 *     build/host/tests/test_flood [TRIALS]     default 400; trust.md has the figure of 10,000
 *
 * Each trial has a limb on its way, whose owner gives its signs of life; then a bus as full as 1 Mbit/s carries it,
 * eight requests a millisecond; then one stop somewhere among them. After the second tick no set-point may change,
 * though the flood and the signs of life go on. */
#include <stdlib.h>

#include "attack.h"

enum {
    REQUESTS_PER_MS = 8,
    BURST_MOST = 500,
    TICKS_AFTER = 25,
    STANDS_WITHIN = 2 /* ticks, after the one that the stop came before */
};

static uint32_t trials = 400;
static uint64_t dice = 0x9e3779b97f4a7c15u;

void setUp(void) {}
void tearDown(void) {}

static uint32_t below(uint32_t n)
{
    dice ^= dice << 13;
    dice ^= dice >> 7;
    dice ^= dice << 17;
    return (uint32_t)((dice >> 32) * n >> 32);
}

/* ------------------------------------------------------------------------------------------- who floods -- */

typedef enum { K_QUESTIONS, ANY_QUESTIONS, ANY_REQUESTS, FORGED_SEALS, OTHER_NODES, FLOODS } flood_t;

static const char *const flood_name[FLOODS] = {"questions for K", "any questions", "any requests", "forged seals",
                                               "requests to other nodes"};

static bool moves_or_stops(const uint8_t data[8])
{
    const uint32_t entry = (uint32_t)data[2] | (uint32_t)data[3] << 8;
    switch (data[0]) {
    case BRACE_REQUEST_TAKE_UP:
    case BRACE_REQUEST_LET_GO:
    case BRACE_REQUEST_LOADING_TEST_START:
    case BRACE_REQUEST_LOADING_TEST_STOP: return true;
    case BRACE_REQUEST_WRITE_ENTRY: return entry == COMMAND_ENTRY(stop) || entry == COMMAND_ENTRY(end_test);
    default: return false;
    }
}

/* Something that a stranger may send. Only the owner's own commands and a stop are left out: they would end the motion,
 * or begin another one. */
static void make_noise(flood_t flood, uint8_t data[8])
{
    static const uint8_t about_k[] = {BRACE_REQUEST_K_AT_POSTURE, BRACE_REQUEST_K_AT_TIP_KNEE_UP,
                                      BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, BRACE_REQUEST_K_IN_SPACE_AT_POSTURE};
    static const uint8_t questions[] = {BRACE_REQUEST_READ_ENTRY,   BRACE_REQUEST_IDENTIFY,
                                        BRACE_REQUEST_TIP_FORCE,    BRACE_REQUEST_DOWNLOAD_WORD,
                                        BRACE_REQUEST_CONTACT_FORCE, BRACE_REQUEST_FRICTION_MARGIN,
                                        BRACE_REQUEST_K_AT_POSTURE, BRACE_REQUEST_FETCH_ROW};
    do {
        for (int i = 0; i < 8; i++) {
            data[i] = (uint8_t)below(256);
        }
        switch (flood) {
        case K_QUESTIONS: data[0] = about_k[below(sizeof about_k)]; break;
        case ANY_QUESTIONS: data[0] = questions[below(sizeof questions)]; break;
        case FORGED_SEALS:
            if (below(2) == 0u) {
                const uint32_t entry = below(2) == 0u ? COMMAND_ENTRY(seal_mac) : COMMAND_ENTRY(life_mac);
                make_write(entry, below(UINT32_MAX), (counter + below(4)) & 0xffu, data);
                break;
            }
            data[0] = (uint8_t)(below(2) == 0u ? BRACE_REQUEST_LET_GO : BRACE_REQUEST_TAKE_UP);
            data[1] = (uint8_t)(counter + below(4));
            break;
        default: data[0] = (uint8_t)(1u + below(31)); break;
        }
        if (!is_guarded() && data[1] >> 4 == MASTER_OF_OPERATOR) {
            data[1] ^= 0x80u;
        }
    } while (moves_or_stops(data) && (data[0] == BRACE_REQUEST_LOADING_TEST_STOP ||
                                      data[0] == BRACE_REQUEST_WRITE_ENTRY));
}

static void frame_arrives(uint32_t id, const uint8_t *data, uint8_t length)
{
    brace_can_frame_t frame = {.id = id, .length = length};
    memcpy(frame.data, data, length);
    (void)brace_fake_frame_arrives(&fake, &frame);
}

static void noise_arrives(flood_t flood, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint8_t data[8];
        make_noise(flood, data);
        frame_arrives(flood == OTHER_NODES ? 2u + below(0x7feu) : 0x600u + NODE, data, 8);
    }
}

static void empty_the_bus(void)
{
    brace_can_frame_t frame;
    for (int i = 0; i < 3 && brace_fake_frame_take(&fake, &frame); i++) { /* as many as the STM32 has mailboxes */
    }
}

/* A millisecond of a full bus; the owner gives its sign of life in time. */
static void flooded_tick(flood_t flood, uint32_t noise)
{
    static uint32_t since;
    const bool lives = ++since >= 40u;
    noise_arrives(flood, noise / 2u);
    if (lives) {
        since = 0;
        sign_of_life();
    }
    noise_arrives(flood, noise > 0u ? noise - noise / 2u - lives : 0u);
    ticks(1);
    empty_the_bus();
}

/* ---------------------------------------------------------------------------------------------- trials -- */

typedef enum { BY_FRAME, BY_REQUEST, BY_ENTRY, BY_WAYS } by_t;

static void stop_arrives(by_t by)
{
    uint8_t data[8] = {BRACE_REQUEST_LOADING_TEST_STOP, (uint8_t)below(256)};
    switch (by) {
    case BY_FRAME: frame_arrives(1, data, (uint8_t)(below(2) == 0u ? 0u : below(9))); break;
    case BY_REQUEST: frame_arrives(0x600u + NODE, data, 8); break;
    default:
        make_write(COMMAND_ENTRY(stop), 0, below(256), data);
        frame_arrives(0x600u + NODE, data, 8);
    }
}

typedef struct {
    float offset_rad[BRACE_LINK_COUNT];
} set_points_t;

static set_points_t set_points(void)
{
    set_points_t points;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        points.offset_rad[i] = fake.joint[i].command.offset_rad;
    }
    return points;
}

static bool are_equal(const set_points_t *a, const set_points_t *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

static void begin_trial(bool guarded, bool in_space)
{
    has_coxa = in_space;
    start_limb(guarded, guarded ? the_key : NULL);
    fake.can_filters = true;
    if (guarded) {
        open_session();
    }
    begin_to_move();
}

/* returns after how many ticks the limb stood; STANDS_WITHIN + 1: later, or never */
static uint32_t stood_after(flood_t flood, by_t by, uint32_t flooded_ms, uint32_t burst)
{
    const uint32_t before = below(REQUESTS_PER_MS);
    set_points_t told = set_points();
    for (uint32_t i = 0; i < flooded_ms; i++) {
        flooded_tick(flood, REQUESTS_PER_MS);
    }
    for (uint32_t i = 0; i < burst / REQUESTS_PER_MS; i++) { /* a burst takes its time on the bus, too */
        flooded_tick(flood, REQUESTS_PER_MS);
    }
    const set_points_t then = set_points();
    if (flooded_ms + burst / REQUESTS_PER_MS > 0u) {
        TEST_ASSERT_FALSE_MESSAGE(are_equal(&told, &then), "the limb did not move before the stop");
    }
    noise_arrives(flood, before);
    stop_arrives(by);
    noise_arrives(flood, REQUESTS_PER_MS - 1u - before);
    uint32_t stood = 0;
    told = set_points();
    for (uint32_t i = 1; i <= TICKS_AFTER; i++) {
        flooded_tick(flood, i == 1u ? 0u : REQUESTS_PER_MS);
        const set_points_t now_told = set_points();
        stood = are_equal(&told, &now_told) ? stood : i;
        told = now_told;
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
        const set_points_t told = set_points();
        ticks(30);
        const set_points_t then = set_points();
        TEST_ASSERT_TRUE(are_equal(&told, &then));
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
    const set_points_t told = set_points();
    for (int i = 0; i < 40; i++) {
        ticks(1);
        const set_points_t then = set_points();
        TEST_ASSERT_TRUE(are_equal(&told, &then));
        empty_the_bus();
    }
    operator_lives = true;
    says(data);
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
        const set_points_t told = set_points();
        pass(10);
        const set_points_t then = set_points();
        TEST_ASSERT_EQUAL(row[i].stands, are_equal(&told, &then));
    }
}

int main(int count, char **arguments)
{
    trials = count > 1 ? (uint32_t)strtoul(arguments[1], NULL, 10) : trials;
    UNITY_BEGIN();
    RUN_TEST(test_a_stop_is_heard_in_every_flood_of_the_bus);
    RUN_TEST(test_a_ring_that_has_run_over_keeps_the_stop);
    RUN_TEST(test_a_command_from_before_a_stop_moves_nothing);
    RUN_TEST(test_who_a_stop_is_for);
    return UNITY_END();
}
