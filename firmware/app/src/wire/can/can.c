#include "wire/can/can.h"

#include <string.h>

#include "brace/can_frames.h"
#include "wire/answers/rank.h"

#define FRAMES_PER_TICK 72u /* looked at: a ring of 64, and what comes while it is emptied */
#define LINES_PER_TICK 512u /* the same as text: a board's line carries fewer, a host's TCP connection more */
#define SESSION_PER_MS 11u  /* requests of a session that are obeyed: more than 1 Mbit/s carries, which is 8 or 9 */
#define BURST_PER_MS 16u /* frames and lines; twice what a bus carries */
#define ROOM_TICKS 5u       /* in each fifth tick only one is, so that questions and jobs go on in any flood */
#define REFUSALS_PER_TICK 2u /* of questions too many; more of them are only counted */
#define NODE_MOST 127u
#define STORING_PARTS 2u /* of the answer to a commit, which comes by itself */
#define DATA_WAIT_MOST 8u /* ticks with answers in a row, in which no process data leave: four frames take 36 ticks */
#define ANSWERS_PER_TICK ((uint32_t)BRACE_CAN_ANSWER_PARTS_MOST + STORING_PARTS) /* frames that a tick can add */
#define ROOM_FOR_REFUSALS 8u /* frames of room that refusals of questions leave to other answers */
#define TEXT_ANSWERS_PER_TICK 5u /* frames as text, which cost twice as much: all of an answer, if it is not about K */

typedef enum { ON_BUS, AS_TEXT } way_t;

void can_start(can_t *can, const brace_hal_t *hal, const brace_parameters_t *parameters)
{
    *can = (can_t){.node_id = (uint8_t)parameters->controller.node_id, .bit_rate = parameters->controller.can_bit_rate};
    can_bus_start(&can->bus, hal, &parameters->controller);
    slcan_start(&can->text, hal, parameters->controller.stop_id);
}

bool can_is_bus_off(const can_t *can)
{
    return can->bus.is_fitted && (can->bus.is_off || !can->bus.is_there);
}

/* ------------------------------------------------------------------------------------------------ in -- */

/* Identifiers that the other nodes of a bus use among themselves. Their frames are for others, and nothing strange. */
static bool is_known_function(uint32_t id)
{
#define FUNCTION_OF_RATE(ID, name, rate, coxa) | 1u << (ID >> 7)
#define FUNCTION_BY_HAND(ID, name) | 1u << (ID >> 7)
    const uint32_t known = 1u << (BRACE_CAN_ID_REQUEST >> 7) |
                           1u << (BRACE_CAN_ID_ANSWER >> 7) BRACE_CAN_PROCESS(FUNCTION_OF_RATE)
                                   BRACE_CAN_PROCESS_FD(FUNCTION_OF_RATE) BRACE_CAN_BY_HAND(FUNCTION_BY_HAND);
#undef FUNCTION_OF_RATE
#undef FUNCTION_BY_HAND
    return (known >> (id >> 7 & 15u) & 1u) != 0u;
}

/* Is the frame a request to this node? A frame of no known kind is counted. */
static bool is_request(const can_t *can, const wire_tick_t *tick, const brace_can_frame_t *frame)
{
    if (frame->id != (uint32_t)BRACE_CAN_ID_REQUEST + can->node_id) {
        if (!is_known_function(frame->id)) {
            brace_count(&tick->counters->frames_unknown);
        }
        return false;
    }
    if (frame->length != 8u || frame->fd) {
        brace_count(&tick->counters->frames_unknown);
        return false;
    }
    return true;
}

static bool has_room_for_an_answer(const can_port_t *port)
{
    return can_answers_have_room(&port->requests.answers, ANSWERS_PER_TICK);
}

static can_port_t *port_of(can_t *can, way_t way)
{
    return way == ON_BUS ? &can->bus_port : &can->text_port;
}

static brace_asker_t asker_of(way_t way)
{
    return way == ON_BUS ? BRACE_ASKER_CAN : BRACE_ASKER_SLCAN;
}

