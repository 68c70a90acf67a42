/* All wires of the controller. A wire asks the controller through brace/requests.h and knows nothing else of it. Every
 * wire is independent of the others: what one is flooded with does not delay another. */
#ifndef BRACE_WIRE_WIRES_H
#define BRACE_WIRE_WIRES_H

#include "brace_hal.h"
#include "brace/requests.h"
#include "wire/can/can.h"
#include "wire/measured.h"
#include "wire/modbus/modbus.h"

/* How many requests there is room for in a tick: a job's part of a K takes their place. */
typedef enum {
    WIRES_ALL = 0, /* one on every port */
    WIRES_ONE,     /* those of one wire: CAN or Modbus, in turn; the other's wait for the next tick if it has any */
    WIRES_NONE     /* all wait for the next tick */
} wires_room_t;

typedef struct {
    can_t can;       /* CAN, and the same frames as text over a serial port (SLCAN) */
    modbus_t modbus; /* a serial line (RTU) and TCP connections */
    brace_measured_t measured; /* of this tick */
    bool can_is_first; /* of the two wires; they change places in each tick with room for one */
} wires_t;

/* Sets the ports up. Before the first tick; may block can_setup's 20 ms. */
void wires_start(wires_t *wires, const brace_hal_t *hal, const brace_parameters_t *parameters);

/* One tick, after the snapshot has been published: every port takes what has come, answers it, and sends what is due.
 *   counters: where troubles are counted
 * returns whether a request has been answered, or process data have left */
bool wires_tick(wires_t *wires, const brace_hal_t *hal, brace_app_t *app, brace_app_counters_t *counters,
                wires_room_t room, uint32_t now_us);

/* Do process data leave in the coming tick, whatever else there is to answer? (wire/can/can.h) */
bool wires_data_are_overdue(const wires_t *wires);

/* Is the CAN controller off its bus? BRACE_FAULT_CAN_BUS_OFF */
bool wires_are_bus_off(const wires_t *wires);

#endif
