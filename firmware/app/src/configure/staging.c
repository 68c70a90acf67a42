#include "configure/staging.h"

#include <string.h>

#include "configure/storing.h"

uint32_t staging_read(const brace_app_t *app, uint32_t index)
{
    const brace_parameters_t *set = app->staging.begun ? &app->staging.set : &app->parameters;
    uint32_t word;
    memcpy(&word, (const uint8_t *)set + 4u * index, sizeof word);
    return word;
}

void staging_keep(brace_app_t *app)
{
    app->staging.fed_us = app->last_us;
}

void staging_watch(brace_app_t *app)
{
    if (storing_busy(app)) {
        staging_keep(app);
    } else if (app->last_us - app->staging.fed_us >= BRACE_CONFIGURATION_PATIENCE_US) {
        (void)brace_app_configuration_leave(app);
    }
}

brace_status_t staging_open(brace_app_t *app)
{
    if (app->mode != BRACE_MODE_CONFIGURATION) {
        return BRACE_E_MODE;
    }
    staging_keep(app);
    return storing_busy(app) ? BRACE_E_UNSUPPORTED : BRACE_OK;
}

brace_status_t staging_write(brace_app_t *app, uint32_t index, uint32_t word)
{
    brace_status_t status = staging_open(app);
    if (status == BRACE_OK) {
        status = brace_parameter_in_range(index, word);
    }
    if (status != BRACE_OK) {
        return status;
    }
    if (!app->staging.begun) {
        app->staging.set = app->parameters;
        app->staging.begun = true;
    }
    memcpy((uint8_t *)&app->staging.set + 4u * index, &word, sizeof word);
    return BRACE_OK;
}

brace_status_t staging_commit(brace_app_t *app, uint32_t *wrong_index)
{
    const brace_status_t status = staging_open(app);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_parameters_t *set = app->staging.begun ? &app->staging.set : &app->parameters;
    /* each member is in its range: what is in force was judged at the start, what was written when it came */
    const brace_status_t together = brace_parameters_check_piece(set, BRACE_CHECK_TOGETHER, wrong_index);
    return together == BRACE_OK ? storing_commit(app, set) : together;
}
