#include "report/services.h"

#include "can/bus.h"
#include "can/cyclic.h"
#include "can/requests.h"
#include "modbus/modbus.h"
#include "report/announce.h"

#define MOST_YIELDED 4u /* ticks in a row without K */
#define LINES_OF_ANSWERS 3u

void services_start(brace_app_t *app)
{
    app->report = (brace_app_report_t){0};
    bus_start(app);
    requests_start(app);
    cyclic_configure(app);
    modbus_start(app);
}

static bool wants_to_say(const brace_app_t *app)
{
    return announce_wants(app) || cyclic_wants(app);
}

static bool moves(const brace_app_t *app)
{
    return app->mode == BRACE_MODE_TAKING_UP || app->mode == BRACE_MODE_LOADING_TEST;
}

/* The dearest question: K at a place of the tip. */
static bool locates(const brace_app_t *app)
{
    const uint32_t code = app->requests.request[0];
    return code == BRACE_REQUEST_K_AT_TIP_KNEE_UP || code == BRACE_REQUEST_K_AT_TIP_KNEE_DOWN;
}

/* Is the answer by itself too much beside K? Only where K takes the general path, or lines are text. */
static bool is_long(const brace_app_t *app)
{
    const bool plays = app->play[0].watched && app->play[1].watched;
    return app->bus.slcan.open || (locates(app) && moves(app)) ||
           (!app->model.collapsed && (plays || locates(app) || moves(app)));
}

/* Has an SLCAN line anything to do in this tick? */
static bool writes_text(const brace_app_t *app)
{
    return app->bus.slcan.open && (app->report.speaks || app->requests.answer_count > 0u);
}

/* No room beside the answer for a new set of process data: it begins in one of the next ticks. */
static bool fills_a_tick(const brace_app_t *app)
{
    return app->requests.serves && locates(app) && moves(app) && !app->model.collapsed && app->cyclic.due == 0u;
}

/* Does what was chosen go into a tick together with K, or with a piece of work? */
static bool is_too_much(const brace_app_t *app, services_room_t room)
{
    const bool answers = app->requests.serves, works = app->modbus.serves, says = app->report.speaks;
    switch (room) {
    case SERVICES_BESIDE_LITTLE: return false;
    case SERVICES_BESIDE_A_PIECE: return answers || works || app->bus.slcan.heard || writes_text(app);
    case SERVICES_BESIDE_K:
    default: break;
    }
    if (app->bus.slcan.heard && (works || writes_text(app) || (moves(app) && !app->model.collapsed))) {
        return true;
    }
    if (answers && (works || is_long(app) || (says && (moves(app) || locates(app))))) {
        return true;
    }
    if (works && (says || moves(app))) {
        return true;
    }
    return !app->model.collapsed && (works || (answers && (says || app->modbus.polls)));
}

/* Modbus, whose own line takes milliseconds, has its turn where CAN asks nothing, or when it has had none for
 * some ticks. */
static void choose_modbus(brace_app_t *app, bool may)
{
    brace_app_modbus_t *modbus = &app->modbus;
    modbus->polls = may && (!app->requests.serves || modbus->waited >= (uint32_t)MODBUS_PATIENCE_TICKS);
    modbus->serves = modbus->polls && modbus_poll(app, app->last_us);
    modbus->waited = modbus->polls ? 0u : (uint16_t)(modbus->waited + 1u);
}

/* Over SLCAN a tick has a line: three of answers, then one of the rest. */
static bool may_say(brace_app_t *app)
{
    brace_app_report_t *report = &app->report;
    const bool answers = app->requests.serves || app->requests.answer_count > 0u;
    if (!app->bus.slcan.open) {
        return true;
    }
    report->waited = (uint8_t)(answers && report->waited < LINES_OF_ANSWERS ? report->waited + 1u : 0u);
    return !app->modbus.serves && report->waited == 0u;
}

static void choose(brace_app_t *app, services_room_t room)
{
    brace_app_requests_t *requests = &app->requests;
    const bool piece = room == SERVICES_BESIDE_A_PIECE;
    requests->serves = requests_take(app);
    if (requests->serves && ((piece && requests->yielded > 0u) ||
                             (room == SERVICES_BESIDE_K && requests->yielded >= MOST_YIELDED && is_long(app)))) {
        requests->serves = false; /* it goes on waiting */
    }
    const bool little = room == SERVICES_BESIDE_LITTLE && app->mode != BRACE_MODE_CONFIGURATION;
    choose_modbus(app, !(little && requests->serves) && !app->bus.slcan.heard);
    app->report.speaks = wants_to_say(app) && may_say(app) && !(little && requests->serves) && !fills_a_tick(app);
}

bool services_listen(brace_app_t *app, services_room_t room)
{
    brace_app_requests_t *requests = &app->requests;
    choose(app, room);
    if (requests->yielded > 0u && is_too_much(app, room)) {
        app->modbus.serves = false;
        app->report.speaks = app->report.speaks && !requests->serves && !app->bus.slcan.heard;
    }
    const bool yields = is_too_much(app, room);
    requests->yielded = yields ? (uint8_t)(requests->yielded + 1u) : 0u;
    return yields;
}

/* Frames of process data that this tick has room for. */
static uint32_t room_to_say(const brace_app_t *app, bool lean)
{
    if (!lean || app->bus.slcan.open) {
        return app->cyclic.frames_per_tick;
    }
    if (app->modbus.serves || (app->requests.serves && locates(app))) {
        return 1;
    }
    return app->requests.serves ? 2u : 4u;
}

void services_run(brace_app_t *app, bool lean)
{
    bus_watch(app);
    if (app->requests.serves) {
        requests_serve(app);
    }
    if (app->modbus.serves) {
        modbus_serve(app, app->last_us);
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
        cyclic_send(app, room_to_say(app, lean));
    }
}
