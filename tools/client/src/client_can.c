/* The client over CAN. It looks at every frame that it receives, whatever it waits for. */
#include "client_can.h"

#include "bus_slcan.h"
#include "refusal.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "brace/can_messages.h"
#include "brace/refusals.h"

enum { STATUS_MS = 250, FIRST_TRY_MS = 250, AGAIN_MS = 1000, LIFE_MS = 5 };
enum { APART_US = 32000, MOST_APART_US = 1024000, FOREIGN_US = 1000000 };
enum { OLD_US = 100000, KEPT_US = 1000000 /* the slowest stream's period: brace_can_read */ };

/* The lower four bits of the tokens of signs of life; commands have others. The sign with which a motion begins has its
 * own, so that its answer is known. */
enum { LIFE_TOKEN = 0, BEGIN_TOKEN = 15, COMMAND_TOKENS = 14 };

/* What a call waits for. */
typedef struct {
    uint32_t code;
    uint8_t token;
    uint32_t parts_seen;
    bool is_command;
    bool is_taken; /* another client has used our token: an answer may be for either of us */
    bool is_refused;
    brace_can_refusal_t refusal;
    brace_question_t *question;
} waiting_t;

/* A seal is a write_entry with the token of its command. If that is a write_entry too, the number of the entry shows
 * whose answer has come. */
static bool is_of_seal(const brace_bus_frame_t *frame, const waiting_t *waiting)
{
    brace_can_write_entry_request_t asked;
    brace_can_write_entry_answer_0_t answer;
    brace_can_unpack_write_entry_request(waiting->question->data, &asked);
    brace_can_unpack_write_entry_answer_0(frame->data, &answer);
    return waiting->code == BRACE_REQUEST_WRITE_ENTRY && answer.index != asked.index;
}

static void take_answer(const brace_bus_frame_t *frame, waiting_t *waiting)
{
    if (frame->data[1] != waiting->token) {
        return;
    }
    const brace_can_answer_frame_t *is = &brace_can_answer_frames[frame->data[0]];
    if (frame->data[0] == BRACE_ANSWER_REFUSED) {
        brace_can_refusal_t refusal;
        brace_can_unpack_refusal(frame->data, &refusal);
        waiting->is_refused = refusal.code == waiting->code;
        waiting->refusal = waiting->is_refused ? refusal : waiting->refusal;
    } else if (is->parts > 0u && is->code == waiting->code && !is_of_seal(frame, waiting)) {
        memcpy(waiting->question->answers[is->part], frame->data, 8u);
        waiting->parts_seen |= 1u << is->part;
    }
}

static bool is_from_controller(uint32_t base)
{
    static const uint32_t bases[] = {BRACE_CAN_ID_EMERGENCY,   BRACE_CAN_ID_STIFFNESS_A, BRACE_CAN_ID_STIFFNESS_B,
                                     BRACE_CAN_ID_EIGENVALUES, BRACE_CAN_ID_POSTURE,     BRACE_CAN_ID_HEARTBEAT,
                                     BRACE_CAN_ID_ANSWER,      BRACE_CAN_ID_DETAILS,     BRACE_CAN_ID_SNAPSHOT_FD,
                                     BRACE_CAN_ID_DETAILS_FD};
    for (size_t i = 0u; i < sizeof bases / sizeof bases[0]; i++) {
        if (base == bases[i]) {
            return true;
        }
    }
    return false;
}

/* The answer to a sign of life, whoever gave it, brings the controller's number; a refused sign brings it, too. */
static void hear_number(brace_client_t *client, const brace_bus_frame_t *frame)
{
    const uint8_t begins = (uint8_t)(client->master << 4 | BEGIN_TOKEN);
    brace_can_sign_of_life_answer_0_t answer;
    brace_can_refusal_t refusal;
    brace_can_unpack_sign_of_life_answer_0(frame->data, &answer);
    brace_can_unpack_refusal(frame->data, &refusal);
    const bool is_refused = frame->data[0] == BRACE_ANSWER_REFUSED && refusal.code == BRACE_REQUEST_SIGN_OF_LIFE;
    if (!is_refused && frame->data[0] != BRACE_SIGN_OF_LIFE_ANSWER_0) {
        return;
    }
    if (!is_refused || refusal.status == BRACE_REFUSED_LATE) {
        brace_owner_hears(&client->owner, is_refused ? refusal.detail : answer.number);
    }
    if (frame->data[1] == begins && client->owner.has_begin) {
        client->owner.has_begin = false;
        client->motion.has_begun |= !is_refused;
    }
}

