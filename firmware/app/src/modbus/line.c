/* Modbus RTU: address, PDU, CRC; a frame ends with 3.5 characters of silence (Modbus over serial line 1.02, 2.5.1). */
#include "modbus/crc.h"
#include "modbus/link.h"

enum { ADDRESS = 1, CHECK = 2, LEAST = ADDRESS + 1 + CHECK, MOST = 256, EVERYBODY = 0 };

/* How long the rest of a frame for us may be on its way: adapters hold bytes back, 16 ms the commonest. */
#define PATIENCE_US 20000u

static void gather(brace_app_t *app, brace_app_modbus_link_t *link, uint32_t now_us)
{
    const uint32_t left = BRACE_APP_ADU_BYTES - (uint32_t)link->count, room = left < LINK_READ ? left : LINK_READ;
    const int32_t count =
        app->hal->serial_read(app->hal->context, BRACE_SERIAL_MODBUS, link->bytes + link->count, room);
    if (count > 0) {
        link->heard_us = now_us;
        link->count = (uint16_t)(link->count + count);
        if (link->drop || link->count > MOST) { /* too long: to its end, and none of it counts */
            link->drop = true;
            link->count = MOST / 2;
        }
        return;
    }
    const uint32_t silent_us = now_us - link->heard_us;
    const bool news = link->count > link->checked;
    if (link->count > 0u && silent_us >= app->modbus.silence_us && (news || silent_us >= PATIENCE_US)) {
        link->phase = LINK_CHECK;
    }
}

void line_poll(brace_app_t *app, uint32_t now_us)
{
    brace_app_modbus_link_t *link = &app->modbus.line;
    if (link->phase == LINK_LISTEN) {
        gather(app, link, now_us);
    } else if (link->phase == LINK_SEND) {
        link_send(app, link, BRACE_SERIAL_MODBUS, now_us);
    }
}

/* A piece of the check over link->count bytes. returns whether that was the last */
static bool check(brace_app_modbus_link_t *link)
{
    if (link->checked == 0u) {
        link->crc = MODBUS_CRC_START;
    }
    const uint32_t left = (uint32_t)link->count - link->checked, count = left < LINK_PIECE ? left : LINK_PIECE;
    link->crc = modbus_crc(link->crc, link->bytes + link->checked, count);
    link->checked = (uint16_t)(link->checked + count);
    return link->checked == link->count;
}

static bool may_go_on(const brace_app_modbus_t *modbus, const brace_app_modbus_link_t *link)
{
    if (link->drop || (link->bytes[0] != modbus->address && link->bytes[0] != EVERYBODY)) {
        return false;
    }
    const uint32_t pdu = (uint32_t)link->count - ADDRESS;
    return pdu == 0u || pdu < modbus_request_length(link->bytes + ADDRESS, pdu) + CHECK;
}

/* What has come is a frame, or broken, or half of one. */
static void judge(brace_app_t *app, brace_app_modbus_link_t *link, uint32_t silent_us)
{
    brace_app_modbus_t *modbus = &app->modbus;
    const uint8_t address = link->bytes[0], function = link->bytes[ADDRESS];
    if (link->drop || link->count < LEAST || link->crc != 0u) {
        if (silent_us < PATIENCE_US && may_go_on(modbus, link)) {
            link->phase = LINK_LISTEN;
        } else {
            link_broken(app, link);
        }
        return;
    }
    modbus->messages++;
    const bool writes = function == MODBUS_WRITE_ONE || function == MODBUS_WRITE_BLOCK;
    const bool ours = address == modbus->address || address == EVERYBODY;
    if (!ours || (function & MODBUS_REFUSED) != 0u) { /* another's, or an answer come back */
        link_rest(link);
        return;
    }
    modbus->served++;
    if (address == EVERYBODY && !writes) {
        modbus->unanswered++;
        link_rest(link);
        return;
    }
    link->phase = LINK_WORK;
}

static void work(brace_app_t *app, brace_app_modbus_link_t *link, uint32_t now_us)
{
    const uint32_t length =
        modbus_pdu_work(app, &link->work, link->bytes + ADDRESS, (uint32_t)link->count - ADDRESS - CHECK, now_us);
    if (length == 0u) {
        return;
    }
    if (link->bytes[0] == EVERYBODY) {
        app->modbus.unanswered++;
        link_rest(link);
        return;
    }
    link->count = (uint16_t)(ADDRESS + length);
    link->checked = 0;
    link->phase = LINK_SEAL;
}

static void seal(brace_app_modbus_link_t *link, uint32_t now_us)
{
    if (check(link)) {
        link->bytes[link->count] = (uint8_t)link->crc;
        link->bytes[link->count + 1u] = (uint8_t)(link->crc >> 8);
        link->count = (uint16_t)(link->count + CHECK);
        link->heard_us = now_us;
        link->phase = LINK_SEND;
    }
}

void line_serve(brace_app_t *app, uint32_t now_us, bool all)
{
    brace_app_modbus_link_t *link = &app->modbus.line;
    if (link->phase == LINK_CHECK) {
        const bool is_short = link->count <= LINK_SHORT;
        if (link->drop || check(link)) {
            judge(app, link, now_us - link->heard_us);
        }
        if (!is_short || !all) {
            return;
        }
    }
    if (link->phase == LINK_WORK) {
        work(app, link, now_us);
        if (link->phase != LINK_SEAL || link->count > LINK_SHORT || !all) {
            return;
        }
    }
    if (link->phase == LINK_SEAL) {
        seal(link, now_us);
    }
}
