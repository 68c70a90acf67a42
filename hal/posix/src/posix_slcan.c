/* One SLCAN client: answers its commands as an adapter does; CR is yes, BEL is no. */
#include <string.h>

#include "posix_io.h"
#include "posix_nodes.h"
#include "posix_slcan.h"
#include "posix_socketcan.h"
#include "slcan_text.h"

enum { READS_PER_POLL = 64, READ_BYTES = 1024, STAMP_PERIOD_MS = 60000 };

void posix_slcan_start(brace_posix_slcan_t *client, int file)
{
    memset(client, 0, offsetof(brace_posix_slcan_t, out));
    client->out.start = client->out.count = 0u;
    client->file = file;
}

static void answer(brace_posix_slcan_t *client, const char *text)
{
    (void)queue_put(&client->out, (const uint8_t *)text, (uint32_t)strlen(text));
}

/* A client at another rate than the bus receives nothing and reaches nobody, as on a wire. */
static bool hears(const brace_posix_bus_t *bus, const brace_posix_slcan_t *client)
{
    const uint32_t rate = bus_bit_rate(bus);
    return client->bit_rate == 0u || rate == 0u || client->bit_rate == rate;
}

/* What another sends on the bus reaches an open channel as a line. */
static void receive_frame(const brace_posix_bus_t *bus, brace_posix_slcan_t *client,
                          const brace_posix_wire_frame_t *frame)
{
    if (client->file < 0 || !client->open || !hears(bus, client)) {
        return;
    }
    char line[SLCAN_LINE_BYTES];
    const int32_t stamp = client->stamps ? (int32_t)(bus->milliseconds % STAMP_PERIOD_MS) : -1;
    if (!queue_put(&client->out, (const uint8_t *)line, posix_slcan_write(frame, stamp, line))) {
        client->frames_lost += client->frames_lost != UINT32_MAX;
    }
}

void bus_to_outside(brace_posix_bus_t *bus, const brace_posix_slcan_t *sender, const brace_posix_wire_frame_t *frame)
{
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        if (&bus->client[i] != sender) {
            receive_frame(bus, &bus->client[i], frame);
        }
    }
    if (bus->socket_can >= 0) {
        socketcan_send(bus, frame);
    }
}

/* A frame goes by an open channel only, but a stop always does, as on a controller's own SLCAN port. */
static bool send_frame(brace_posix_bus_t *bus, brace_posix_slcan_t *client, const char *command, uint32_t length)
{
    brace_posix_wire_frame_t frame;
    const bool sends = client->open && !client->listen_only;
    if (!posix_slcan_read(command, length, &frame) || !(sends || bus_is_urgent(bus, &frame))) {
        return false;
    }
    if (hears(bus, client)) {
        bus_to_nodes(bus, -1, &frame, client->bit_rate);
        bus_to_outside(bus, client, &frame);
    }
    answer(client, frame.extended ? "Z\r" : "z\r");
    return true;
}

static bool open_channel(brace_posix_slcan_t *client, bool listen_only, uint32_t length)
{
    if (client->open || length != 1u) {
        return false;
    }
    client->open = true;
    client->listen_only = listen_only;
    answer(client, "\r");
    return true;
}

static bool set_rate(brace_posix_slcan_t *client, const char *command, uint32_t length)
{
    const bool by_number = command[0] == 'S' && length == 2u && posix_slcan_bit_rate(command[1]) != 0u;
    const bool by_registers = command[0] == 's' && length >= 5u; /* registers of some controller: accept any rate */
    if (client->open || (!by_number && !by_registers)) {
        return false;
    }
    client->bit_rate = by_number ? posix_slcan_bit_rate(command[1]) : 0u;
    answer(client, "\r");
    return true;
}

/* Handles one command. false: refused. */
static bool obey(brace_posix_bus_t *bus, brace_posix_slcan_t *client, const char *command, uint32_t length)
{
    switch (command[0]) {
    case 't':
    case 'T':
    case 'r':
    case 'R':
    case 'd':
    case 'b': return send_frame(bus, client, command, length);
    case 'O': return open_channel(client, false, length);
    case 'L': return open_channel(client, true, length);
    case 'C':
        client->open &= length != 1u;
        answer(client, "\r");
        return length == 1u;
    case 'S':
    case 's': return set_rate(client, command, length);
    case 'Y': /* FD data rate: accepted, the bus has its own */
    case 'X': /* automatic polling: always on */ answer(client, "\r"); return length == 2u;
    case 'V': answer(client, "V1013\r"); return length == 1u;
    case 'v': answer(client, "v0100\r"); return length == 1u;
    case 'N': answer(client, "NBRC1\r"); return length == 1u;
    case 'F': /* bit 7: bus error */
        if (!client->open) {
            return false;
        }
        answer(client, hears(bus, client) ? "F00\r" : "F80\r");
        return length == 1u;
    case 'Z':
        if (client->open || length != 2u || (command[1] != '0' && command[1] != '1')) {
            return false;
        }
        client->stamps = command[1] == '1';
        answer(client, "\r");
        return true;
    default: return false;
    }
}

static void take_byte(brace_posix_bus_t *bus, brace_posix_slcan_t *client, char byte)
{
    if (byte == '\n') {
        return;
    }
    if (byte != '\r') {
        client->command_too_long |= client->command_count == sizeof client->command;
        if (!client->command_too_long) {
            client->command[client->command_count++] = byte;
        }
        return;
    }
    const uint32_t waiting = client->out.count;
    const bool empty = client->command_count == 0u && !client->command_too_long;
    if (empty) {
        answer(client, "\r"); /* clients clear an adapter's line with a few CRs */
    } else if (client->command_too_long || !obey(bus, client, client->command, client->command_count)) {
        client->out.count = waiting; /* drops the answer, keeps only the refusal */
        client->refused += client->refused != UINT32_MAX;
        answer(client, "\a");
    }
    client->command_count = 0u;
    client->command_too_long = false;
}

void posix_slcan_poll(brace_posix_bus_t *bus, brace_posix_slcan_t *client)
{
    uint8_t bytes[READ_BYTES];
    int32_t count = 0;
    for (int i = 0; i < READS_PER_POLL; i++) {
        count = io_read(client->file, bytes, sizeof bytes);
        for (int32_t k = 0; k < count; k++) { /* at most the bytes read */
            take_byte(bus, client, (char)bytes[k]);
        }
        if (count < (int32_t)sizeof bytes) {
            break;
        }
    }
    const bool gone = count < 0 || !queue_flush(&client->out, client->file);
    if (gone && bus->kind == BRACE_POSIX_BUS_TCP) {
        io_close(&client->file);
        client->open = false;
    }
}