/* Handles one frame. A client does not receive its own requests, so a request like ours is another client's. */
static void hear(brace_client_t *client, const brace_bus_frame_t *frame, waiting_t *waiting)
{
    const uint32_t node = frame->id & 0x7fu, base = frame->id & ~0x7fu;
    if (node != 0u && is_from_controller(base)) {
        client->heard[node >> 5] |= 1u << (node & 31u);
    }
    const bool is_long = base == BRACE_CAN_ID_SNAPSHOT_FD || base == BRACE_CAN_ID_DETAILS_FD;
    if (node != client->node || node == 0u || (frame->length != 8u && !is_long)) {
        return;
    }
    client->errors_before = client->bus->errors;
    client->lost_before = client->bus->lost;
    client->unacknowledged_before = client->bus->unacknowledged;
    if (base == BRACE_CAN_ID_HEARTBEAT) {
        brace_can_heartbeat_t heartbeat;
        brace_can_unpack_heartbeat(frame->data, &heartbeat);
        client->speaks_another = heartbeat.dictionary_hash != BRACE_DICTIONARY_HASH;
        client->other_hash = heartbeat.dictionary_hash;
    } else if (base == BRACE_CAN_ID_ANSWER) {
        hear_number(client, frame);
        if (waiting != NULL) {
            take_answer(frame, waiting);
        }
    } else if (base == BRACE_CAN_ID_REQUEST) {
        client->force_is_taken |= brace_client_is_about_force(frame->data[0]);
        client->foreign_us[frame->data[1]] = frame->received_us;
        if (waiting != NULL) {
            waiting->is_taken |=
                !waiting->is_command && frame->data[0] == waiting->code && frame->data[1] == waiting->token;
        }
    } else {
        const brace_client_snapshot_t *s = brace_joiner_add(&client->joiner, node, frame, brace_bus_lost(client->bus));
        if (s != NULL) {
            client->latest[s->parts] = *s;
        }
    }
}

/* Begins a call: frames received before it do not count. */
static void begin(brace_client_t *client, uint64_t deadline_us)
{
    const uint64_t answer_us = STATUS_MS * 1000u;
    const bool is_long = brace_bus_now_us() + 2u * answer_us <= deadline_us;
    memset(client->heard, 0, sizeof client->heard);
    client->ask_errors_us = client->bus->is_slcan && is_long ? deadline_us - answer_us : 0u;
}

static bool is_silent(const brace_client_t *client)
{
    return (client->heard[0] | client->heard[1] | client->heard[2] | client->heard[3]) == 0u;
}

/* If the bus stays silent, asks an SLCAN adapter for its error flags while there is time to receive them. */
static brace_bus_status_t receive(brace_client_t *client, brace_bus_frame_t *frame, int timeout_ms)
{
    const int ask_ms = brace_bus_left_ms(client->ask_errors_us);
    if (client->ask_errors_us == 0u || !is_silent(client) || ask_ms > timeout_ms) {
        return brace_bus_receive(client->bus, frame, timeout_ms);
    }
    const brace_bus_status_t status = brace_bus_receive(client->bus, frame, ask_ms);
    if (status != BRACE_BUS_E_TIMEOUT) {
        return status;
    }
    client->ask_errors_us = 0u;
    (void)brace_bus_errors(client->bus, 0);
    return brace_bus_receive(client->bus, frame, timeout_ms - ask_ms);
}

/* Gives signs of life meanwhile, while the limb moves. */
static brace_bus_status_t receive_alive(brace_client_t *client, brace_bus_frame_t *frame, int timeout_ms)
{
    const uint64_t until_us = brace_bus_now_us() + (uint64_t)timeout_ms * 1000u;
    brace_bus_status_t status;
    int left_ms = timeout_ms;
    do {
        brace_can_tend(client);
        if (client->is_down) {
            client->is_down = false;
            return BRACE_BUS_E_DOWN;
        }
        const int life_ms = brace_bus_left_ms(client->next_life_us);
        status = receive(client, frame, client->lives && life_ms < left_ms ? life_ms : left_ms);
        left_ms = brace_bus_left_ms(until_us);
    } while (status == BRACE_BUS_E_TIMEOUT && left_ms > 0);
    return status;
}

