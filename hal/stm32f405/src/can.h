/* The CAN entries of brace_hal.h on bxCAN 1. */
#ifndef STM32F405_CAN_H
#define STM32F405_CAN_H

#include "brace_hal_stm32f405.h"

void can_use(const stm32f405_board_t *board);

/* Takes the controller off the bus at once: its clock has become too inexact. For the handler of the crystal's loss. It
 * stays off until can_setup; until then it reports bus_off. */
void can_leave_bus(void);

int32_t can_setup(void *context, const brace_can_setup_t *setup);
int32_t can_send(void *context, const brace_can_frame_t *frame);
int32_t can_receive(void *context, brace_can_frame_t *frame);
int32_t can_health(void *context, brace_can_health_t *health);
int32_t can_recover(void *context);

#endif