static void answer(can_t *can, way_t way, const wire_tick_t *tick, const uint8_t *data)
{
    if (!can_requests_answer(&port_of(can, way)->requests, tick, asker_of(way), can->node_id, data)) {
        brace_count(&tick->counters->frames_unknown);
    }
}

static bool has_number(const can_t *can)
{
    return can->node_id >= 1u && can->node_id <= NODE_MOST;
}

/* Answers wait for a bus that is off. A channel that has been closed is another's when it opens again, so nothing waits
 * for it. */
static void keep_silent(can_t *can, way_t way, const wire_tick_t *tick)
{
    can_port_t *port = port_of(can, way);
    process_skip(&port->process);
    brace_app_gone(tick->app, asker_of(way));
    if (way == AS_TEXT) {
        port->requests.answers.count = 0;
        port->requests.waits = false;
        can_queue_clear(&port->requests.queue);
        memset(port->requests.asked_force, 0, sizeof port->requests.asked_force);
        announce_skip(&port->announce, tick);
    }
}

/* A request that waits in no queue is refused at once, or counted where even the refusal finds no room. */
static void refuse(can_requests_t *requests, const wire_tick_t *tick, const uint8_t *data, int32_t status,
                   uint32_t detail)
{
    if (requests->refusals_left > 0u && can_answers_have_room(&requests->answers, 1u + ROOM_FOR_REFUSALS)) {
        requests->refusals_left--;
        can_answers_refuse(&requests->answers, data[0], data[1], status, detail);
    } else {
        brace_count(&tick->counters->requests_lost);
    }
}

void can_stop(can_t *can)
{
    can_queue_stop(&can->bus_port.requests.queue);
    can_queue_stop(&can->text_port.requests.queue);
}

/* A frame has come: a stop is obeyed at once, everything else waits in its queue. returns whether it was a stop */
static bool sort_frame(can_t *can, way_t way, const wire_tick_t *tick, const brace_can_frame_t *frame)
{
    can_requests_t *requests = &port_of(can, way)->requests;
    brace_request_t asked;
    if (frame->id == can->bus.setup.urgent_id) {
        (void)brace_app_stop(tick->app);
        return true;
    }
    if (!is_request(can, tick, frame) || (way == ON_BUS && !has_number(can))) {
        return false;
    }
    if (frame->data[0] == (uint8_t)BRACE_REQUEST_WRITE_ENTRY) { /* the others' code says it all */
        brace_can_unpack_request(frame->data, &asked);
    }
    const answer_rank_t rank = answer_rank(frame->data[0], &asked);
    if (rank == ANSWER_UNKNOWN) { /* noise takes no turn from anybody */
        brace_count(&tick->counters->frames_unknown);
        refuse(requests, tick, frame->data, BRACE_REFUSED_UNKNOWN, BRACE_REQUEST_CODE_MOST);
        return false;
    }
    if (rank == ANSWER_QUESTION) {
        if (!can_queue_put_question(&requests->queue, frame->data)) { /* its master's is full */
            brace_count(&tick->counters->questions_busy);
            refuse(requests, tick, frame->data, BRACE_REFUSED_CROWDED, CAN_QUESTIONS_EACH);
        }
        return false;
    }
    if (rank == ANSWER_STOPS) {
        (void)brace_app_stop(tick->app); /* its answer has its turn among the session's */
    }
    if (!can_queue_put_session(&requests->queue, frame->data)) {
        brace_count(&tick->counters->requests_lost);
    }
    return rank == ANSWER_STOPS;
}

/* Both return whether a stop was among what has come. */
static bool hear_bus(can_t *can, const wire_tick_t *tick)
{
    brace_can_frame_t frame;
    bool stops = false;
    uint32_t count = 0;
    for (; count < FRAMES_PER_TICK && can_bus_receive(&can->bus, tick->hal, &frame); count++) {
        stops = sort_frame(can, ON_BUS, tick, &frame) || stops;
    }
    can->sorted = (uint16_t)count;
    return stops;
}