/* Receives one frame, or none within timeout_ms. */
static brace_client_status_t listen(brace_client_t *client, int timeout_ms, waiting_t *waiting)
{
    brace_bus_frame_t frame;
    const brace_bus_status_t status = receive_alive(client, &frame, timeout_ms);
    if (status == BRACE_BUS_OK) {
        hear(client, &frame, waiting);
    } else if (status != BRACE_BUS_E_TIMEOUT) {
        return brace_client_fail(client, BRACE_CLIENT_E_DOWN,
                                 "%s: the connection has gone; is the interface still up, the adapter plugged in, the "
                                 "other end running?",
                                 client->url);
    }
    if (client->speaks_another) {
        return brace_client_fail_version(client, client->node, client->other_hash);
    }
    return status == BRACE_BUS_OK ? BRACE_CLIENT_OK : BRACE_CLIENT_E_TIMEOUT;
}

static bool is_heard(const brace_client_t *client, uint32_t node)
{
    return node != 0u && client->heard[node >> 5] >> (node & 31u) & 1u;
}

/* Text of the nodes that send, e.g. "1, 2". Returns the first of them, 0 for none. */
static uint32_t list_heard(const brace_client_t *client, char *text, size_t room)
{
    uint32_t first = 0u;
    size_t used = 0u;
    text[0] = '\0';
    for (uint32_t node = 1u; node <= 127u; node++) {
        if (is_heard(client, node)) {
            first = first == 0u ? node : first;
            if (used + 6u < room) {
                used += (size_t)snprintf(text + used, room - used, "%s%u", used == 0u ? "" : ", ", (unsigned)node);
            }
        }
    }
    return first;
}

/* The time is over, and the frame that the call waits for (`what`) has not come. Finds out why. */
static brace_client_status_t explain_silence(brace_client_t *client, const char *what)
{
    char heard[64];
    if (is_heard(client, client->node)) {
        return brace_client_fail(
            client, BRACE_CLIENT_E_TIMEOUT,
            "%s: controller %u is heard, but %s did not come in time; try a longer time-out, or less "
            "on the bus",
            client->url, (unsigned)client->node, what);
    }
    const uint32_t other = list_heard(client, heard, sizeof heard);
    if (other != 0u) {
        return brace_client_fail(
            client, BRACE_CLIENT_E_NODE,
            "%s: controller %u is not on this bus; heard: %s; try node %u, or give the controller its "
            "number (controller.node_id)",
            client->url, (unsigned)client->node, heard, (unsigned)other);
    }
    const bool is_slcan = client->bus->is_slcan;
    const uint32_t errors = brace_bus_errors(client->bus, 0); /* after a short call the next one receives the answer */
    if (errors != client->errors_before || brace_bus_lost(client->bus) != client->lost_before) {
        return brace_client_fail(
            client, BRACE_CLIENT_E_BIT_RATE,
            is_slcan ? "%s: the bus is there and can not be read: not the controller's bit rate (or the "
                       "serial line's baud rate); try another of 1000000, 500000, 250000 and 125000, or "
                       "slcan:DEVICE@BAUD"
                     : "%s: error frames only: not the controller's bit rate, or no termination; try "
                       "'ip link set %s down', then up with 'type can bitrate 500000'",
            client->url, client->url);
    }
    if (client->bus->unacknowledged != client->unacknowledged_before) {
        return brace_client_fail(
            client, BRACE_CLIENT_E_SILENT,
            "%s: nobody acknowledges what is sent; is the controller powered and wired, the bus terminated, the bit "
            "rate the controller's?",
            client->url);
    }
    return brace_client_fail(
        client, BRACE_CLIENT_E_SILENT,
        "%s: nothing at all is heard; is the controller powered and wired, its bit rate this bus' own, "
        "its node number set (controller.node_id)? 'candump' shows what is on a bus",
        client->url);
}

