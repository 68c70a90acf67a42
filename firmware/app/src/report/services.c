#include "report/services.h"

#include "can/bus.h"
#include "can/cyclic.h"
#include "can/requests.h"
#include "measure/control.h"
#include "modbus/modbus.h"
#include "report/announce.h"

#define LINES_OF_ANSWERS 3u
#define LINES_OF_K 3u
#define K_WAITS_MOST 6u
#define TEST_WAITS_MOST 50u

/* Instructions at most, as tests/bench/tick_cost.py counts them; there the sum is held to 4,000. What is dearest by
 * itself seldom comes together: K costs most with one gap open, which is not where both joints' watching does. */
enum {
    ROOM = 3940,
    REST = 1530,       /* what every tick does: listening, samples, faults, drives, watchdog */
    MOVES = 200,       /* take-up, loading test */
    K_COLLAPSED = 700, K_GENERAL = 1100, K_ADVANCES = 40 /* beyond MOVES */, ADVANCES = 220 /* by itself */,
    K_PIECE = 435,     /* the dearest */
    ANSWER = 450, ANSWER_K_COLLAPSED = 450, ANSWER_K_GENERAL = 750, ANSWER_TIP = 380,
    SAYS_ANNOUNCES = 400, SAYS_BEGINS = 490, SAYS_GOES_ON = 250, SAYS_MORE = 130 /* each further frame */,
    HEARD = 560, TEXT = 110 /* a line of SLCAN read; written */
};
static const uint16_t play_costs[] = {0, 560, 1030}, k_play_costs[] = {0, 230, 80}; /* joints that are watched */

void services_start(brace_app_t *app)
{
    app->report = (brace_app_report_t){.beat_us = app->last_us};
    bus_start(app);
    requests_start(app);
    cyclic_configure(app);
    modbus_start(app);
}

static bool wants_to_say(const brace_app_t *app)
{
    return announce_wants(app) || cyclic_wants(app);
}

static uint32_t saying_costs(const brace_app_t *app)
{
    return announce_wants(app)     ? SAYS_ANNOUNCES
           : !cyclic_wants(app)    ? 0u
           : app->cyclic.due != 0u ? SAYS_GOES_ON
                                   : SAYS_BEGINS;
}

static uint32_t answer_costs(const brace_app_t *app)
{
    const uint32_t k = app->model.collapsed ? ANSWER_K_COLLAPSED : ANSWER_K_GENERAL;
    switch (app->requests.request[0]) {
    case BRACE_REQUEST_K_AT_TIP_KNEE_UP:
    case BRACE_REQUEST_K_AT_TIP_KNEE_DOWN: return k + ANSWER_TIP;
    case BRACE_REQUEST_K_AT_POSTURE: return k;
    default: return ANSWER;
    }
}

/* Modbus, whose own line takes milliseconds, has its turn where CAN asks nothing, or when it has had none for
 * some ticks; and then it waits until there is room.
 *   beside: what a request is not to be worked on at once for
 * returns what it costs */
static uint32_t choose_modbus(brace_app_t *app, uint32_t room, uint32_t beside)
{
    brace_app_modbus_t *modbus = &app->modbus;
    modbus->polls =
        (!app->bus.slcan.heard && !app->requests.serves) || modbus->waited >= (uint32_t)MODBUS_PATIENCE_TICKS;
    const bool wants = modbus->polls && modbus_poll(app, app->last_us);
    modbus->all = (uint32_t)MODBUS_ALL_COSTS + beside <= room;
    const uint32_t costs = !wants ? 0u : modbus->all ? (uint32_t)MODBUS_ALL_COSTS : modbus_costs(app);
    modbus->serves = wants && costs <= room;
    modbus->waited = modbus->polls && modbus->serves == wants ? 0u : (uint16_t)(modbus->waited + 1u);
    return modbus->serves ? costs : 0u;
}

/* Over SLCAN a tick says what it answers, or has a line: three of answers that are left, then one of the rest. */
static bool may_say(brace_app_t *app)
{
    brace_app_report_t *report = &app->report;
    const bool answers = app->requests.serves || app->requests.answer_count > 0u;
    if (!app->bus.slcan.open) {
        return true;
    }
    report->waited = (uint8_t)(answers && report->waited < LINES_OF_ANSWERS ? report->waited + 1u : 0u);
    return !app->modbus.serves && !app->requests.serves && report->waited == 0u;
}

/* The pieces of K that are next, as far as they fit. */
static uint32_t pieces_within(const brace_app_t *app, uint32_t room)
{
    static const uint16_t cost[][CONTROL_PIECES] = {{200, 170, 290, 300}, {430, 435, 290, 300}};
    const uint16_t *of_limb = cost[!app->model.collapsed];
    uint32_t pieces = 0;
    if (app->k.advances) {
        if (room < (uint32_t)ADVANCES) {
            return 0;
        }
        room -= ADVANCES;
        pieces++;
    }
    for (uint32_t i = app->k.done; i < (uint32_t)CONTROL_PIECES && of_limb[i] <= room; i++) {
        room -= of_limb[i];
        pieces++;
    }
    return pieces;
}

/* All but K, what is done over Modbus, and what is said. */
static uint32_t tick_costs(const brace_app_t *app, uint32_t plays, bool moves)
{
    const brace_app_slcan_t *slcan = &app->bus.slcan;
    return REST + play_costs[plays] + (moves ? MOVES : 0u) + (app->requests.serves ? answer_costs(app) : 0u) +
           (slcan->open ? app->report.lines * TEXT : 0u) + (slcan->heard ? HEARD : 0u);
}

