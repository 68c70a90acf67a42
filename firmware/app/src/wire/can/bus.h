/* The board's CAN controller: frames in and out, its health, and the way back after bus off.
 *
 * One caller, the tick; no pointer may be null. Costs are instructions on a Cortex-M4F, the hardware layer excluded. */
#ifndef BRACE_WIRE_CAN_BUS_H
#define BRACE_WIRE_CAN_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"
#include "brace_hal.h"
#include "wire/wire.h"

typedef struct {
    bool is_fitted;           /* the board has CAN */
    bool is_there;            /* and it is set up */
    bool is_off;              /* the CAN controller has left the bus after too many errors, or does not reach it */
    brace_can_setup_t setup;  /* fd_bit_rate is 0 where the controller has no CAN FD */
    uint32_t health_us;       /* since its health was last asked for */
    uint32_t recover_us;      /* since it left the bus, or since recovery or set-up was last tried */
    uint32_t recover_wait_us; /* before it is tried again */
    uint32_t on_us;           /* since it is on the bus, up to 2 s */
    uint32_t frames_lost;     /* received frames that found no room, as the controller counts them */
} can_bus_t;

/* Sets the CAN controller up to receive stops and the requests to this node: listen only while the number is unset, and
 * with classic frames where it has no CAN FD. Before the first tick; may block can_setup's 1 ms twice. */
void can_bus_start(can_bus_t *bus, const brace_hal_t *hal, const brace_controller_t *parameters);

/* Looks after health and recovery, each tick: recovery is tried after 125 ms, then after twice as long each time, at
 * most 2 s, until it has been on the bus for 2 s. A set-up that failed is tried again every 2 s, which may block
 * can_setup's 1 ms. About 30 instructions. */
void can_bus_watch(can_bus_t *bus, const brace_hal_t *hal, uint32_t tick_us);

/* returns whether the frame has been taken; if not, it may be tried again at the next tick. About 30 instructions. */
bool can_bus_send(can_bus_t *bus, const wire_tick_t *tick, const brace_can_frame_t *frame);

/* returns whether a frame has come, whoever it is for. Inline, because a burst has 72 of them. */
static inline bool can_bus_receive(const can_bus_t *bus, const brace_hal_t *hal, brace_can_frame_t *frame)
{
    return bus->is_there && hal->can_receive(hal->context, frame) == 1;
}

#endif
