/* The controller's loop on a board of one's own: one tick a millisecond, and K each hundredth tick. */
#include <stdio.h>

#include "board.h"
#include "brace/app.h"
#include "brace/app_memory.h"

enum { TELL_EVERY = 100, TICKS = 300 }; /* a real controller never ends */

static brace_app_t app; /* all memory of the controller, 20 kB */

int main(void)
{
    const brace_hal_t *const hal = board_start();
    const brace_status_t started = brace_app_start(&app, hal);
    if (started != BRACE_OK) {
        printf("the controller does not start: %d, see brace_status_t\n", (int)started);
        return 1;
    }
    const uint32_t tick_us = brace_app_parameters(&app)->controller.tick_us;
    uint32_t due_us = hal->now_us(hal->context);
    for (int tick = 1; tick <= TICKS; tick++) {
        while ((int32_t)(hal->now_us(hal->context) - due_us) < 0) {
        }
        brace_app_tick(&app, due_us);
        due_us += tick_us;
        if (tick % TELL_EVERY == 0) {
            const brace_snapshot_t *const now = brace_app_snapshot(&app);
            const brace_stiffness_t *const k = &now->stiffness.now;
            printf("valid %d flags 0x%02x faults 0x%x\n", now->k_is_valid, (unsigned)k->flags, (unsigned)now->faults);
            printf("k_xx %.5f k_xz %.5f k_zz %.5f N/mm\n", (double)k->k_xx_n_per_mm, (double)k->k_xz_n_per_mm,
                   (double)k->k_zz_n_per_mm);
        }
    }
    return 0;
}
