/* The node on CAN: over the board's CAN controller, and as text over a serial port (SLCAN).
 *
 * These are two ports that carry the same frames, and neither waits for the other. All that has come is looked at in
 * every tick, before anything else: a stop is obeyed at once, and what belongs to a session goes before questions. Of
 * the questions each port answers one in a tick, of its masters in turn. Each port has its own process data, heartbeats
 * and emergencies. One tick makes two frames of process data at most, and the ports have the first choice in turns.
 * Process data wait in a tick in which a request is answered, on whatever wire, at most 8 ticks in a row. A port
 * without room for an answer lets questions wait in their queues until there is room again. A question whose master's
 * queue is full is refused as BRACE_REFUSED_CROWDED, or counted where even that finds no room.
 *
 * A frame of the identifier controller.stop_id, whatever is in it, stops every limb of the bus, also one whose number
 * is not set. As text it stops the limb also while the channel is closed.
 *
 * A node whose number is not set (0) only listens on CAN and says nothing by itself. It answers requests to node 0 that
 * come as text, since the serial port has one other end; so a board is given its number.
 *
 * One caller, the tick; no pointer may be null. Costs are instructions on a Cortex-M4F, the hardware layer excluded. */
#ifndef BRACE_WIRE_CAN_CAN_H
#define BRACE_WIRE_CAN_CAN_H

#include "brace/parameters.h"
#include "brace/snapshot.h"
#include "brace_hal.h"
#include "wire/can/announce.h"
#include "wire/can/bus.h"
#include "wire/can/process.h"
#include "wire/can/requests.h"
#include "wire/slcan/slcan.h"
#include "wire/wire.h"

/* What belongs to one port. */
typedef struct {
    can_requests_t requests;
    announce_t announce;
    process_t process;
} can_port_t;

typedef struct {
    uint8_t node_id;         /* [0, 127]; 0: not set */
    uint32_t bit_rate;       /* [bit/s] */
    can_bus_t bus;
    slcan_t text;
    bool text_first;         /* in the last tick the text port spoke before the bus did */
    uint8_t ticks_to_room;   /* until sessions leave a tick to questions and jobs [0, 4] */
    uint16_t sorted;         /* frames and lines that have come in this tick */
    uint8_t data_waited;     /* ticks in a row in which process data have waited for answers */
    uint32_t data_done;      /* in this tick, by process_tick */
    can_port_t bus_port;
    can_port_t text_port;
} can_t;

/* Sets both ports up. Node number and bit rates stay those of the start. Before the first tick; may block as
 * can_bus_start. */
void can_start(can_t *can, const brace_hal_t *hal, const brace_parameters_t *parameters);

/* Before anything else in a tick: looks at all that has come over both ports. A stop is obeyed at once, every other
 * request waits in its queue. At most 72 frames and 512 lines: 75 instructions a frame, 400 a line.
 * returns whether there was a stop */
bool can_hear(can_t *can, const wire_tick_t *tick);

/* A stop has come by whatever port. What waits in the queues counts as older, since a stop overtakes, and begins
 * nothing any more. */
void can_stop(can_t *can);

/* Have more frames and lines come in this tick than the bus carries: a burst, after the processor stood still? */
bool can_has_burst(const can_t *can, const wire_tick_t *tick);

/* Behind it: obeys what belongs to a session, at most eleven requests of each port for each millisecond of a tick; one
 * in each fifth tick, one behind a burst of frames, and two thirds of them where another wire has a burst.
 *   is_burst: there is one
 * returns how much both have done (wire/wire.h) */
uint32_t can_obey(can_t *can, const wire_tick_t *tick, bool is_burst);

/* Is this the tick in five in which questions and jobs go on, whatever floods the ports? */
static inline bool can_leaves_room(const can_t *can)
{
    return can->ticks_to_room == 0u;
}

/* Does anything of a session wait for the next tick? */
static inline bool can_session_waits(const can_t *can)
{
    return can->bus_port.requests.queue.session_count > 0u || can->text_port.requests.queue.session_count > 0u;
}

/* At the end of the tick: answers a question of each port.
 *   has_room: questions may be answered; else they wait
 * returns how much both have done (wire/wire.h) */
uint32_t can_answer(can_t *can, const wire_tick_t *tick, bool has_room);

/* Then: sends what is due.
 *   most: frames of process data that may leave, at most PROCESS_FRAMES_PER_TICK; 0: they wait, but not for more than
 *     8 ticks in a row; then one leaves
 * Both halves take about 300 instructions when nothing happens. A request adds what its answer costs, each frame sent
 * 160, as text 380.
 * returns how much it has done for process data: frames that have left, and what process_tick has done */
uint32_t can_speak(can_t *can, const wire_tick_t *tick, uint32_t most);

/* Has the CAN controller left the bus? */
bool can_is_bus_off(const can_t *can);

#endif