/* A tick that senses nothing, for Modbus or for K of the last samples. */
static uint32_t blindly(brace_app_t *app, bool for_modbus)
{
    app->modbus.serves = for_modbus;
    app->modbus.waited = for_modbus ? 0u : app->modbus.waited;
    app->report.speaks = !for_modbus && wants_to_say(app) && may_say(app);
    return SERVICES_BLIND;
}

/* Whole, or pieces, or not: then others have the tick. They have no two of them in a row, and K comes within
 * K_WAITS_MOST, or the tick after. */
static uint32_t beside_k(brace_app_t *app)
{
    brace_app_report_t *report = &app->report;
    const bool tests = app->mode == BRACE_MODE_LOADING_TEST, moves = tests || app->mode == BRACE_MODE_TAKING_UP;
    const uint32_t plays = (uint32_t)app->play[0].watched + app->play[1].watched;
    const uint32_t k =
        (app->model.collapsed ? K_COLLAPSED : K_GENERAL) + k_play_costs[plays] + (tests ? K_ADVANCES : 0u);
    if (app->k.waits >= (uint8_t)K_WAITS_MOST && !app->k.blind) {
        return blindly(app, false);
    }
    uint32_t used = tick_costs(app, plays, moves);
    const bool is_on_its_way = app->k.done > 0u || app->k.advances || report->left_out > 0u; /* then K goes first */
    const uint32_t most = ROOM - (is_on_its_way ? (uint32_t)K_PIECE : 0u);
    used += choose_modbus(app, used < most ? most - used : 0u, k);
    if (app->modbus.waited >= (uint32_t)MODBUS_LONGEST_TICKS && !app->k.blind && modbus_costs(app) > 0u) {
        return blindly(app, true);
    }
    const uint32_t saying = saying_costs(app);
    report->speaks = saying > 0u && used + saying <= most && may_say(app);
    used += report->speaks ? saying : 0u;
    const uint32_t room = used < ROOM ? ROOM - used : 0u;
    const bool whole = k <= room;
    const uint32_t more = whole ? (room - k) / SAYS_MORE : 0u, frames = app->cyclic.frames_per_tick;
    report->frames = (uint8_t)(1u + more < frames ? 1u + more : frames);
    return whole ? (uint32_t)SERVICES_K_WHOLE : pieces_within(app, room);
}

/* A set of parameters goes on beside every answer; to Modbus, to text and to what is to be said it yields, but not
 * twice in a row. */
static uint32_t in_configuration(brace_app_t *app, bool works)
{
    brace_app_report_t *report = &app->report;
    const bool serves = app->requests.serves;
    const bool waits = app->bus.slcan.heard || (works && (serves || report->left_out > 0u));
    (void)choose_modbus(app, waits ? 0u : ROOM, 0);
    report->speaks = wants_to_say(app) && may_say(app) && !(works && (serves || report->left_out > 0u));
    const bool text = app->bus.slcan.heard || (app->bus.slcan.open && report->speaks);
    return works && (app->modbus.serves || text) && report->left_out == 0u ? 0u : (uint32_t)SERVICES_K_WHOLE;
}

/* A loading test's piece: an answer goes beside it, beside a reading if nothing is sensed. For the dearest question
 * beside the dearest piece the piece waits, and in the end it is refused. */
static uint32_t beside_test(brace_app_t *app, services_room_t room)
{
    brace_app_report_t *report = &app->report;
    const bool serves = app->requests.serves;
    app->modbus.polls = app->modbus.serves = false;
    report->speaks = !serves && wants_to_say(app) && may_say(app);
    if (room == SERVICES_BESIDE_MUCH && serves && answer_costs(app) > (uint32_t)ANSWER_K_GENERAL) {
        app->requests.refuses = report->test_waits >= TEST_WAITS_MOST;
        report->test_waits = (uint8_t)(app->requests.refuses ? 0u : report->test_waits + 1u);
        return app->requests.refuses ? (uint32_t)SERVICES_K_WHOLE : 0u;
    }
    report->test_waits = 0;
    return serves && room == SERVICES_BESIDE_A_READING ? (uint32_t)SERVICES_BLIND : (uint32_t)SERVICES_K_WHOLE;
}

uint32_t services_listen(brace_app_t *app, services_room_t room)
{
    uint32_t pieces;
    app->requests.refuses = false;
    app->requests.serves = requests_take(app);
    const bool asks_k = app->requests.serves && app->requests.request[0] == BRACE_REQUEST_K_AT_POSTURE;
    app->report.frames = 1;
    app->report.lines = asks_k && room < SERVICES_BESIDE_MUCH ? LINES_OF_K : 1u; /* other answers leave line by line */
    switch (room) {
    case SERVICES_BESIDE_K: pieces = beside_k(app); break;
    case SERVICES_BESIDE_LITTLE:
    case SERVICES_BESIDE_A_PIECE: pieces = in_configuration(app, room == SERVICES_BESIDE_A_PIECE); break;
    default: pieces = beside_test(app, room); break;
    }
    app->report.left_out = pieces == 0u ? (uint8_t)(app->report.left_out + 1u) : 0u;
    return pieces;
}

void services_run(brace_app_t *app)
{
    bus_watch(app);
    if (app->requests.storing != 0u) {
        requests_end_storing(app);
    }
    if (app->requests.serves) {
        requests_serve(app);
    }
    if (app->modbus.serves) {
        modbus_serve(app, app->last_us, app->modbus.all);
    }
    if (!app->report.speaks || !app->bus.slcan.open) {
        requests_send(app);
    }
    if (!app->report.speaks) {
        return;
    }
    if (cyclic_is_stale(app)) {
        cyclic_configure(app);
    } else if (!announce(app) && bus_speaks(app)) {
        cyclic_send(app, app->report.frames);
    }
}
