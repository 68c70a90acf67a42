/* A request of any bytes, whatever the controller's state. What it asks of the controller may answer anything that
 * brace/requests.h allows. */
#include "copies.h"
#include "proof.h"
#include "wire/answers/answer.h"
#include "wire/modbus/pdu.h"
#include "wire/modbus/read.h"
#include "wire/modbus/write.h"

static brace_status_t any_status(void)
{
    const int32_t status = any_i32();
    ASSUME(status <= 0 && status >= BRACE_E_MODE);
    return (brace_status_t)status;
}

/* ------------------------------------------------------------------------------------- the controller -- */

brace_mode_t brace_app_mode(const brace_app_t *app)
{
    (void)app;
    return (brace_mode_t)any_u32();
}
uint32_t brace_app_faults(const brace_app_t *app)
{
    (void)app;
    return any_u32();
}
bool brace_app_is_storing(const brace_app_t *app)
{
    (void)app;
    return any_bool();
}
brace_status_t brace_app_may_write(brace_app_t *app)
{
    (void)app;
    return any_status();
}

brace_status_t brace_app_parameters_stage(brace_app_t *app, uint32_t first_number, uint32_t count,
                                          const uint32_t *words)
{
    (void)app;
    PROVE(count >= 1u && first_number < BRACE_PARAMETER_NUMBERS && count <= BRACE_PARAMETER_NUMBERS - first_number,
          "numbers that parameters have are written");
    PROVE(__CPROVER_r_ok(words, 4u * count), "each member has its word");
    return any_status();
}

brace_status_t brace_app_store_status(const brace_app_t *app, brace_store_status_t *status)
{
    (void)app;
    brace_store_status_t any;
    *status = any;
    return BRACE_OK;
}

brace_setting_t brace_app_setting(const brace_app_t *app)
{
    (void)app;
    return (brace_setting_t)any_u32();
}

int32_t brace_app_life(brace_app_t *app, brace_who_t who, const brace_sign_t *sign)
{
    (void)app;
    (void)who;
    PROVE(sign != NULL && sign->heard_bits == 32u, "a sign of life has a whole number");
    const int32_t status = any_i32();
    ASSUME(status <= 0 && status >= BRACE_REFUSED_STORE - 7);
    return status;
}

int32_t answer_admit(request_t *request, brace_command_t command)
{
    PROVE(__CPROVER_r_ok(request->bytes, request->count) && command == BRACE_COMMAND_WRITES, "the request as it came");
    const int32_t status = any_i32();
    ASSUME(status <= 0 && status >= BRACE_REFUSED_STORE - 7);
    return status;
}

/* Any answer, of a request that Modbus knows. */
int32_t answer_request(request_t *request, uint32_t code, const brace_request_t *asked, brace_answer_t *answer)
{
    brace_answer_t any;
    const int32_t status = any_i32();
    ASSUME(status <= ANSWER_AGAIN && status >= BRACE_REFUSED_STORE - 7);
    PROVE((code >= BRACE_REQUEST_K_AT_POSTURE && code <= BRACE_REQUEST_SET_MODE) || code == BRACE_REQUEST_COMMIT ||
              code == BRACE_REQUEST_ROLLBACK || code == BRACE_REQUEST_TAKE_UP || code == BRACE_REQUEST_LET_GO ||
              code == BRACE_REQUEST_LOADING_TEST_STOP || code == BRACE_REQUEST_WRITE_ENTRY ||
              code == BRACE_REQUEST_CLEAR || code == BRACE_REQUEST_K_IN_SPACE_AT_POSTURE ||
              (code >= BRACE_REQUEST_SET_GRAVITY && code <= BRACE_REQUEST_CODE_MOST),
          "a request that Modbus knows");
    PROVE(code != BRACE_REQUEST_TAKE_UP || asked->take_up.flank == 1 || asked->take_up.flank == -1,
          "a flank that there is");
    PROVE(request->upload == NULL && request->download == NULL, "no block is committed that nobody has uploaded");
    PROVE(code != BRACE_REQUEST_WRITE_ENTRY || asked->write_entry.index >= BRACE_ENTRY_COMMANDS,
          "an entry that is a command");
    *answer = any;
    request->is_of_now = any_bool();
    return status;
}

modbus_exception_t modbus_read(const modbus_server_t *server, const wire_tick_t *tick, uint8_t *pdu, uint32_t length,
                               uint32_t *answer)
{
    (void)server;
    (void)tick;
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

/* ---------------------------------------------------------------------------------------------- claims -- */

int main(void)
{
    modbus_server_t server; /* of any content, as all of these */
    modbus_half_t half;
    wire_tick_t tick;
    brace_app_counters_t counters;
    uint8_t pdu[MODBUS_PDU_BYTES];
    const uint32_t at = any_u32();
    ASSUME(at < MODBUS_PDU_BYTES); /* any byte, so all */
    const uint8_t as_sent = pdu[at];
    const uint32_t length = any_u32();
    ASSUME(length >= 1u && length <= MODBUS_PDU_BYTES);
    tick.counters = &counters;
    watched_struct = &server;
    member_from[0] = (const uint8_t *)&server.written, member_end[0] = member_from[0] + sizeof server.written;
    member_from[1] = (const uint8_t *)&server.answered, member_end[1] = member_from[1] + sizeof server.answered;
    const uint32_t word = any_u32(); /* any word of what was asked and answered, so all */
    ASSUME(word < sizeof server.written / 4u);
    const uint32_t *const written = (const uint32_t *)&server.written + word, as_written = *written;
    const brace_asker_t asker = server.asker;
    const uint8_t address = server.address;
    const uint8_t function = pdu[0];
    const uint16_t refused = server.refused;

    const uint32_t answer = modbus_pdu_answer(&server, &half, &tick, pdu, length);

    /* Copies are not followed here (copies.h), and a take-up that begins is reported. */
    PROVE(*written == as_written || word == offsetof(brace_commands_t, take_up) / 4u, "nothing else is written");
    PROVE(server.asker == asker && server.address == address, "nor who asked, nor whom");

    if (answer == 0u) { /* it is being worked out */
        PROVE(function == 16u && pdu[at] == as_sent, "only a question is put again, and it stays as it is");
        return 0;
    }
    PROVE(answer >= 2u && answer <= MODBUS_PDU_BYTES, "an answer fits");
    const uint8_t why = pdu[1];
    if ((pdu[0] & MODBUS_REFUSED) != 0u && (function & MODBUS_REFUSED) == 0u) {
        PROVE(answer == 2u && pdu[0] == (function | MODBUS_REFUSED), "an exception is two bytes and says of what");
        PROVE((why >= 1u && why <= 4u) || why == 6u || why == 7u, "an exception is one that the protocol has");
        PROVE(server.refused == (uint16_t)(refused + 1u), "an exception is counted");
    }
    const bool known = function == 3u || function == 4u || function == 6u || function == 8u || function == 16u ||
                       function == 17u || function == 43u;
    PROVE(known || ((pdu[0] & MODBUS_REFUSED) != 0u && why == MODBUS_E_FUNCTION && answer == 2u),
          "no such function: exception 1");
    if (pdu[0] == function && (function == 3u || function == 4u)) {
        PROVE(answer == 2u + pdu[1] && pdu[1] >= 2u && pdu[1] <= 250u && pdu[1] % 2u == 0u,
              "registers read: as many bytes as are announced");
    }
    if (pdu[0] == function && (function == 6u || function == 16u)) {
        PROVE(answer == 5u, "registers written: the request's first five bytes");
    }
    return 0;
}
