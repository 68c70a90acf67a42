/* When an owner gives the next sign of life. The wires give it. */
#include "client_state.h"

enum { LIFE_US = 40000 };

bool brace_client_life_is_due(brace_client_t *client)
{
    const bool has_any = client->bus == NULL || client->owner.has_number || client->owner.has_begin;
    if (!client->lives || !has_any || brace_bus_left_ms(client->next_life_us) > 0) {
        return false;
    }
    client->next_life_us = brace_bus_now_us() + LIFE_US;
    return true;
}
