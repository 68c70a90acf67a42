#include "wire/modbus/refusal.h"

modbus_exception_t modbus_refusal_of(int32_t status)
{
    switch (status) {
    case BRACE_OK:
    case ANSWER_LATER: return MODBUS_FINE; /* its register reports what has begun */
    case BRACE_E_MODE: return MODBUS_E_FUNCTION;
    case BRACE_E_CHECKSUM:
    case BRACE_E_RANGE:
    case BRACE_E_PARAMETER:
    case BRACE_E_NOT_FINITE:
    case BRACE_E_UNREACHABLE: return MODBUS_E_VALUE;
    case BRACE_REFUSED_CEILING: return MODBUS_E_VALUE;
    case BRACE_REFUSED_EARLY:
    case BRACE_REFUSED_BUSY: return MODBUS_E_BUSY;
    case BRACE_REFUSED_STRANGER:
    case BRACE_REFUSED_REPLAY:
    case BRACE_REFUSED_LATE:
    case BRACE_REFUSED_OWNED:
    case BRACE_REFUSED_NO_KEY: return MODBUS_E_OWNER;
    default: return MODBUS_E_DEVICE;
    }
}

modbus_exception_t modbus_refusal_to_write(brace_app_t *app)
{
    const brace_status_t status = brace_app_may_write(app);
    return status == BRACE_E_UNSUPPORTED ? MODBUS_E_BUSY : modbus_refusal_of(status);
}