/* ------------------------------------------------------------------------------------------- asking -- */

/* How a request is sent. Commands are sealed on a guarded board. All other tokens distinguish masters. */
typedef enum { ASKS, COMMANDS } manner_t;

/* Has another client asked with this token of late? An answer to that one may still come. */
static bool is_foreign(const brace_client_t *client, uint8_t token)
{
    return client->foreign_us[token] != 0u && brace_bus_now_us() - client->foreign_us[token] < FOREIGN_US;
}

/* Each try gets a new token, because parts of two answers may be of two ticks and must not be mixed. */
static uint8_t next_token(brace_client_t *client, manner_t manner)
{
    if (manner != ASKS && client->owner.is_open) {
        return (uint8_t)brace_owner_next_counter(&client->owner);
    }
    for (int i = 0; i < COMMAND_TOKENS; i++) {
        client->token = (uint8_t)(client->master << 4 | (1u + (client->token & 15u) % (uint32_t)COMMAND_TOKENS));
        if (manner != ASKS || !is_foreign(client, client->token)) {
            break;
        }
    }
    return client->token;
}

static brace_bus_frame_t request_frame(const brace_client_t *client, const uint8_t data[8], uint8_t token)
{
    brace_bus_frame_t frame = {.id = BRACE_CAN_ID_REQUEST + client->node, .length = 8u};
    memcpy(frame.data, data, 8u);
    frame.data[1] = token;
    return frame;
}

/* Writes the check of a seal to its entry. */
static brace_bus_status_t show_seal(brace_client_t *client, brace_client_seal_t seal, uint8_t token, int timeout_ms)
{
    const brace_can_write_entry_request_t request = {.index = BRACE_CLIENT_COMMAND(seal_mac), .value = seal.check};
    uint8_t data[8];
    (void)brace_can_pack_write_entry_request(&request, data);
    const brace_bus_frame_t frame = request_frame(client, data, token);
    return brace_bus_send(client->bus, &frame, timeout_ms);
}

void brace_can_show_life(brace_client_t *client)
{
    const brace_client_life_t life = brace_owner_life(&client->owner);
    const brace_can_sign_of_life_request_t request = {.heard = life.number & 0xffffu, .check = life.check};
    uint8_t data[8];
    (void)brace_can_pack_sign_of_life_request(&request, data);
    const uint32_t low = client->owner.has_begin ? BEGIN_TOKEN : LIFE_TOKEN;
    const brace_bus_frame_t frame = request_frame(client, data, (uint8_t)(client->master << 4 | low));
    /* The kernel reports it once. */
    client->is_down |= brace_bus_send(client->bus, &frame, LIFE_MS) == BRACE_BUS_E_DOWN;
}

void brace_can_tend(brace_client_t *client)
{
    if (brace_client_life_is_due(client)) {
        brace_can_show_life(client);
    }
}

/* One try; a command's seal goes before it. */
static brace_bus_status_t send_request(brace_client_t *client, const brace_question_t *question, manner_t manner,
                                       uint64_t deadline_us, uint8_t *token)
{
    *token = next_token(client, manner);
    const brace_bus_frame_t request = request_frame(client, question->data, *token);
    if (manner != ASKS && client->owner.is_open) {
        const brace_client_seal_t seal = brace_owner_seal(&client->owner, request.data, 8u);
        const brace_bus_status_t shown = show_seal(client, seal, *token, brace_bus_left_ms(deadline_us));
        if (shown != BRACE_BUS_OK) {
            return shown;
        }
    }
    return brace_bus_send(client->bus, &request, brace_bus_left_ms(deadline_us));
}

