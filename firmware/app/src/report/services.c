#include "report/services.h"

#include "report/announce.h"

#define FRAMES_PER_TICK 10 /* more than a full bus brings in a millisecond */

static void count_strangers(brace_app_t *app)
{
    brace_can_frame_t frame;
    for (int i = 0; i < FRAMES_PER_TICK && app->hal->can_receive(app->hal->context, &frame) == 1; i++) {
        app->counters.frames_unknown += app->counters.frames_unknown < UINT32_MAX;
    }
}

void services_run(brace_app_t *app)
{
    announce(app);
    if (app->report.listens) {
        count_strangers(app);
    }
}
