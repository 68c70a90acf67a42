/* The way from reset to main, for controller images. A board's vector table begins with CORTEX_M_VECTORS. */
#ifndef BRACE_BOARDS_START_H
#define BRACE_BOARDS_START_H

#include <stdint.h>

typedef void (*vector_t)(void);

extern uint32_t _stack_top[];

void reset_handler(void);
void fault_handler(void);

/* The handler of interrupts that nobody has switched on. If one comes nevertheless, it is a fault with a record. */
#define UNEXPECTED fault_handler

/* Exceptions 1-15 in the order of the table. */
#define CORTEX_M_VECTORS CORTEX_M_VECTORS_WITH_NMI(fault_handler)
#define CORTEX_M_VECTORS_WITH_NMI(nmi) \
    reset_handler, nmi, fault_handler, fault_handler, fault_handler, fault_handler, 0, 0, 0, 0, UNEXPECTED, \
        UNEXPECTED, 0, UNEXPECTED, UNEXPECTED

#endif