static brace_client_status_t ask(brace_client_t *client, brace_question_t *question, manner_t manner,
                                 uint64_t deadline_us)
{
    static const char what[] = "its answer";
    const uint32_t parts = (1u << brace_can_answer_parts[question->code]) - 1u;
    uint64_t try_us = FIRST_TRY_MS * 1000u;
    while (brace_bus_left_ms(deadline_us) > 0) {
        waiting_t waiting = {.code = question->code, .is_command = manner != ASKS, .question = question};
        const brace_bus_status_t sent = send_request(client, question, manner, deadline_us, &waiting.token);
        if (sent == BRACE_BUS_E_FULL) {
            return brace_client_fail(
                client, BRACE_CLIENT_E_FULL,
                "%s: the bus takes no frame: nobody acknowledges it (power, wiring, termination, bit "
                "rate), or it is overloaded",
                client->url);
        }
        if (sent != BRACE_BUS_OK) {
            return brace_client_fail(client, BRACE_CLIENT_E_DOWN,
                                     "%s: the connection has gone; is the interface still up, the other end running?",
                                     client->url);
        }
        const uint64_t try_until_us = brace_bus_now_us() + try_us;
        const uint64_t until_us = try_until_us < deadline_us ? try_until_us : deadline_us;
        while (!waiting.is_taken && brace_bus_left_ms(until_us) > 0) {
            const brace_client_status_t status = listen(client, brace_bus_left_ms(until_us), &waiting);
            if (status != BRACE_CLIENT_OK && status != BRACE_CLIENT_E_TIMEOUT) {
                return status;
            }
            if (waiting.is_refused) {
                const brace_can_refusal_t *refusal = &waiting.refusal;
                client->refusal = refusal->status;
                return brace_client_fail(
                    client, BRACE_CLIENT_E_REFUSED, "%s: controller %u refuses: %s (status %d, detail %u)", client->url,
                    (unsigned)client->node, brace_client_reason(waiting.code, refusal->status, refusal->detail),
                    (int)refusal->status, (unsigned)refusal->detail);
            }
            if (waiting.parts_seen == parts && !waiting.is_taken) {
                return BRACE_CLIENT_OK;
            }
        }
        try_us *= 2u;
        /* That closes the channel first, and with it the session of whoever moves the limb. */
        if (client->bus->is_slcan && !client->lives && !is_heard(client, client->node)) {
            brace_slcan_enter_again(client->bus);
        }
        if (waiting.is_taken) { /* the other client looks for a new token too, but for another one */
            client->token = (uint8_t)(brace_bus_now_us() ^ (uint64_t)getpid());
        }
    }
    return explain_silence(client, what);
}

brace_client_status_t brace_can_ask(brace_client_t *client, brace_question_t *question, uint64_t deadline_us)
{
    begin(client, deadline_us);
    return ask(client, question, ASKS, deadline_us);
}

brace_client_status_t brace_can_command(brace_client_t *client, brace_question_t *question, bool moves,
                                        uint64_t deadline_us)
{
    begin(client, deadline_us);
    const brace_client_status_t status = ask(client, question, COMMANDS, deadline_us);
    if (status == BRACE_CLIENT_OK && moves) { /* each answer to such a command ends with that number */
        brace_can_take_up_answer_0_t answer;
        brace_can_unpack_take_up_answer_0(question->answers[0], &answer);
        brace_owner_may_begin(&client->owner, answer.begin);
    }
    return status;
}

void brace_can_hear_begin(brace_client_t *client, uint64_t deadline_us)
{
    brace_client_status_t status = BRACE_CLIENT_OK;
    while (client->owner.has_begin && brace_bus_left_ms(deadline_us) > 0 &&
           (status == BRACE_CLIENT_OK || status == BRACE_CLIENT_E_TIMEOUT)) {
        status = listen(client, brace_bus_left_ms(deadline_us), NULL);
    }
}

/* Listens for some time up to most_us, which is another one in each client: two that disturb each other must not do so
 * in step. */
static brace_client_status_t pause_apart(brace_client_t *client, uint64_t most_us, uint64_t deadline_us)
{
    const uint64_t now_us = brace_bus_now_us(), end_us = now_us + (now_us ^ (uint64_t)getpid()) % most_us;
    const uint64_t until_us = end_us < deadline_us ? end_us : deadline_us;
    while (brace_bus_left_ms(until_us) > 0) {
        const brace_client_status_t status = listen(client, brace_bus_left_ms(until_us), NULL);
        if (status != BRACE_CLIENT_OK && status != BRACE_CLIENT_E_TIMEOUT) {
            return status;
        }
    }
    return BRACE_CLIENT_OK;
}

