/* The servos' line inside the layer; brace_hal_stm32f405.h has what a board calls. */
#ifndef STM32F405_SERVO_LINE_H
#define STM32F405_SERVO_LINE_H

#include <stdint.h>

/* As serial_finish. */
void servo_line_finish(uint32_t at_most_us);

#endif
