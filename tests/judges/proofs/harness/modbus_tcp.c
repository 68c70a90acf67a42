/* TCP connections, a step at a time: whatever state the invariant allows and whatever comes, reading once ends in one
 * again, so reading any number of times does; so does the end of a tick. */
#include "copies.h"
#include "port.h"
#include "wire/modbus/pdu.h"
#include "wire/modbus/tcp.c" /* for its inner functions: modbus_tcp_hear is many rounds of them */

/* Whether a K that is waited for is there, nobody knows. */
bool brace_app_k_is_coming(brace_app_t *app, brace_asker_t asker)
{
    (void)app;
    (void)asker;
    return any_bool();
}

uint32_t modbus_pdu_answer(modbus_server_t *server, modbus_half_t *half, const wire_tick_t *tick, uint8_t *pdu,
                           uint32_t length)
{
    (void)server;
    (void)half;
    (void)tick;
    PROVE(length >= 1u && length <= MODBUS_PDU_BYTES && pdu > in_from && pdu + MODBUS_PDU_BYTES <= in_end,
          "a request as promised");
    const uint32_t answer = any_u32();
    ASSUME(answer != 1u && answer <= MODBUS_PDU_BYTES); /* 0: it is being worked out */
    return answer;
}

uint32_t modbus_pdu_refuse(modbus_server_t *server, const wire_tick_t *tick, uint8_t *pdu, modbus_exception_t why)
{
    (void)server;
    (void)tick;
    PROVE(__CPROVER_w_ok(pdu, 2) && why == MODBUS_E_TARGET, "another unit's request is refused as such");
    return 2;
}

enum { HEADER_BYTES = 7, LENGTH_FROM = 6 };

static uint32_t stated(const modbus_link_t *link)
{
    return LENGTH_FROM + ((uint32_t)link->bytes[4] << 8 | link->bytes[5]);
}

brace_status_t brace_app_stop(brace_app_t *app)
{
    (void)app;
    return any_bool() ? BRACE_OK : BRACE_E_MODE;
}

answer_rank_t modbus_pdu_rank(const uint8_t *pdu, uint32_t length)
{
    PROVE(__CPROVER_r_ok(pdu, length), "a request that is there");
    const uint32_t rank = any_u32();
    ASSUME(rank <= (uint32_t)ANSWER_QUESTION);
    return (answer_rank_t)rank;
}

static bool sound(const modbus_tcp_t *tcp)
{
    const modbus_link_t *link = &tcp->link;
    const bool has_head = link->count >= HEADER_BYTES + 1u; /* so much of it has been judged */
    bool are_sound = tcp->turn < MODBUS_CONNECTIONS && tcp->waiting < MODBUS_CONNECTIONS;
    for (uint32_t i = 0; i < MODBUS_CONNECTIONS; i++) {
        const modbus_connection_t *connection = &tcp->connection[i];
        are_sound =
            are_sound && connection->first < MODBUS_QUESTIONS_EACH && connection->count <= MODBUS_QUESTIONS_EACH;
        for (uint32_t k = 0; k < MODBUS_QUESTIONS_EACH; k++) {
            const uint8_t length = connection->question[k].length;
            are_sound = are_sound && length >= HEADER_BYTES + 1u && length <= MODBUS_QUESTION_BYTES;
        }
    }
    return are_sound && !link->is_sending && link->count <= HEADER_BYTES + MODBUS_PDU_BYTES &&
           (!has_head || link->is_skipping ||
            (link->count < stated(link) && stated(link) <= HEADER_BYTES + MODBUS_PDU_BYTES)) &&
           (!tcp->waits || tcp->connection[tcp->waiting].count > 0u);
}

int main(void)
{
    modbus_tcp_t tcp; /* of any content, as all of these */
    modbus_server_t server;
    wire_tick_t tick;
    brace_app_counters_t counters;
    uint32_t done = 0;
    tick.hal = &any_hal;
    tick.counters = &counters;
    in_from = out_from = tcp.link.bytes;
    in_end = out_end = tcp.link.bytes + sizeof tcp.link.bytes;
    ASSUME(sound(&tcp));
    if (any_bool()) { /* what modbus_tcp_hear does again and again */
        if (tcp.link.is_skipping) {
            skip(&tcp.link, &server, &tick);
        } else if (gather(&tcp.link, &tick)) {
            (void)take(&tcp, &server, &tick, &done);
        }
        PROVE(sound(&tcp), "reading once ends in a sound state");
    } else if (any_bool()) { /* and after that */
        modbus_link_break(&tcp.link, &server, &tick);
        PROVE(sound(&tcp), "a part that is too late ends in a sound state");
    } else {
        (void)modbus_tcp_answer(&tcp, &server, &tick);
        PROVE(sound(&tcp), "answering ends in a sound state");
    }
    return 0;
}
