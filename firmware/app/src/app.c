#include "brace/app.h"

#include "configure/configure.h"
#include "configure/keeping.h"
#include "configure/staging.h"
#include "configure/storing.h"
#include "measure/control.h"
#include "measure/loading.h"
#include "motion/command.h"
#include "motion/joints.h"
#include "motion/takeup.h"
#include "report/services.h"
#include "supervise/supervisor.h"

#define LATE_PERIODS 3u /* from tick to tick: more than two late */

static bool door_is_whole(const brace_hal_t *hal)
{
    return hal->now_us != NULL && hal->joint_read != NULL && hal->nvm_read != NULL && hal->nvm_write != NULL &&
           hal->nvm_erase != NULL && hal->watchdog_feed != NULL && hal->reset_cause != NULL && hal->crash_clear != NULL;
}

static void forget_samples(brace_app_t *app)
{
    const float unknown = __builtin_nanf("");
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        app->joint[i] = (brace_app_joint_t){.sample = {unknown, unknown, unknown, unknown, 0}};
    }
    app->posed = false;
}

brace_status_t brace_app_start(brace_app_t *app, const brace_hal_t *hal)
{
    if (app == NULL || hal == NULL) {
        return BRACE_E_NULL;
    }
    if (!door_is_whole(hal)) {
        return BRACE_E_PARAMETER;
    }
    *app = (brace_app_t){.hal = hal};
    forget_samples(app);
    storing_start(app);
    configure_begin(app, false);
    for (uint32_t i = 0; i < CONFIGURE_PIECES && configure_piece(app); i++) {
    }
    if (hal->reset_cause(hal->context) == BRACE_RESET_FAULT) {
        supervisor_latch(app, BRACE_FAULT_CRASHED);
    }
    app->last_us = hal->now_us(hal->context);
    services_start(app);
    app->next = 1;
    control_blank(app, &app->snapshot[app->newest]);
    return BRACE_OK;
}

/* The mode in which parameters are stored and put in force: nothing is computed beside it. */
static void configuration_tick(brace_app_t *app, uint32_t now_us, bool works)
{
    brace_snapshot_t *snapshot = &app->snapshot[app->next];
    app->k = (brace_app_k_t){0}; /* what is left of it is of another set */
    control_blank(app, snapshot);
    command_send(app, snapshot);
    if (works && !configure_piece(app)) {
        storing_step(app);
        joints_read(app, now_us);
    }
    staging_watch(app);
    supervisor_faults(app, false); /* an erase takes its time */
    control_stamp(app, snapshot);
    control_publish(app);
}

/* K in one tick, or pieces of it. A snapshot waits for its K while others are sensed; what it says of mode and faults
 * is of its own tick, and a mode that has changed since makes it void. */
static void compute(brace_app_t *app, uint32_t pieces)
{
    brace_app_k_t *k = &app->k;
    if (pieces == (uint32_t)SERVICES_K_WHOLE) {
        pieces = CONTROL_PIECES;
        k->advances = false;
    }
    if (pieces > 0u && k->advances) {
        loading_advance(app, brace_app_snapshot(app));
        k->advances = false;
        pieces--;
    }
    for (; pieces > 0u && !k->told; pieces--) {
        k->told = control_piece(app);
    }
}

static void publish(brace_app_t *app, bool whole)
{
    brace_snapshot_t *snapshot = &app->snapshot[app->next];
    brace_app_k_t *k = &app->k;
    if (k->is_fresh) {
        control_stamp(app, snapshot);
    }
    if (snapshot->mode != app->mode) {
        k->done = 0;
    } else if (k->told) {
        control_publish(app);
        k->waits = 0;
        k->advances = !whole && app->loading.phase != LOADING_IDLE;
    }
    k->told = false;
    k->waits = (uint8_t)(k->waits + (k->waits < UINT8_MAX));
}