/* A channel that has been closed may be open again: what comes behind is the next host's. */
static bool hear_text(can_t *can, const wire_tick_t *tick)
{
    brace_can_frame_t frame;
    bool stops = false;
    for (uint32_t i = 0; i < LINES_PER_TICK; i++) {
        const bool has_come = slcan_receive(&can->text, tick->hal, &frame);
        if (can->text.was_closed) {
            can->text.was_closed = false;
            keep_silent(can, AS_TEXT, tick);
        }
        if (!has_come) {
            break;
        }
        stops = sort_frame(can, AS_TEXT, tick, &frame) || stops;
        can->sorted++;
    }
    return stops;
}

/* What belongs to a session is obeyed in its order. What came before a stop begins nothing any more: the last of it is
 * stopped again, and so is the last that has its turn in this tick.
 * returns how much it has done (wire.h) */
static uint32_t obey_session(can_t *can, way_t way, const wire_tick_t *tick, uint32_t most)
{
    can_queue_t *queue = &port_of(can, way)->requests.queue;
    bool came_before_stop = false;
    for (uint32_t i = 0; i < most; i++) {
        const uint8_t *data = can_queue_take_session(queue, &came_before_stop);
        if (data == NULL) {
            return i;
        }
        answer(can, way, tick, data);
        if (came_before_stop && (queue->before_stop == 0u || i + 1u == most)) {
            (void)brace_app_stop(tick->app);
        }
    }
    return most;
}

/* One question, of the next master. returns how much it has done (wire.h) */
static uint32_t answer_question(can_t *can, way_t way, const wire_tick_t *tick)
{
    can_requests_t *requests = &port_of(can, way)->requests;
    if (!has_room_for_an_answer(port_of(can, way))) {
        return WIRE_NOTHING;
    }
    const bool waited = requests->waits;
    if (waited && brace_app_k_is_coming(tick->app, asker_of(way))) {
        return WIRE_NOTHING;
    }
    const uint8_t *data = waited ? can_queue_question(&requests->queue) : can_queue_next_question(&requests->queue);
    if (data == NULL) {
        return WIRE_NOTHING;
    }
    requests->waits = false;
    answer(can, way, tick, data);
    if (requests->waits) {
        return waited ? WIRE_NOTHING : WIRE_TAKEN;
    }
    can_queue_question_done(&requests->queue);
    return waited ? WIRE_K_ANSWERED : WIRE_TAKEN;
}

/* ----------------------------------------------------------------------------------------------- out -- */

/* Can frames leave this way now? */
static bool is_open(const can_t *can, way_t way)
{
    return way == ON_BUS ? can->bus.is_there && !can->bus.is_off : can->text.is_open;
}

/* Gives a frame this node's number and sends it. returns whether it has left */
static bool send(can_t *can, way_t way, const wire_tick_t *tick, brace_can_frame_t *frame)
{
    frame->id += can->node_id;
    return way == ON_BUS ? can_bus_send(&can->bus, tick, frame) : slcan_send(&can->text, frame);
}

static void send_answers(can_t *can, way_t way, const wire_tick_t *tick)
{
    can_answers_t *answers = &port_of(can, way)->requests.answers;
    const uint32_t most = way == ON_BUS ? ANSWERS_PER_TICK : TEXT_ANSWERS_PER_TICK;
    brace_can_frame_t frame;
    for (uint32_t i = 0; i < most; i++) {
        const uint8_t *data = can_answers_next(answers);
        if (data == NULL) {
            break;
        }
        frame.id = BRACE_CAN_ID_ANSWER;
        frame.length = 8;
        frame.fd = false;
        memcpy(frame.data, data, 8);
        if (!send(can, way, tick, &frame)) {
            break;
        }
        can_answers_sent(answers);
    }
}

static void send_announcement(can_t *can, way_t way, const wire_tick_t *tick)
{
    announce_t *announce = &port_of(can, way)->announce;
    brace_can_frame_t frame;
    if (announce_next(announce, tick, &frame)) {
        const uint32_t function = frame.id;
        if (send(can, way, tick, &frame)) {
            announce_sent(announce, tick, function);
        }
    }
}

