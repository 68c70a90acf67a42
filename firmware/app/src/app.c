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
    control_blank(app, &app->snapshot[0]);
    app->snapshot[0].taken_us = app->last_us;
    return BRACE_OK;
}

/* The mode in which parameters are stored and put in force: nothing is computed beside it. */
static void configuration_tick(brace_app_t *app, uint32_t now_us, bool lean, brace_snapshot_t *snapshot)
{
    control_blank(app, snapshot);
    command_send(app, snapshot);
    if (!lean && !configure_piece(app)) {
        storing_step(app);
        joints_read(app, now_us);
    }
    staging_watch(app);
    supervisor_faults(app, false); /* an erase takes its time */
    control_seal(app, snapshot);
}

/* lean: K is left out for what services have to do. */
static void control_tick(brace_app_t *app, uint32_t now_us, bool late, bool lean, brace_snapshot_t *snapshot)
{
    const bool reads = app->loading.phase == LOADING_READ;
    const bool piece = reads || lean;
    control_sense(app, now_us, snapshot);
    if (reads) {
        loading_piece(app);
    } else if (!lean) {
        control_stiffness(app, snapshot);
    }
    takeup_advance(app, snapshot);
    if (!piece) {
        loading_advance(app, snapshot);
    }
    supervisor_faults(app, late);
    supervisor_mode(app);
    command_send(app, snapshot);
    if (!piece) {
        control_seal(app, snapshot);
    }
}

static services_room_t room_of(const brace_app_t *app)
{
    const bool measures = app->loading.phase >= LOADING_READ && app->loading.phase <= LOADING_COMPARE;
    if (app->mode == BRACE_MODE_CONFIGURATION) {
        return storing_busy(app) ? SERVICES_BESIDE_A_PIECE : SERVICES_BESIDE_LITTLE;
    }
    return measures ? SERVICES_BESIDE_LITTLE : SERVICES_BESIDE_K;
}

void brace_app_tick(brace_app_t *app, uint32_t now_us)
{
    brace_snapshot_t *next = &app->snapshot[app->newest ^ 1u];
    const bool late = app->ticked && now_us - app->last_us > LATE_PERIODS * app->tick_us;
    app->counters.ticks_late += late && app->counters.ticks_late < UINT32_MAX;
    app->last_us = now_us;
    app->ticked = true;
    const bool lean = services_listen(app, room_of(app));
    if (app->mode == BRACE_MODE_CONFIGURATION) {
        configuration_tick(app, now_us, lean, next);
    } else if (app->loading.phase >= LOADING_DRIFT && app->loading.phase <= LOADING_COMPARE) {
        supervisor_late(app, late);
        loading_piece(app); /* as dear as a whole tick: the joints' filters bear a missed one */
    } else if (app->keeping.look && keeping_due(app)) {
        supervisor_late(app, late);
        keeping_piece(app);
    } else {
        control_tick(app, now_us, late, lean, next);
    }
    services_run(app, lean);
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