/* Has the controller answered without the force? It answers K in space with that said, and refuses K in the plane. */
static bool is_without_force(const brace_question_t *question)
{
    brace_can_k_in_space_at_posture_answer_4_t last;
    brace_can_unpack_k_in_space_at_posture_answer_4(question->answers[4], &last);
    return question->code == BRACE_REQUEST_K_IN_SPACE_AT_POSTURE && last.force_is_told == 0u;
}

brace_client_status_t brace_can_ask_under_force(brace_client_t *client, brace_question_t *force,
                                                brace_question_t *question, uint64_t deadline_us)
{
    begin(client, deadline_us);
    /* The pauses double, so that each client gets its turn on a slow machine or bus, too. */
    for (uint64_t most_us = APART_US;; most_us = most_us < MOST_APART_US ? 2u * most_us : most_us) {
        client->force_is_taken = false;
        brace_client_status_t status = ask(client, force, ASKS, deadline_us);
        if (status == BRACE_CLIENT_OK) {
            status = ask(client, question, ASKS, deadline_us);
        }
        /* The force is used up when an answer was lost, too, and the question repeated. */
        const bool is_answered = status == BRACE_CLIENT_OK || status == BRACE_CLIENT_E_REFUSED;
        const bool is_used_up =
            status == BRACE_CLIENT_OK ? is_without_force(question) : client->refusal == BRACE_REFUSED_ORDER;
        if (!is_answered || (!is_used_up && !client->force_is_taken)) {
            return status;
        }
        status = pause_apart(client, most_us, deadline_us);
        if (status != BRACE_CLIENT_OK) {
            return status;
        }
        if (brace_bus_left_ms(deadline_us) == 0) {
            return brace_client_fail(client, BRACE_CLIENT_E_TIMEOUT,
                                     "%s: other clients asked for K under other forces all the time; try a longer "
                                     "time-out",
                                     client->url);
        }
    }
}

static brace_client_status_t find_first(brace_client_t *client, uint64_t deadline_us)
{
    char heard[64];
    while (brace_bus_left_ms(deadline_us) > 0) {
        const int left_ms = brace_bus_left_ms(deadline_us);
        const brace_client_status_t status = listen(client, left_ms < AGAIN_MS ? left_ms : AGAIN_MS, NULL);
        if (status != BRACE_CLIENT_OK && status != BRACE_CLIENT_E_TIMEOUT) {
            return status;
        }
        if (status == BRACE_CLIENT_E_TIMEOUT && client->bus->is_slcan) {
            brace_slcan_enter_again(client->bus);
        }
        client->node = list_heard(client, heard, sizeof heard);
        if (client->node != 0u) {
            return BRACE_CLIENT_OK;
        }
    }
    return explain_silence(client, "");
}

static brace_client_status_t identify(brace_client_t *client, uint64_t deadline_us)
{
    const brace_can_identify_request_t request = {0};
    brace_question_t question = {.code = BRACE_REQUEST_IDENTIFY};
    (void)brace_can_pack_identify_request(&request, question.data);
    const brace_client_status_t status = ask(client, &question, ASKS, deadline_us);
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    brace_can_identify_answer_0_t version;
    brace_can_identify_answer_1_t dictionary;
    brace_can_identify_answer_3_t parameters;
    brace_can_identify_answer_4_t condition;
    brace_can_unpack_identify_answer_0(question.answers[0], &version);
    brace_can_unpack_identify_answer_1(question.answers[1], &dictionary);
    brace_can_unpack_identify_answer_3(question.answers[3], &parameters);
    brace_can_unpack_identify_answer_4(question.answers[4], &condition);
    if (dictionary.dictionary_hash != BRACE_DICTIONARY_HASH || version.protocol != BRACE_PROTOCOL) {
        return brace_client_fail_version(client, client->node, dictionary.dictionary_hash);
    }
    client->identity = (brace_client_identity_t){
        .node = client->node,
        .dictionary_hash = dictionary.dictionary_hash,
        .firmware_version = version.major << 16 | version.minor << 8 | version.patch,
        .parameter_crc = parameters.parameter_crc,
        .parameter_origin = parameters.origin,
    };
    brace_joiner_hear_faults(&client->joiner, condition.faults, brace_bus_lost(client->bus));
    return BRACE_CLIENT_OK;
}

