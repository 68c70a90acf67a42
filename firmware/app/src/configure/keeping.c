#include "configure/keeping.h"

#include "supervise/supervisor.h"

#define KEEPING_EVIDENCE 4.0f /* of the 20 that are an alarm */
#define LEARNING_READINGS 512u
#define WATCHING_READINGS 4096u
#define EVERY_TICKS 8u
#define ROOM_FOR_ALARMS 2u /* records that are left for a change of the check's state */

static void remember(brace_app_keeping_t *keeping, const brace_drift_t *drift)
{
    keeping->state = drift->state;
    keeping->steps = drift->steps;
    for (int i = 0; i <= BRACE_DRIFT_CAUSE_COUNT; i++) {
        keeping->evidence[i] = drift->evidence[i];
    }
}

void keeping_open(brace_app_t *app, bool erased)
{
    const brace_drift_setup_t *setup = &app->drift.setup;
    const bool kept = app->origin == BRACE_PARAMETERS_SLOT_A || app->origin == BRACE_PARAMETERS_SLOT_B;
    const uint32_t slot = kept ? (uint32_t)app->origin - 1u : (uint32_t)BRACE_NVM_SLOT_COUNT;
    /* of the set, and of what this firmware tells the check beside it */
    const uint32_t identity = brace_crc32(app->parameter_crc, (const uint8_t *)setup, sizeof *setup);
    app->keeping.look = false;
    remember(&app->keeping, &app->drift);
    if (erased) {
        brace_journal_open_erased(&app->keeping.journal, app->hal, slot, identity);
    } else {
        brace_journal_open(&app->keeping.journal, app->hal, slot, identity);
    }
}

/* What a full journal holds is not kept up to date: its evidence may be of long ago. */
static void resume(brace_app_t *app)
{
    brace_drift_t *drift = &app->drift;
    (void)brace_drift_run(drift);
    if (brace_journal_room(&app->keeping.journal) <= ROOM_FOR_ALARMS && drift->state != BRACE_DRIFT_DRIFTED) {
        (void)brace_drift_reset(drift);
    }
    if (drift->state == BRACE_DRIFT_DRIFTED) {
        supervisor_latch(app, BRACE_FAULT_MODEL_DRIFT);
    }
    remember(&app->keeping, drift);
}

bool keeping_scan(brace_app_t *app)
{
    if (brace_journal_scan(&app->keeping.journal, &app->drift)) {
        return true;
    }
    if (app->keeping.journal.found) {
        resume(app);
    }
    return false;
}

void keeping_look(brace_app_t *app)
{
    app->keeping.look = true;
}

bool keeping_due(brace_app_t *app)
{
    brace_app_keeping_t *keeping = &app->keeping;
    if ((app->mode != BRACE_MODE_MONITOR && app->mode != BRACE_MODE_FAULT) || app->storing) {
        return false;
    }
    keeping->ticks = keeping->ticks + 1u < EVERY_TICKS ? (uint8_t)(keeping->ticks + 1u) : 0u;
    return keeping->ticks == 0u;
}

static bool worth_a_record(const brace_app_keeping_t *keeping, const brace_drift_t *drift)
{
    const bool changed = drift->state != keeping->state;
    const uint32_t every = drift->state == BRACE_DRIFT_LEARNING ? LEARNING_READINGS : WATCHING_READINGS;
    bool moved = drift->steps - keeping->steps >= every;
    for (int i = 0; i <= BRACE_DRIFT_CAUSE_COUNT; i++) {
        moved = moved || __builtin_fabsf(drift->evidence[i] - keeping->evidence[i]) >= KEEPING_EVIDENCE;
    }
    return changed || (moved && brace_journal_room(&keeping->journal) > ROOM_FOR_ALARMS);
}

void keeping_piece(brace_app_t *app)
{
    brace_app_keeping_t *keeping = &app->keeping;
    if (keeping->journal.state == BRACE_JOURNAL_BUSY) {
        if (brace_journal_step(&keeping->journal) == BRACE_JOURNAL_FAILED) {
            app->lasting_faults |= BRACE_FAULT_STORE;
            keeping->look = false;
        }
        return; /* once it stands there is another look: readings may have come meanwhile */
    }
    keeping->look = false;
    if (worth_a_record(keeping, &app->drift) && brace_journal_begin(&keeping->journal, &app->drift)) {
        remember(keeping, &app->drift);
        keeping->look = true;
    }
}
