/* All wires of the controller. A wire asks the controller through brace/requests.h and knows nothing else of it. Every
 * wire is independent of the others: what one is flooded with does not delay another. What is urgent overtakes on each
 * of them. */
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
    brace_measured_t measured; /* of the newest snapshot */
    uint32_t obeyed; /* how much wires_hear has done in this tick */
    bool has_burst;  /* a burst has come in this tick, and questions and jobs wait for the next one */
    uint8_t ticks_without_burst; /* [0, 2] */
    bool leaves_room; /* commands flood in, and this tick is the one in five that they leave to questions and jobs */
} wires_t;

/* Sets the ports up. Before the first tick; may block can_setup's 1 ms, twice where CAN FD is refused. */
void wires_start(wires_t *wires, const brace_hal_t *hal, const brace_parameters_t *parameters);

/* Before anything else in a tick: looks at all that has come over every port. Stops are obeyed first, then what belongs
 * to sessions; questions wait for wires_tick. */
void wires_hear(wires_t *wires, const brace_hal_t *hal, brace_app_t *app, brace_app_counters_t *counters,
                uint32_t now_us);

/* The end of a tick, after the snapshot has been published: every port answers a question and sends what is due.
 * Process data leave in ticks without answers, and one frame of them in each seventeenth tick in a row with answers.
 *   counters: where troubles are counted
 * returns how much all ports have done (wire.h), with wires_hear, and what can_speak counts */
uint32_t wires_tick(wires_t *wires, const brace_hal_t *hal, brace_app_t *app, brace_app_counters_t *counters,
                    uint32_t now_us);

/* Is the CAN controller off its bus? BRACE_FAULT_CAN_BUS_OFF */
bool wires_are_bus_off(const wires_t *wires);

#endif
