/* What moves the limb: the answers to what brace/requests.h lets anybody ask for. What comes over a wire is judged at
 * once and begins when its owner's sign of life has come. What the program around the controller asks for begins at
 * once. */
#include <stddef.h>
#include <string.h>

#include "brace/requests.h"
#include "controller.h"

static brace_status_t may_take_up(const controller_t *controller, const asked_motion_t *motion)
{
    const brace_mode_t mode = controller->mode.now;
    if (mode != BRACE_MODE_MONITOR && mode != BRACE_MODE_TAKING_UP) {
        return BRACE_E_MODE;
    }
    if (controller->hal->joint_command == NULL) {
        return BRACE_E_UNSUPPORTED;
    }
    return takeup_may_request(&controller->takeup, &controller->flank, motion->joint, motion->flank);
}

static brace_status_t may_let_go(const controller_t *controller)
{
    const brace_mode_t mode = controller->mode.now;
    return mode == BRACE_MODE_TAKING_UP || mode == BRACE_MODE_LOADING_TEST ? BRACE_OK : BRACE_E_MODE;
}

static brace_status_t may_test(controller_t *controller, const asked_motion_t *motion)
{
    const brace_mode_t mode = controller->mode.now;
    const bool holds = mode == BRACE_MODE_TAKING_UP && takeup_holds(&controller->takeup, &controller->flank);
    if (loading_runs(&controller->loading) || !(mode == BRACE_MODE_MONITOR || holds)) {
        return BRACE_E_MODE;
    }
    if (controller->hal->joint_command == NULL) {
        return BRACE_E_UNSUPPORTED;
    }
    const loading_inputs_t inputs = controller_loading_inputs(controller, &controller->snapshot[controller->newest]);
    return loading_may_start(&controller->loading, &inputs, &motion->setup);
}

/* Is it possible now? */
static brace_status_t judge(controller_t *controller, const asked_motion_t *motion)
{
    switch (motion->kind) {
    case MOTION_TAKE_UP: return may_take_up(controller, motion);
    case MOTION_LET_GO: return may_let_go(controller);
    case MOTION_LOADING_TEST: return may_test(controller, motion);
    default: return loading_runs(&controller->loading) ? BRACE_OK : BRACE_E_MODE;
    }
}

static void begin_test(controller_t *controller, const brace_loading_setup_t *setup)
{
    const loading_inputs_t inputs = controller_loading_inputs(controller, &controller->snapshot[controller->newest]);
    (void)loading_start(&controller->loading, &inputs, setup);
    drift_job_end_run(&controller->drift);
    controller->mode.now = BRACE_MODE_LOADING_TEST;
}

/* What has been judged begins. */
static void begin(controller_t *controller, const asked_motion_t *motion)
{
    switch (motion->kind) {
    case MOTION_TAKE_UP:
        (void)takeup_request(&controller->takeup, &controller->flank, motion->joint, motion->flank);
        controller->mode.now = BRACE_MODE_TAKING_UP;
        break;
    case MOTION_LET_GO:
        loading_end(&controller->loading, BRACE_LOADING_STOPPED);
        takeup_let_go(&controller->takeup);
        break;
    case MOTION_LOADING_TEST: begin_test(controller, &motion->setup); break;
    default: loading_end(&controller->loading, BRACE_LOADING_STOPPED); break;
    }
    ownership_begin(&controller->ownership);
}

void controller_begin(controller_t *controller)
{
    controller->ownership.is_by_wire = true;
    if (judge(controller, &controller->asked) == BRACE_OK) {
        begin(controller, &controller->asked);
    }
    controller->ownership.is_by_wire = false;
}

static brace_status_t ask_for(brace_app_t *app, const asked_motion_t *motion)
{
    controller_t *controller = controller_of(app);
    const brace_status_t status = judge(controller, motion);
    if (status != BRACE_OK) {
        return status;
    }
    const session_t *session = &controller->ownership.session;
    const bool still_waits = controller->ownership.waits && (session->has_begin || session->has_begun);
    /* it came twice */
    const bool waits_already = still_waits && memcmp(motion, &controller->asked, sizeof *motion) == 0;
    if (controller->ownership.is_by_wire && !waits_already) {
        controller->asked = *motion;
        ownership_wait(&controller->ownership);
    } else if (!controller->ownership.is_by_wire) {
        begin(controller, motion);
    }
    return BRACE_OK;
}

brace_status_t brace_app_take_up(brace_app_t *app, int32_t joint_index, int32_t flank)
{
    const asked_motion_t motion = {.kind = MOTION_TAKE_UP, .joint = joint_index, .flank = flank};
    return app == NULL ? BRACE_E_NULL : ask_for(app, &motion);
}

brace_status_t brace_app_let_go(brace_app_t *app)
{
    const asked_motion_t motion = {.kind = MOTION_LET_GO};
    return app == NULL ? BRACE_E_NULL : ask_for(app, &motion);
}

brace_status_t brace_app_loading_start(brace_app_t *app, const brace_loading_setup_t *setup)
{
    if (app == NULL || setup == NULL) {
        return BRACE_E_NULL;
    }
    const asked_motion_t motion = {.kind = MOTION_LOADING_TEST, .setup = *setup};
    return ask_for(app, &motion);
}

brace_status_t brace_app_loading_stop(brace_app_t *app)
{
    const asked_motion_t motion = {.kind = MOTION_END_TEST};
    return app == NULL ? BRACE_E_NULL : ask_for(app, &motion);
}

brace_status_t brace_app_stop(brace_app_t *app)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    controller_t *controller = controller_of(app);
    const bool runs = brace_app_moves(app);
    if (!runs && !controller->ownership.waits) {
        return BRACE_E_MODE;
    }
    ownership_stop(&controller->ownership, runs);
    loading_end(&controller->loading, BRACE_LOADING_STOPPED);
    return BRACE_OK;
}
