/* A board's file before anything is wired: where a port to another chip starts. It is built with every other image, so
 * that it always compiles; it starts, and can say nothing, because hal/blank has no console. */
#include "board.h"

#include "brace_hal_blank.h"
#include "fault.h"
#include "start.h"

enum { INTERRUPTS = 32 }; /* as the chip has */

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

/* For a crash record: a register read, and 0 before the clock runs. */
uint32_t board_now_us(void)
{
    return 0u;
}

/* What the self-test judges now_us by. */
uint32_t board_core_hz(void)
{
    return 1u;
}

const char *board_remark(void)
{
    return "nothing wired yet";
}

/* Clocks, pins, and then the door: kept_..., stack_unused_bytes and kept_restart of boards/common
 * behind its entries. */
const brace_hal_t *board_start(void)
{
    return brace_hal_blank();
}
