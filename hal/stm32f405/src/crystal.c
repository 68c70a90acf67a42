/* The crystal has stopped: the clock security system has put the processor on its own 16 MHz and calls this handler.
 * The PLL starts again from there, so that time and serial lines go on, to 1 %. CAN needs a better clock and stops. */
#include "brace_hal_stm32f405.h"
#include "can.h"
#include "clock.h"
#include "stm32f405_registers.h"
#include "watchdog.h"

void nmi_handler(void)
{
    REGISTER(RCC_BASE, RCC_CIR) |= RCC_CIR_CSSC; /* else the handler is called again at once */
    can_leave_bus();
    if (!clock_goes_on_without_crystal()) {
        processor_restart(0); /* nothing keeps time at 16 MHz; after the reset everything is set up for that */
    }
}
