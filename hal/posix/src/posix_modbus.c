/* Modbus TCP: MBAP header (transaction 2, protocol 2, length 2, unit 1), length counting from the unit on;
 * big-endian. Modbus Messaging on TCP/IP Implementation Guide 1.0b, 3.1.3. */
#include <string.h>

#include "posix_door.h"
#include "posix_io.h"

enum { HEADER_BYTES = 6, LEAST_LENGTH = 2, LONGEST_LENGTH = 254 };

int32_t brace_posix_modbus_open(brace_posix_modbus_t *modbus, const char *url)
{
    static const char scheme[] = "modbus-tcp://";
    memset(modbus, 0, sizeof *modbus);
    modbus->listener = -1;
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        modbus->client[i].file = -1;
    }
    if (strcmp(url, "none") == 0) {
        return BRACE_POSIX_OK;
    }
    if (strncmp(url, scheme, sizeof scheme - 1u) != 0) {
        return BRACE_POSIX_E_URL;
    }
    return io_listen("modbus-tcp", url + sizeof scheme - 1u, &modbus->listener, modbus->where);
}

void brace_posix_modbus_close(brace_posix_modbus_t *modbus)
{
    io_close(&modbus->listener);
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        io_close(&modbus->client[i].file);
    }
}

/* A free place; if there is none, that of the connection that has sent nothing for longest, as the guide asks. */
static brace_posix_modbus_client_t *place_for_client(brace_posix_modbus_t *modbus)
{
    brace_posix_modbus_client_t *oldest = &modbus->client[0];
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        brace_posix_modbus_client_t *client = &modbus->client[i];
        if (client->file < 0) {
            return client;
        }
        if (modbus->polls - client->last_poll > modbus->polls - oldest->last_poll) {
            oldest = client;
        }
    }
    io_close(&oldest->file);
    return oldest;
}

/* Size of the first ADU if all of it has come; 0: not yet; -1: the bytes are no Modbus. */
static int32_t whole_adu(const brace_posix_modbus_client_t *client)
{
    if (client->count < HEADER_BYTES) {
        return 0;
    }
    const uint8_t *adu = client->in + client->start;
    const uint32_t protocol = (uint32_t)adu[2] << 8 | adu[3];
    const uint32_t length = (uint32_t)adu[4] << 8 | adu[5];
    if (protocol != 0u || length < LEAST_LENGTH || length > LONGEST_LENGTH) {
        return -1;
    }
    return client->count >= HEADER_BYTES + length ? (int32_t)(HEADER_BYTES + length) : 0;
}

static void poll_client(brace_posix_modbus_t *modbus, brace_posix_modbus_client_t *client)
{
    memmove(client->in, client->in + client->start, client->count);
    client->start = 0u;
    const int32_t count =
        io_read(client->file, client->in + client->count, (uint32_t)sizeof client->in - client->count);
    if (count > 0) {
        client->count += (uint32_t)count;
        client->last_poll = modbus->polls;
    }
    const bool is_modbus = whole_adu(client) >= 0;
    if (!is_modbus) {
        modbus->refused++;
    }
    if (count < 0 || !is_modbus || !queue_flush(&client->out, client->file)) {
        io_close(&client->file);
    }
}

void posix_modbus_poll(brace_posix_modbus_t *modbus)
{
    modbus->polls++;
    const int file = io_accept(modbus->listener);
    if (file >= 0) {
        brace_posix_modbus_client_t *client = place_for_client(modbus);
        client->file = file;
        client->serial = ++modbus->serials;
        client->last_poll = modbus->polls;
        client->start = client->count = client->out.count = client->out.start = 0u;
    }
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        if (modbus->client[i].file >= 0) {
            poll_client(modbus, &modbus->client[i]);
        }
    }
}

/* The next whole ADU; the connections take turns. */
static bool take_adu(brace_posix_modbus_t *modbus)
{
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        const uint32_t index = (modbus->next + i) % BRACE_POSIX_CLIENTS;
        brace_posix_modbus_client_t *client = &modbus->client[index];
        const int32_t bytes = client->file >= 0 ? whole_adu(client) : 0;
        if (bytes > 0) {
            memcpy(modbus->adu, client->in + client->start, (size_t)bytes);
            client->count -= (uint32_t)bytes;
            client->start += (uint32_t)bytes;
            modbus->given = 0u;
            modbus->whole = (uint32_t)bytes;
            modbus->current_serial = client->serial;
            modbus->next = (index + 1u) % BRACE_POSIX_CLIENTS;
            return true;
        }
    }
    return false;
}

int32_t posix_modbus_read(brace_posix_modbus_t *modbus, uint8_t *bytes, uint32_t room)
{
    if (modbus->listener < 0) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (room == 0u || (modbus->given == modbus->whole && !take_adu(modbus))) {
        return 0;
    }
    const uint32_t left = modbus->whole - modbus->given;
    const uint32_t count = left < room ? left : room;
    memcpy(bytes, modbus->adu + modbus->given, count);
    modbus->given += count;
    return (int32_t)count;
}

int32_t posix_modbus_write_to(brace_posix_modbus_t *modbus, uint32_t serial, const uint8_t *bytes, uint32_t count)
{
    if (modbus->listener < 0) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        brace_posix_modbus_client_t *client = &modbus->client[i];
        if (client->file >= 0 && client->serial == serial) {
            return queue_put(&client->out, bytes, count) ? (int32_t)count : 0;
        }
    }
    return (int32_t)count; /* the connection that asked has closed */
}
