/* Registers read: any request, any state. */
#include "proof.h"
#include "wire/modbus/command.h"
#include "wire/modbus/read.h"

/* Any value, of one that there is. The answers lie within the server, where CBMC's own checks do not see their end. */
static const brace_answered_t *answered;

void *memcpy(void *restrict to, const void *restrict from, size_t count)
{
    const uint8_t *first = (const uint8_t *)answered, *at = from;
    PROVE(__CPROVER_same_object(from, answered) ? at >= first && at + count <= first + sizeof *answered
                                                : __CPROVER_r_ok(from, count),
          "a value that there is");
    PROVE(count == 4u && __CPROVER_w_ok(to, count), "one value");
    return to;
}

static brace_parameters_t staged;
const brace_parameters_t *brace_app_parameters_staged(const brace_app_t *app)
{
    (void)app;
    return &staged;
}

/* Of each number any parameter, or none: the table lies elsewhere, so its entries are any. */
static void assume_parameters(void)
{
    for (uint32_t i = 0; i < BRACE_PARAMETER_NUMBERS; i++) {
        ASSUME(brace_parameter_indices[i] <= BRACE_PARAMETER_COUNT);
    }
}

void modbus_command_report(const modbus_server_t *server, const brace_app_t *app, brace_commands_t *commands)
{
    (void)server;
    (void)app;
    PROVE(__CPROVER_w_ok(commands, sizeof *commands), "there is room for every command");
}

int main(void)
{
    modbus_server_t server; /* of any content, as all of these */
    brace_measured_t measured;
    wire_tick_t tick;
    uint8_t pdu[MODBUS_PDU_BYTES];
    const uint32_t length = any_u32(), unanswered = any_u32();
    uint32_t answer = unanswered;
    ANY(staged);
    assume_parameters();
    answered = &server.answered;
    tick.measured = &measured;
    ASSUME(pdu[0] == MODBUS_READ_HOLDING || pdu[0] == MODBUS_READ_INPUT);
    const modbus_exception_t why = modbus_read(&server, &tick, pdu, length, &answer);
    if (why == MODBUS_FINE) {
        PROVE(length == 5u, "a request of another length is refused");
        PROVE(answer == 2u + pdu[1] && pdu[1] >= 2u && pdu[1] <= 250u && pdu[1] % 2u == 0u,
              "an answer says its own length");
    } else {
        PROVE(why == MODBUS_E_VALUE || why == MODBUS_E_ADDRESS, "refused as the protocol has it");
        PROVE(answer == unanswered, "refused: no answer");
    }
    return 0;
}
