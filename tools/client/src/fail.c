/* Writes in words why a call failed, and works out until when a call may try. */
#include "client_state.h"

#include <stdarg.h>
#include <stdio.h>

#include "brace/can_messages.h"

brace_client_status_t brace_client_fail(brace_client_t *client, brace_client_status_t status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(client->why, sizeof client->why, format, arguments);
    va_end(arguments);
    return status;
}

brace_client_status_t brace_client_fail_version(brace_client_t *client, uint32_t node, uint32_t hash)
{
    return brace_client_fail(
        client, BRACE_CLIENT_E_VERSION,
        "%s: controller %u speaks dictionary 0x%08x, this library 0x%08x; build the client from the "
        "firmware's version, or flash the controller with this one's ('brace flash')",
        client->url, (unsigned)node, (unsigned)hash, (unsigned)BRACE_DICTIONARY_HASH);
}

brace_client_status_t brace_client_out_of_range(brace_client_t *client)
{
    return brace_client_fail(client, BRACE_CLIENT_E_USAGE, "a value lies outside its range; client.h states them");
}

uint64_t brace_client_deadline_after(int timeout_ms)
{
    return brace_bus_now_us() + (uint64_t)(timeout_ms < 1 ? 1 : timeout_ms) * 1000u;
}
