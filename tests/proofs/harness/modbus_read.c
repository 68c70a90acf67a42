/* Registers read: any request, any state. */
#include "modbus/command.h"
#include "modbus/read.h"
#include "proof.h"
#include "report/measured.h"

/* Any value, of one that there is. CBMC's own checks know where an object ends, and the controller is one object. */
static const brace_app_t *whose;

static bool within(const uint8_t *from, size_t count, const void *values, size_t bytes)
{
    return from >= (const uint8_t *)values && from + count <= (const uint8_t *)values + bytes;
}

void *memcpy(void *restrict to, const void *restrict from, size_t count)
{
    const bool is_ours = __CPROVER_same_object(from, whose);
    PROVE(is_ours ? within(from, count, &whose->parameters, sizeof whose->parameters) ||
                        within(from, count, &whose->staging.set, sizeof whose->staging.set) ||
                        within(from, count, &whose->modbus.answered, sizeof whose->modbus.answered)
                  : __CPROVER_r_ok(from, count),
          "a value that there is");
    PROVE(count == 4u && __CPROVER_w_ok(to, count), "one value");
    return to;
}

void brace_measured_take(const brace_app_t *app, uint32_t now_us, brace_measured_t *measured)
{
    (void)app;
    (void)now_us;
    PROVE(__CPROVER_w_ok(measured, sizeof *measured), "there is room for all that is measured");
}

uint32_t command_read(const brace_app_t *app, uint32_t index)
{
    (void)app;
    PROVE(index < BRACE_COMMANDS_COUNT, "a command that there is");
    return any_u32();
}

int main(void)
{
    brace_app_t app; /* of any content */
    uint8_t pdu[MODBUS_PDU_BYTES];
    const uint32_t length = any_u32(), unanswered = any_u32();
    uint32_t answer = unanswered;
    whose = &app;
    ASSUME(pdu[0] == MODBUS_READ_HOLDING || pdu[0] == MODBUS_READ_INPUT);
    const modbus_exception_t why = modbus_read(&app, pdu, length, any_u32(), &answer);
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
