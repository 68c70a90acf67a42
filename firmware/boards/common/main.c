/* The controller: prints who it is, starts the application, and runs its ticks. */
#include "banner.h"
#include "board.h"
#include "brace/app.h"
#include "brace/app_memory.h"
#include "console.h"

static brace_app_t app;
static console_t console;

static void open_console(const brace_hal_t *hal)
{
    const int32_t answer = hal->serial_setup(hal->context, BRACE_SERIAL_CONSOLE, BOARD_CONSOLE_BAUD, BRACE_PARITY_NONE);
    console.text.hal = hal;
    console.text.gone = answer != BRACE_HAL_OK;
}

/* A controller that cannot start prints why, again and again for whoever connects later. It does not reset in a
 * loop. */
static _Noreturn void explain(brace_status_t started)
{
    enum { REPEAT_US = 1000000 };
    const brace_hal_t *const hal = console.text.hal;
    uint32_t last_us = hal->now_us(hal->context);
    for (;;) { /* for ever: there is nothing to control */
        hal->watchdog_feed(hal->context);
        if (hal->now_us(hal->context) - last_us >= REPEAT_US) {
            last_us += REPEAT_US;
            text_again(&console.text);
            banner_image(&console.text);
            banner_application(&console.text, &app, started);
        }
    }
}

int main(void)
{
    const brace_hal_t *const hal = board_start();
    open_console(hal);
    banner_image(&console.text);
    const brace_status_t started = brace_app_start(&app, hal);
    banner_application(&console.text, &app, started);
    if (started != BRACE_OK) {
        explain(started);
    }
    text_keep(&console.text);
    uint32_t due_us = hal->now_us(hal->context);
    for (;;) { /* for ever: the controller */
        const uint32_t now_us = hal->now_us(hal->context);
        const uint32_t tick_us = brace_app_parameters(&app)->controller.tick_us;
        if ((int32_t)(now_us - due_us) >= 0) {
            brace_app_tick(&app, now_us); /* feeds the watchdog */
            due_us += tick_us;
            if ((int32_t)(now_us - due_us) >= 0) { /* late by a whole period: skip ticks instead of a burst */
                due_us = now_us + tick_us;
            }
        }
        board_serve();
        console_serve(&console, &app);
        const int32_t left_us = (int32_t)(due_us - hal->now_us(hal->context));
        if (left_us > 0) {
            board_rest((uint32_t)left_us);
        }
    }
}
