/* The serial line, a step at a time: whatever state the invariant allows and whatever comes,
 * a step ends in one again. */
#include "app.h"
#include "modbus/crc.h"
#include "modbus/link.h"

/* 64 bytes of CRC would say nothing more: any number. */
uint16_t modbus_crc(uint16_t crc, const uint8_t *bytes, uint32_t count)
{
    (void)crc;
    PROVE(bytes >= in_from && bytes <= in_end && count <= (size_t)(in_end - bytes), "the check is of bytes that came");
    return any_u16();
}

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

uint32_t modbus_request_length(const uint8_t *pdu, uint32_t length)
{
    PROVE(length >= 1u && __CPROVER_r_ok(pdu, length), "a request that has begun");
    return any_u32();
}

static bool sound(const brace_app_modbus_link_t *link)
{
    const bool busy = link->phase == LINK_CHECK || link->phase == LINK_WORK || link->phase == LINK_SEAL;
    return link->phase <= LINK_SEND && (link->drop || link->checked <= link->count) && link->sent <= link->count &&
           (link->sent == 0u || link->phase == LINK_SEND) && (!link->drop || link->phase <= LINK_CHECK) &&
           (link->phase != LINK_LISTEN || link->count <= 256u) && (!busy || link->count >= 1u) &&
           (link->phase != LINK_CHECK || link->count <= 256u) && (link->phase != LINK_SEND || link->count <= 256u) &&
           (link->phase != LINK_WORK || (link->count >= 4u && link->count <= 256u)) &&
           (link->phase != LINK_SEAL || link->count <= 254u);
}

int main(void)
{
    brace_app_t app; /* of any content */
    brace_app_modbus_link_t *line = &app.modbus.line;
    app.hal = &any_hal;
    in_from = out_from = line->bytes;
    in_end = out_end = line->bytes + sizeof line->bytes;
    ASSUME(sound(line));
    const uint32_t now_us = any_u32();
    const uint8_t phase = line->phase;
    if (any_bool()) {
        line_poll(&app, now_us);
    } else {
        ASSUME(phase == LINK_CHECK || phase == LINK_WORK || phase == LINK_SEAL); /* modbus_serve's condition */
        line_serve(&app, now_us, any_bool());
    }
    PROVE(sound(line), "a step from a sound state ends in one");
    PROVE(phase != LINK_SEND || line->phase == LINK_SEND || line->count == 0u, "after an answer the line listens anew");
    return 0;
}
