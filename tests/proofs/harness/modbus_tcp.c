/* A TCP connection, a tick at a time: whatever state the invariant allows and whatever comes, a tick ends in one
 * again. */
#include "port.h"
#include "wire/modbus/pdu.h"
#include "wire/modbus/tcp.h"

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

static uint32_t told(const modbus_link_t *link)
{
    return LENGTH_FROM + ((uint32_t)link->bytes[4] << 8 | link->bytes[5]);
}

static bool sound(const modbus_link_t *link)
{
    const bool has_head = link->count >= HEADER_BYTES + 1u; /* so much of it has been judged */
    const bool is_request = !link->is_sending && !link->is_skipping;
    const bool is_whole = link->is_waiting ? link->count == told(link) : link->count < told(link);
    return link->count <= HEADER_BYTES + MODBUS_PDU_BYTES && link->ready <= link->count && link->sent <= link->ready &&
           (link->is_sending ? link->ready == link->count : link->ready == 0u && link->sent == 0u) &&
           !(link->is_sending && link->is_skipping) && (!link->is_waiting || (is_request && has_head)) &&
           (!(is_request && has_head) || (is_whole && told(link) <= HEADER_BYTES + MODBUS_PDU_BYTES)) &&
           (!link->is_sending || has_head);
}

int main(void)
{
    modbus_link_t tcp; /* of any content, as all of these */
    modbus_server_t server;
    wire_tick_t tick;
    brace_app_counters_t counters;
    tick.hal = &any_hal;
    tick.counters = &counters;
    in_from = out_from = tcp.bytes;
    in_end = out_end = tcp.bytes + sizeof tcp.bytes;
    ASSUME(sound(&tcp));
    const bool was_sending = tcp.is_sending;
    modbus_tcp_tick(&tcp, &server, &tick);
    PROVE(sound(&tcp), "a tick from a sound state ends in one");
    PROVE(was_sending || !tcp.is_sending || tcp.count == told(&tcp), "an answer is as long as it says");
    PROVE(!was_sending || tcp.is_sending || tcp.count == 0u, "after an answer the connection listens anew");
    return 0;
}
