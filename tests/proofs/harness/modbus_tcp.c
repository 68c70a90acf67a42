/* A TCP connection, a step at a time: whatever state the invariant allows and whatever comes,
 * a step ends in one again. */
#include "app.h"
#include "modbus/link.h"

uint32_t modbus_pdu_work(brace_app_t *whose, brace_app_modbus_work_t *work, uint8_t *pdu, uint32_t length,
                         uint32_t now_us)
{
    (void)whose;
    (void)work;
    (void)now_us;
    PROVE(length >= 1u && length <= MODBUS_PDU_BYTES && pdu > in_from && pdu + MODBUS_PDU_BYTES <= in_end,
          "a request as promised");
    const uint32_t answer = any_u32();
    ASSUME(answer <= MODBUS_PDU_BYTES);
    return answer;
}

uint32_t modbus_refuse(brace_app_t *whose, uint8_t *pdu, modbus_exception_t why)
{
    (void)whose;
    PROVE(__CPROVER_w_ok(pdu, 2) && why == MODBUS_E_TARGET, "another unit's request is refused as such");
    return 2;
}

enum { HEADER_BYTES = 7, LENGTH_FROM = 6 };

static bool sound(const brace_app_modbus_link_t *link)
{
    const uint32_t told = LENGTH_FROM + ((uint32_t)link->bytes[4] << 8 | link->bytes[5]);
    const bool head = link->count >= HEADER_BYTES + 1u; /* so much of it has been judged */
    return (link->phase == LINK_LISTEN || link->phase == LINK_WORK || link->phase == LINK_SEND) &&
           link->count <= HEADER_BYTES + MODBUS_PDU_BYTES && link->sent <= link->count &&
           (link->sent == 0u || link->phase == LINK_SEND) &&
           (link->phase != LINK_LISTEN || link->drop ||
            (!head || (link->count <= told && told <= HEADER_BYTES + MODBUS_PDU_BYTES))) &&
           (link->phase != LINK_WORK || (head && link->count == told)) && (link->phase != LINK_SEND || head);
}

int main(void)
{
    brace_app_t app; /* of any content */
    brace_app_modbus_link_t *tcp = &app.modbus.tcp;
    app.hal = &any_hal;
    in_from = out_from = tcp->bytes;
    in_end = out_end = tcp->bytes + sizeof tcp->bytes;
    ASSUME(sound(tcp));
    const uint32_t now_us = any_u32();
    const uint8_t phase = tcp->phase;
    if (any_bool()) {
        tcp_poll(&app, now_us);
    } else {
        ASSUME(phase == LINK_WORK); /* modbus_serve's condition */
        tcp_serve(&app, now_us);
        PROVE(tcp->phase == LINK_WORK || tcp->phase == LINK_SEND, "a request is worked on until it is answered");
    }
    PROVE(sound(tcp), "a step from a sound state ends in one");
    if (tcp->phase == LINK_SEND && phase == LINK_WORK) {
        const uint32_t length = (uint32_t)tcp->bytes[4] << 8 | tcp->bytes[5];
        PROVE(tcp->count == LENGTH_FROM + length && length >= 2u, "an answer is as long as it says");
    }
    return 0;
}
