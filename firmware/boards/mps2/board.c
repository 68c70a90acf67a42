/* The emulated MPS2 board, AN386: its vector table, and joints that stand in for a limb. */
#include "board.h"

#include "brace_hal_mps2.h"
#include "fault.h"
#include "kept.h"
#include "kept_nvm.h"
#include "rest.h"
#include "stack.h"
#include "stand_in_joints.h"
#include "start.h"

enum { INTERRUPTS = 32 };

typedef struct {
    uint32_t *stack_top;
    vector_t exceptions[15];
    vector_t interrupts[INTERRUPTS];
} vectors_t;

__attribute__((section(".vectors"), used)) static const vectors_t vectors = {
    _stack_top,
    {CORTEX_M_VECTORS},
    {
        [0] = uart0_rx_handler,
        [1] = UNEXPECTED,
        [2] = uart1_rx_handler,
        [3] = UNEXPECTED,
        [4] = uart2_rx_handler,
        [5 ... INTERRUPTS - 1] = UNEXPECTED,
    },
};

uint32_t board_now_us(void)
{
    return mps2_now_us();
}

uint32_t board_core_hz(void)
{
    return MPS2_CORE_HZ;
}

const char *board_remark(void)
{
    return "emulated; joints stand in, non-volatile memory is RAM, no CAN";
}

static int32_t joint_read(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    (void)context;
    return stand_in_joint(joint_index, mps2_now_us(), joint);
}

void board_serve(void) {}

void board_rest(uint32_t at_most_us)
{
    rest_sleep(at_most_us);
}

const brace_hal_t *board_start(void)
{
    static brace_hal_t door;
    static mps2_board_t board = {
        .name = BRACE_BOARD_NAME,
        .watchdog = true,
        .joint_read = joint_read,
        .reset_cause = kept_reset_cause,
        .crash_read = kept_crash_read,
        .crash_clear = kept_crash_clear,
        .stack_unused_bytes = stack_unused_bytes,
        .restart = kept_restart,
    };
    board.nvm = kept_nvm_start(MPS2_NVM_BYTES);
    door = *brace_hal_mps2(&board);
    rest_start(&door, board_core_hz());
    return &door;
}
