/* All wires of the controller. A wire asks the controller through brace/requests.h and knows nothing else of it. Every
 * wire is independent of the others: what one is flooded with does not delay another. */
#ifndef BRACE_WIRE_WIRES_H
#define BRACE_WIRE_WIRES_H

#include "brace_hal.h"
#include "brace/requests.h"
#include "wire/can/can.h"
#include "wire/measured.h"
#include "wire/modbus/modbus.h"

typedef struct {
    can_t can;       /* CAN, and the same frames as text over a serial port (SLCAN) */
    modbus_t modbus; /* a serial line (RTU) and TCP connections */
    brace_measured_t measured; /* of this tick */
} wires_t;

/* Sets the ports up. Before the first tick; may block can_setup's 1 ms, twice where CAN FD is refused. */
void wires_start(wires_t *wires, const brace_hal_t *hal, const brace_parameters_t *parameters);

/* One tick, after the snapshot has been published: every port takes what has come, answers it, and sends what is due.
 * Process data leave in ticks without answers, and one frame of them in each seventeenth tick in a row with answers.
 *   counters: where troubles are counted
 * returns how much all ports have done (wire.h), and what can_speak counts */
uint32_t wires_tick(wires_t *wires, const brace_hal_t *hal, brace_app_t *app, brace_app_counters_t *counters,
                    uint32_t now_us);

/* Is the CAN controller off its bus? BRACE_FAULT_CAN_BUS_OFF */
bool wires_are_bus_off(const wires_t *wires);

#endif
