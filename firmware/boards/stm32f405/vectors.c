/* Vector table of the STM32F405 (RM0090, table 61). */
#include "brace_hal_stm32f405.h"
#include "start.h"

enum { INTERRUPTS = 82 };

typedef struct {
    uint32_t *stack_top;
    vector_t exceptions[15];
    vector_t interrupts[INTERRUPTS];
} vectors_t;

__attribute__((section(".vectors"), used)) static const vectors_t vectors = {
    _stack_top,
    {CORTEX_M_VECTORS_WITH_NMI(nmi_handler)},
    {
        [0 ... 19] = UNEXPECTED,
        [20] = can1_rx0_handler,
        [21 ... 36] = UNEXPECTED,
        [37] = usart1_handler,
        [38] = usart2_handler,
        [39] = usart3_handler,
        [40 ... 70] = UNEXPECTED,
        [71] = usart6_handler,
        [72 ... INTERRUPTS - 1] = UNEXPECTED,
    },
};