static void control_tick(brace_app_t *app, uint32_t now_us, bool late, uint32_t pieces)
{
    const bool reads = app->loading.phase == LOADING_READ, whole = pieces == (uint32_t)SERVICES_K_WHOLE && !reads;
    brace_app_k_t *k = &app->k;
    k->done = whole || reads ? 0u : k->done;
    k->is_fresh = k->done == 0u;
    brace_snapshot_t *sensed = &app->snapshot[k->is_fresh ? app->next : control_spare(app)];
    control_sense(app, now_us, sensed);
    if (reads) {
        loading_piece(app);
    } else {
        compute(app, pieces);
    }
    takeup_advance(app, sensed);
    if (whole) {
        loading_advance(app, sensed);
    }
    supervisor_faults(app, late);
    supervisor_mode(app);
    command_send(app, sensed);
    if (!reads) {
        publish(app, whole);
    }
}

static services_room_t room_of(const brace_app_t *app)
{
    const uint8_t phase = app->loading.phase;
    if (app->mode == BRACE_MODE_CONFIGURATION) {
        return storing_busy(app) ? SERVICES_BESIDE_A_PIECE : SERVICES_BESIDE_LITTLE;
    }
    return phase < LOADING_READ || phase > LOADING_TELL || app->k.blind ? SERVICES_BESIDE_K
           : phase == LOADING_READ                      ? SERVICES_BESIDE_A_READING
           : phase == LOADING_COMPARE                   ? SERVICES_BESIDE_MUCH
                                                        : SERVICES_BESIDE_SOME;
}

/* A tick that senses nothing, for what is as dear as sensing: the joints' filters bear a missed one, and the next tick
 * senses. A loading test's piece, Modbus, or K of the samples that the last tick took. */
static void blind_tick(brace_app_t *app, bool late, services_room_t room, uint32_t pieces)
{
    brace_app_k_t *k = &app->k;
    supervisor_late(app, late);
    if (room != SERVICES_BESIDE_K) {
        if (pieces > 0u) {
            loading_piece(app);
        }
    } else if (!app->modbus.serves) {
        if (!k->is_fresh) { /* another waits: the later one goes first */
            app->next = control_spare(app);
            k->is_fresh = true;
            k->done = 0;
        }
        compute(app, SERVICES_K_WHOLE);
        loading_advance(app, &app->snapshot[app->next]);
        publish(app, true);
    }
}

void brace_app_tick(brace_app_t *app, uint32_t now_us)
{
    const bool late = app->ticked && now_us - app->last_us > LATE_PERIODS * app->tick_us;
    app->counters.ticks_late += late && app->counters.ticks_late < UINT32_MAX;
    app->last_us = now_us;
    app->ticked = true;
    const services_room_t room = room_of(app);
    const uint32_t pieces = services_listen(app, room);
    const bool may_be_blind = !app->k.blind;
    app->k.blind = false;
    if (app->mode == BRACE_MODE_CONFIGURATION) {
        configuration_tick(app, now_us, pieces > 0u);
    } else if (pieces == (uint32_t)SERVICES_BLIND || room == SERVICES_BESIDE_SOME || room == SERVICES_BESIDE_MUCH) {
        blind_tick(app, late, room, pieces);
        app->k.blind = true;
    } else if (may_be_blind && app->keeping.look && keeping_due(app)) {
        supervisor_late(app, late);
        keeping_piece(app);
        app->k.blind = true;
    } else {
        control_tick(app, now_us, late, pieces);
    }
    services_run(app);
    app->hal->watchdog_feed(app->hal->context);
}

const brace_snapshot_t *brace_app_snapshot(const brace_app_t *app)
{
    return &app->snapshot[app->newest];
}

const brace_parameters_t *brace_app_parameters(const brace_app_t *app)
{
    return &app->parameters;
}

const brace_app_counters_t *brace_app_counters(const brace_app_t *app)
{
    return &app->counters;
}

const brace_store_t *brace_app_store(const brace_app_t *app)
{
    return &app->store;
}
