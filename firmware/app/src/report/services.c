#include "report/services.h"

#include "report/announce.h"

#define FRAMES_PER_TICK 4u /* the rest waits in the bus' own ring; what finds no room there is counted there */

static void count_strangers(brace_app_t *app)
{
    const brace_hal_t *hal = app->hal;
    brace_can_frame_t frame;
    uint32_t count = 0;
    while (count < FRAMES_PER_TICK && hal->can_receive(hal->context, &frame) == 1) {
        count++;
    }
    const uint32_t before = app->counters.frames_unknown;
    app->counters.frames_unknown = before + count >= before ? before + count : UINT32_MAX;
}

void services_run(brace_app_t *app)
{
    if (!announce(app) && app->report.listens) { /* frames that wait another tick lie in the bus' own ring */
        count_strangers(app);
    }
}