/* most: frames that may leave, at most PROCESS_FRAMES_PER_TICK. returns how many have left */
static uint32_t send_process_data(can_t *can, way_t way, const wire_tick_t *tick, uint32_t most)
{
    const process_bus_t bus = {.node_id = can->node_id,
                               .bit_rate = can->bit_rate,
                               .fd_bit_rate = way == ON_BUS ? can->bus.setup.fd_bit_rate : 0u};
    process_t *process = &port_of(can, way)->process;
    brace_can_frame_t frame;
    /* A snapshot is long, and so is a change of the rates: the two ports do not both work in the same tick. */
    if (can->data_done == 0u) {
        can->data_done = process_tick(process, &bus, tick);
    }
    for (uint32_t i = 0; i < most; i++) {
        if (!process_next(process, tick, &frame) || !send(can, way, tick, &frame)) {
            return i;
        }
        process_sent(process);
    }
    return most;
}

/* most: frames of process data that may leave. returns how many have left */
static uint32_t speak(can_t *can, way_t way, const wire_tick_t *tick, uint32_t most)
{
    if (!is_open(can, way)) {
        keep_silent(can, way, tick);
        return 0;
    }
    send_answers(can, way, tick);
    if (!has_number(can)) {
        return 0;
    }
    send_announcement(can, way, tick);
    const bool data_wait = can->data_waited > 0u;
    return data_wait ? 0u : send_process_data(can, way, tick, most);
}

bool can_hear(can_t *can, const wire_tick_t *tick)
{
    can->bus_port.requests.refusals_left = can->text_port.requests.refusals_left = REFUSALS_PER_TICK;
    const bool stops_on_bus = hear_bus(can, tick);
    return hear_text(can, tick) || stops_on_bus;
}

bool can_has_burst(const can_t *can, const wire_tick_t *tick)
{
    return can->sorted > BURST_PER_MS * brace_app_parameters(tick->app)->controller.tick_us / 1000u;
}

uint32_t can_obey(can_t *can, const wire_tick_t *tick, bool is_burst)
{
    const uint32_t each_tick = SESSION_PER_MS * brace_app_parameters(tick->app)->controller.tick_us / 1000u;
    if (!is_burst) {
        can->ticks_to_room = (uint8_t)((can->ticks_to_room + 1u) % ROOM_TICKS);
    }
    const bool leaves_room = (is_burst && can_has_burst(can, tick)) || (!is_burst && can_leaves_room(can));
    const uint32_t most = leaves_room ? 1u : is_burst ? 2u * each_tick / 3u : each_tick;
    return obey_session(can, ON_BUS, tick, most) + obey_session(can, AS_TEXT, tick, most);
}

uint32_t can_answer(can_t *can, const wire_tick_t *tick, bool has_room)
{
    can_bus_watch(&can->bus, tick->hal, brace_app_parameters(tick->app)->controller.tick_us);
    tick->counters->frames_lost = can->bus.frames_lost;
    can_requests_tick(&can->bus_port.requests, tick);
    can_requests_tick(&can->text_port.requests, tick);
    return has_room ? answer_question(can, ON_BUS, tick) + answer_question(can, AS_TEXT, tick) : WIRE_NOTHING;
}

uint32_t can_speak(can_t *can, const wire_tick_t *tick, uint32_t most)
{
    const bool data_wait = most == 0u && can->data_waited < DATA_WAIT_MOST;
    can->data_waited = data_wait ? (uint8_t)(can->data_waited + 1u) : 0u;
    most = most > 0u ? most : 1u;
    can->data_done = WIRE_NOTHING;
    can->text_first = !can->text_first; /* The ports share the tick's frames of process data. */
    const uint32_t told = speak(can, can->text_first ? AS_TEXT : ON_BUS, tick, most);
    const uint32_t more = speak(can, can->text_first ? ON_BUS : AS_TEXT, tick, most - told);
    slcan_flush(&can->text, tick->hal);
    return told + more + can->data_done;
}