brace_client_status_t brace_can_open(brace_client_t *client, uint32_t node, uint32_t bit_rate, uint64_t deadline_us)
{
    const brace_bus_status_t opened = brace_bus_open(client->url, bit_rate, brace_bus_left_ms(deadline_us),
                                                     &client->bus, client->why, sizeof client->why);
    if (opened != BRACE_BUS_OK) {
        return (brace_client_status_t)opened; /* both enums have the same numbers */
    }
    begin(client, deadline_us);
    client->node = node;
    client->token = (uint8_t)(brace_bus_now_us() ^ (uint64_t)getpid());
    client->master = client->token >> 4;
    const brace_client_status_t status = node == 0u ? find_first(client, deadline_us) : BRACE_CLIENT_OK;
    return status == BRACE_CLIENT_OK ? identify(client, deadline_us) : status;
}

/* The newest snapshot with the wanted parts, unless a call with the same wanted parts has already read it. */
static bool newest(brace_client_t *client, uint32_t wanted, uint64_t since_us, brace_client_snapshot_t *snapshot)
{
    const brace_client_snapshot_t *best = NULL;
    for (uint32_t parts = wanted; parts <= PARTS_MOST; parts++) {
        const brace_client_snapshot_t *s = &client->latest[parts];
        if ((parts & wanted) == wanted && s->parts != 0u && (best == NULL || s->received_us >= best->received_us)) {
            best = s;
        }
    }
    if (best == NULL || best->received_us < since_us || best->received_us < client->read_us[wanted] ||
        (best->received_us == client->read_us[wanted] && best->sequence == client->read_sequence[wanted])) {
        return false;
    }
    *snapshot = *best;
    client->read_us[wanted] = best->received_us;
    client->read_sequence[wanted] = best->sequence;
    return true;
}

/* What a controller may not send, and why. */
static const char *part_in_words(uint32_t wanted)
{
    return (wanted & BRACE_PART_LOAD_ACROSS) != 0u
               ? "the load across the plane (only a limb with a coxa joint sends it, where controller.load_hz is not 0)"
           : (wanted & BRACE_PART_LOAD) != 0u ? "the load (it is sent where controller.load_hz is not 0)"
           : (wanted & BRACE_PART_SIGMA_SPACE) != 0u
               ? "the uncertainty of K in space (only a limb with a coxa joint sends it, where controller.sigma_hz is "
                 "not 0)"
           : (wanted & BRACE_PART_SIGMA) != 0u ? "K's uncertainty (it is sent where controller.sigma_hz is not 0)"
           : (wanted & BRACE_PART_SPACE) != 0u ? "K in space (only a limb with a coxa joint sends it)"
                                               : "the wanted part of a snapshot (controller.stiffness_hz, posture_hz)";
}

brace_client_status_t brace_can_read(brace_client_t *client, uint32_t wanted, uint64_t deadline_us,
                                     brace_client_snapshot_t *snapshot)
{
    const uint64_t begun_us = brace_bus_now_us();
    begin(client, deadline_us);
    int wait_ms = 0; /* first take frames that wait already, and of these the newest */
    for (;;) {
        const brace_client_status_t status = listen(client, wait_ms, NULL);
        if (status != BRACE_CLIENT_OK && status != BRACE_CLIENT_E_TIMEOUT) {
            return status;
        }
        const int left_ms = brace_bus_left_ms(deadline_us);
        if (status == BRACE_CLIENT_OK && left_ms > 0) {
            wait_ms = 0;
            continue;
        }
        /* A queue that was full holds only old frames, so wait for the next one. Where none comes, the one before will
         * do, unless it is older than the slowest controller's would be: then the controller has gone. */
        const uint64_t of_us = left_ms > 0 ? brace_bus_now_us() : begun_us, most_us = left_ms > 0 ? OLD_US : KEPT_US;
        if (newest(client, wanted, of_us > most_us ? of_us - most_us : 0u, snapshot)) {
            return BRACE_CLIENT_OK;
        }
        if (left_ms == 0) {
            return explain_silence(client, part_in_words(wanted));
        }
        wait_ms = left_ms;
    }
}
