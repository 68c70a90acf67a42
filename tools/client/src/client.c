/* A client: opened, asked who it speaks with, read, closed. */
#include "client_can.h"
#include "client_modbus.h"
#include "client_modbus_link.h"

#include <stdlib.h>
#include <string.h>

brace_client_status_t brace_client_open(const char *url, uint32_t node, uint32_t bit_rate, int timeout_ms,
                                        brace_client_t **client, char *why, unsigned why_room)
{
    if (client == NULL) {
        return BRACE_CLIENT_E_USAGE;
    }
    *client = NULL;
    if (url == NULL || url[0] == '\0' || strlen(url) >= sizeof(*client)->url || node > 127u || timeout_ms < 100 ||
        timeout_ms > 60000) {
        brace_bus_say(why, why_room,
                      "needs a bus URL (can0, slcan:/dev/ttyACM0, tcp://host:port, modbus:/dev/ttyUSB0, "
                      "modbus-tcp://host:port), a node of 0 to 127, a time-out of 100 to 60000 ms");
        return BRACE_CLIENT_E_USAGE;
    }
    brace_client_t *opened = calloc(1, sizeof *opened);
    if (opened == NULL) {
        brace_bus_say(why, why_room, "out of memory");
        return BRACE_CLIENT_E_NO_DEVICE;
    }
    strcpy(opened->url, url);
    const uint64_t deadline_us = brace_client_deadline_after(timeout_ms);
    const brace_client_status_t status = brace_modbus_is_url(url) ? brace_modbus_open(opened, deadline_us)
                                                                  : brace_can_open(opened, node, bit_rate, deadline_us);
    if (status != BRACE_CLIENT_OK) {
        brace_bus_say(why, why_room, "%s", opened->why);
        brace_client_close(opened);
        return status;
    }
    *client = opened;
    return BRACE_CLIENT_OK;
}

void brace_client_close(brace_client_t *client)
{
    if (client != NULL) {
        brace_bus_close(client->bus);
        brace_modbus_close(client);
        free(client);
    }
}

void brace_client_identity(const brace_client_t *client, brace_client_identity_t *identity)
{
    *identity = client->identity;
}

const char *brace_client_why(const brace_client_t *client)
{
    return client == NULL ? "no client" : client->why;
}

int32_t brace_client_refusal(const brace_client_t *client)
{
    return client->refusal;
}

int brace_client_exit_code(brace_client_status_t status)
{
    switch (status) {
    case BRACE_CLIENT_OK: return 0;
    case BRACE_CLIENT_E_USAGE:
    case BRACE_CLIENT_E_UNSUPPORTED: return 2;
    case BRACE_CLIENT_E_VERSION: return 6;
    case BRACE_CLIENT_E_REFUSED: return 5;
    default: return 4;
    }
}

brace_client_status_t brace_client_read(brace_client_t *client, uint32_t wanted, int timeout_ms,
                                        brace_client_snapshot_t *snapshot)
{
    if (wanted == 0u || wanted > PARTS_MOST) {
        return brace_client_fail(client, BRACE_CLIENT_E_USAGE,
                                 "parts 0x%x: want BRACE_PART_K or more of BRACE_PART_ALL, _SPACE, _LOAD, "
                                 "_LOAD_ACROSS, _SIGMA, _SIGMA_SPACE",
                                 (unsigned)wanted);
    }
    return client->bus != NULL ? brace_can_read(client, wanted, brace_client_deadline_after(timeout_ms), snapshot)
                               : brace_modbus_read(client, wanted, brace_client_deadline_after(timeout_ms), snapshot);
}
