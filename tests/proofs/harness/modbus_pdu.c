/* A request of any bytes, whatever the controller's state. What it asks of the rest of the controller may answer
 * anything that the header in question allows. */
#include "modbus/pdu.h"
#include "modbus/read.h"
#include "modbus/write.h"
#include "answers.h"
#include "copies.h"
#include "proof.h"

void staging_keep(brace_app_t *app) { (void)app; }

/* Asked twice of the same state it says the same. */
static brace_status_t open_or_not;
brace_status_t staging_open(brace_app_t *app) { (void)app; return open_or_not; }

brace_status_t staging_write(brace_app_t *app, uint32_t index, uint32_t word)
{
    (void)app;
    (void)word;
    PROVE(index < BRACE_PARAMETER_COUNT, "a member that there is is written");
    return any_status();
}

brace_status_t brace_parameter_in_range(uint32_t index, uint32_t word)
{
    (void)word;
    PROVE(index < BRACE_PARAMETER_COUNT, "a member that there is is judged");
    return any_status();
}

brace_status_t staging_commit(brace_app_t *app, uint32_t *wrong_index)
{
    (void)app;
    (void)wrong_index;
    return any_status();
}
brace_status_t brace_app_configuration_enter(brace_app_t *app) { (void)app; return any_status(); }
brace_status_t brace_app_configuration_leave(brace_app_t *app) { (void)app; return any_status(); }
brace_status_t brace_app_parameters_rollback(brace_app_t *app) { (void)app; return any_status(); }
brace_status_t brace_app_let_go(brace_app_t *app) { (void)app; return any_status(); }
brace_status_t brace_app_clear(brace_app_t *app, uint32_t faults) { (void)app; (void)faults; return any_status(); }
brace_status_t brace_app_take_up(brace_app_t *app, int32_t joint, int32_t flank)
{
    (void)app;
    (void)joint;
    PROVE(flank == 1 || flank == -1, "a flank that there is");
    return any_status();
}

modbus_exception_t modbus_read(const brace_app_t *app, uint8_t *pdu, uint32_t length, uint32_t now_us, uint32_t *answer)
{
    (void)app;
    (void)now_us;
    PROVE(length >= 1u && __CPROVER_rw_ok(pdu, MODBUS_PDU_BYTES), "a request as promised");
    const uint8_t bytes = any_u8();
    ASSUME(bytes >= 2u && bytes <= 250u && bytes % 2u == 0u);
    if (any_bool()) {
        return any_bool() ? MODBUS_E_VALUE : MODBUS_E_ADDRESS;
    }
    pdu[1] = bytes;
    *answer = 2u + bytes;
    return MODBUS_FINE;
}

/* What modbus_write_block has left for its next piece; nothing at first. */
static bool sound(const brace_app_modbus_work_t *work, const uint8_t *pdu, uint32_t length)
{
    if (!work->begun) {
        return true;
    }
    const uint32_t values = work->area == 2u ? BRACE_PARAMETER_COUNT : BRACE_COMMANDS_COUNT;
    return pdu[0] == MODBUS_WRITE_BLOCK && work->count >= 1u && length == 6u + 4u * work->count && work->count <= 61u &&
           (work->area == 2u || work->area == 3u) && work->start + work->count <= values && work->done <= work->count &&
           (work->done < work->count || !work->checked);
}

int main(void)
{
    brace_app_t app; /* of any content */
    brace_app_modbus_work_t work;
    uint8_t pdu[MODBUS_PDU_BYTES];
    const uint32_t length = any_u32(), now_us = any_u32();
    ASSUME(length >= 1u && length <= MODBUS_PDU_BYTES);
    ASSUME(sound(&work, pdu, length));
    open_or_not = any_status();
    const uint8_t function = pdu[0];
    const uint32_t progress = !work.begun ? 0u : 1u + (work.checked ? 64u : 0u) + work.done;
    const uint16_t refused = app.modbus.refused;

    const uint32_t answer = modbus_pdu_work(&app, &work, pdu, length, now_us);

    PROVE(answer <= MODBUS_PDU_BYTES, "an answer fits");
    if (answer == 0u) {
        PROVE(function == MODBUS_WRITE_BLOCK && work.begun, "only a block is written in pieces");
        PROVE(1u + (work.checked ? 64u : 0u) + work.done > progress, "each piece comes nearer to the answer");
        PROVE(sound(&work, pdu, length), "what is left for the next piece is as it has to be");
        return 0;
    }
    const uint8_t why = pdu[1];
    if ((pdu[0] & MODBUS_REFUSED) != 0u && (function & MODBUS_REFUSED) == 0u) {
        PROVE(answer == 2u && pdu[0] == (function | MODBUS_REFUSED), "an exception is two bytes and says of what");
        PROVE((why >= 1u && why <= 4u) || why == 6u, "an exception is one that the protocol has");
        PROVE(app.modbus.refused == (uint16_t)(refused + 1u), "an exception is counted");
    }
    const bool known = function == 3u || function == 4u || function == 6u || function == 8u || function == 16u ||
                       function == 17u || function == 43u;
    PROVE(known || ((pdu[0] & MODBUS_REFUSED) != 0u && why == MODBUS_E_FUNCTION && answer == 2u),
          "no such function: exception 1");
    if (pdu[0] == function && (function == 3u || function == 4u)) {
        PROVE(answer == 2u + pdu[1] && pdu[1] >= 2u && pdu[1] <= 250u && pdu[1] % 2u == 0u,
              "registers read: as many bytes as are told");
    }
    if (pdu[0] == function && (function == 6u || function == 16u)) {
        PROVE(answer == 5u, "registers written: the request's first five bytes");
    }
    return 0;
}
