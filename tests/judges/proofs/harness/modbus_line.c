/* The serial line, a tick at a time: whatever state the invariant allows and whatever comes, a tick ends in one
 * again. */
#include "port.h"
#include "wire/modbus/crc.h"
#include "wire/modbus/line.h"
#include "wire/modbus/pdu.h"

/* Following 260 bytes of CRC would say nothing more: any number. */
uint16_t modbus_crc(uint16_t crc, const uint8_t *bytes, uint32_t count)
{
    (void)crc;
    PROVE(bytes >= in_from && bytes <= in_end && count <= (size_t)(in_end - bytes), "the check is of bytes that came");
    return any_u16();
}

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

uint32_t modbus_pdu_least_length(const uint8_t *pdu, uint32_t length)
{
    PROVE(length >= 1u && pdu >= in_from && pdu + length <= in_end, "a request that has begun");
    return any_u32();
}

static brace_parameters_t parameters;

const brace_parameters_t *brace_app_parameters(const brace_app_t *app)
{
    (void)app;
    return &parameters;
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

static bool sound(const modbus_line_t *line)
{
    const modbus_link_t *link = &line->link;
    const bool is_request = link->count > 0u && !link->is_sending;
    return link->count <= (link->is_skipping ? (uint32_t)MODBUS_LINK_BYTES : 256u) && link->ready <= link->count &&
           link->sent <= link->ready && ((link->ready == 0u && link->sent == 0u) || link->is_sending) &&
           (!line->has_question || (!link->is_sending && !link->is_skipping && link->count >= 4u)) &&
           line->ahead_count <= MODBUS_AHEAD_BYTES && line->asked_count <= MODBUS_LINE_QUESTION_BYTES &&
           line->sound <= link->count && line->looked <= MODBUS_LINK_BYTES &&
           (!link->is_sending || link->ready == link->count ||
            (link->ready == line->checked && line->checked + 2u <= link->count)) &&
           !(link->is_sending && link->is_skipping) && (!link->is_sending || link->count >= 5u) &&
           line->checked <= MODBUS_LINK_BYTES && (!is_request || line->checked <= link->count);
}

int main(void)
{
    modbus_line_t line; /* of any content, as all of these */
    modbus_server_t server;
    wire_tick_t tick;
    modbus_link_t *link = &line.link;
    brace_app_counters_t counters;
    tick.hal = &any_hal;
    tick.counters = &counters;
    in_from = out_from = link->bytes;
    in_end = out_end = link->bytes + sizeof link->bytes;
    parameters.controller.tick_us = any_u32();
    ASSUME(sound(&line));
    const bool was_sending = link->is_sending;
    uint32_t done = 0;
    (void)modbus_line_hear(&line, &server, &tick, &done);
    PROVE(sound(&line), "the beginning of a tick ends in a sound state");
    (void)modbus_line_answer(&line, &server, &tick, any_bool());
    PROVE(sound(&line), "a tick from a sound state ends in one");
    PROVE(!was_sending || link->is_sending || link->count == 0u, "after an answer the line listens anew");
    return 0;
}
