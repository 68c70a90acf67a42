/* The first file of a port to another chip: a board before anything is wired. It is built with every other image, so
 * that it always compiles. It starts, but prints nothing, because hal/blank has no console. */
#include "board.h"

#include "brace_hal_blank.h"
#include "fault.h"
#include "start.h"

enum { INTERRUPTS = 32 }; /* as many as the chip has */

typedef struct {
    uint32_t *stack_top;
    vector_t exceptions[15];
    vector_t interrupts[INTERRUPTS];
} vectors_t;

/* The HAL's handlers go in here by their numbers: [5] = uart0_handler, ... */
__attribute__((section(".vectors"), used)) static const vectors_t vectors = {
    _stack_top,
    {CORTEX_M_VECTORS},
    {[0 ... INTERRUPTS - 1] = UNEXPECTED},
};

/* The clock for a crash record: it reads one register, and returns 0 before the clock runs. */
uint32_t board_now_us(void)
{
    return 0u;
}

/* The second clock, by which the self-test judges now_us. */
uint32_t board_core_hz(void)
{
    return 1u;
}

const char *board_remark(void)
{
    return "nothing wired yet";
}

/* Set up clocks and pins first, and then the door: put kept_..., stack_unused_bytes and kept_restart of boards/common
 * behind its entries. */
void board_serve(void) {}

/* May sleep; need not. */
void board_rest(uint32_t at_most_us)
{
    (void)at_most_us;
}

const brace_hal_t *board_start(void)
{
    return brace_hal_blank();
}
