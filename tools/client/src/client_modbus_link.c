/* Modbus through libmodbus: the connection, its URL, its errors, and answers that come late. */
#include "client_modbus_link.h"

#ifdef BRACE_WITH_MODBUS

#include <errno.h>
#include <limits.h>
#include <modbus.h>
#include <stdlib.h>
#include <string.h>

enum { TRY_MS = 800, ALIVE_TRY_MS = 60 /* the controller waits 130 ms for a sign of life */, BITS_PER_BYTE = 11 };
enum {
    MARKS = 16 /* of 1, 3, ... 31 registers; a value has two */,
    EXCEPTION = 0x80,
    FRAME_BYTES = 21 /* of request and answer together, without values */
};

/* Cuts off and returns a number behind the last '/'; returns fallback when there is none. */
static long cut_unit(char *text, long fallback)
{
    char *slash = strrchr(text, '/');
    if (slash == NULL || slash == text || slash[1] == '\0' || strspn(slash + 1, "0123456789") != strlen(slash + 1)) {
        return fallback;
    }
    *slash = '\0';
    if (strcmp(text, "/dev/pts") == 0) { /* a device, not a unit */
        *slash = '/';
        return fallback;
    }
    return strtol(slash + 1, NULL, 10);
}

static brace_client_status_t no_url(brace_client_t *client)
{
    return brace_client_fail(client, BRACE_CLIENT_E_USAGE,
                             "%s: expected modbus:/dev/ttyUSB0@115200/1 or modbus-tcp://host:port/1, units 1 to 247",
                             client->url);
}

/* Even parity, as Modbus RTU and the controller have it. A pseudo-terminal has no parity and refuses any. */
static char parity_of(const char *device)
{
    char path[PATH_MAX];
    return realpath(device, path) != NULL && strncmp(path, "/dev/pts/", 9) == 0 ? 'N' : 'E';
}

static brace_client_status_t make(brace_client_t *client, modbus_t **made)
{
    char text[sizeof client->url];
    const bool is_tcp = strncmp(client->url, "modbus-tcp://", 13) == 0;
    strcpy(text, client->url + (is_tcp ? 13 : 7));
    char *at = is_tcp ? NULL : strrchr(text, '@');
    const long unit = cut_unit(text, 1);
    long baud = 115200;
    if (at != NULL) {
        char *end;
        *at = '\0';
        baud = strtol(at + 1, &end, 10);
        if (*end != '\0' || end == at + 1) {
            return no_url(client);
        }
    }
    if (text[0] == '\0' || unit < 1 || unit > 247 || baud < 1200 || baud > 4000000) {
        return no_url(client);
    }
    client->unit = (uint32_t)unit;
    client->baud = is_tcp ? 0u : (uint32_t)baud;
    if (!is_tcp) {
        *made = modbus_new_rtu(text, (int)baud, parity_of(text), 8, 1);
    } else {
        char *port = strrchr(text, ':');
        char *host = text;
        if (port != NULL && strchr(port, ']') == NULL) {
            *port++ = '\0';
        } else {
            port = NULL;
        }
        if (host[0] == '[' && host[strlen(host) - 1u] == ']') {
            host[strlen(host) - 1u] = '\0';
            host++;
        }
        *made = modbus_new_tcp_pi(host, port == NULL ? "502" : port);
    }
    if (*made == NULL || modbus_set_slave(*made, (int)unit) != 0) {
        return no_url(client);
    }
    return BRACE_CLIENT_OK;
}

/* How long one request of so many registers may take until its answer is whole. */
static void limit_wait(brace_client_t *client, uint32_t count, uint64_t deadline_us)
{
    const int left_ms = brace_bus_left_ms(deadline_us);
    const uint32_t line_ms =
        client->baud == 0u ? 0u : (FRAME_BYTES + 2u * count) * BITS_PER_BYTE * 1000u / client->baud + 1u;
    const int try_ms = (client->lives ? ALIVE_TRY_MS : TRY_MS) + (int)line_ms;
    const int wait_ms = left_ms < 1 ? 1 : left_ms < try_ms ? left_ms : try_ms;
    modbus_set_response_timeout(client->modbus, (uint32_t)(wait_ms / 1000), (uint32_t)(wait_ms % 1000) * 1000u);
}

int brace_modbus_exception(int error)
{
    return error > MODBUS_ENOBASE && error <= EMBXGTAR ? error - MODBUS_ENOBASE : 0;
}

brace_client_status_t brace_modbus_fail(brace_client_t *client, int error)
{
    switch (error) {
    case ETIMEDOUT:
    case EAGAIN:
    case EINPROGRESS:
        return brace_client_fail(client, BRACE_CLIENT_E_SILENT,
                                 "%s: unit %u does not answer; is it powered and wired, its address "
                                 "(controller.modbus_address) %u, its baud rate (controller.modbus_baud) this one?",
                                 client->url, (unsigned)client->unit, (unsigned)client->unit);
    case EMBBADCRC:
    case EMBBADDATA:
    case EMBMDATA:
    case EMBBADEXC:
        return brace_client_fail(client, BRACE_CLIENT_E_BIT_RATE,
                                 "%s: what comes is broken (%s): not its baud rate, or two units of one address; try "
                                 "modbus:DEVICE@19200",
                                 client->url, modbus_strerror(error));
    case EMBBADSLAVE:
    case EMBXGPATH:
    case EMBXGTAR:
        return brace_client_fail(client, BRACE_CLIENT_E_NODE, "%s: there is no unit %u behind this port (%s)",
                                 client->url, (unsigned)client->unit, modbus_strerror(error));
    case ECONNRESET:
    case EPIPE:
    case EBADF:
    case EIO:
        return brace_client_fail(client, BRACE_CLIENT_E_DOWN, "%s: the connection has gone (%s); connect again",
                                 client->url, modbus_strerror(error));
    default: break;
    }
    if (brace_modbus_exception(error) != 0) {
        client->refusal = brace_modbus_exception(error);
        return brace_client_fail(client, BRACE_CLIENT_E_REFUSED, "%s: unit %u refuses: %s (exception %d)", client->url,
                                 (unsigned)client->unit, modbus_strerror(error), client->refusal);
    }
    return brace_client_fail(client, BRACE_CLIENT_E_DOWN, "%s: %s", client->url, modbus_strerror(error));
}

bool brace_modbus_is_broken(int error)
{
    return error == EMBBADCRC || error == EMBBADDATA;
}

bool brace_modbus_is_silent(int error)
{
    return error == ETIMEDOUT || error == EAGAIN;
}

bool brace_modbus_may_pass(int error)
{
    return brace_modbus_is_silent(error) || brace_modbus_is_broken(error) || error == EMBXSBUSY;
}

/* The answer to the read of so many registers; all other answers have another length. returns 0, libmodbus' error for
 * an exception, or -1: another answer */
static int look_at_mark(const uint8_t *answer, int length, int header, uint32_t registers)
{
    if (length == header + 2 + 2 * (int)registers && answer[header] == BRACE_MODBUS_READ_INPUT) {
        return 0;
    }
    const bool is_exception = length == header + 2 && answer[header] == (BRACE_MODBUS_READ_INPUT | EXCEPTION);
    return is_exception ? MODBUS_ENOBASE + answer[header + 1] : -1;
}

/* After an answer that did not come: it may still come, and would be taken for the next one's, and so on. So this asks
 * for something whose answer is like no other, and drops all that comes before it. Marks asked for before may be late,
 * too: each has another length. returns 0, or libmodbus' error */
int brace_modbus_fall_into_step(brace_client_t *client, uint64_t deadline_us)
{
    const uint32_t registers = 1u + 2u * (client->marks % MARKS);
    const uint8_t request[] = {(uint8_t)client->unit, BRACE_MODBUS_READ_INPUT, 0u, 0u, 0u, (uint8_t)registers};
    const int header = modbus_get_header_length(client->modbus), bytes = header > 1 ? 0 : 2; /* RTU: the check */
    uint8_t answer[MODBUS_TCP_MAX_ADU_LENGTH];
    int found = -1;
    if (!client->is_out_of_step) {
        return 0;
    }
    (void)modbus_flush(client->modbus);
    client->marks++;
    limit_wait(client, registers, deadline_us);
    if (modbus_send_raw_request(client->modbus, request, (int)sizeof request) < 0) {
        return errno;
    }
    while (found < 0) {
        const int length = brace_bus_left_ms(deadline_us) > 0 ? modbus_receive_confirmation(client->modbus, answer) : 0;
        if (length <= 0) {
            return length < 0 ? errno : ETIMEDOUT;
        }
        found = look_at_mark(answer, length - bytes, header, registers);
    }
    client->is_out_of_step = found != 0;
    return found;
}

int brace_modbus_try(brace_client_t *client, brace_modbus_function_t function, uint32_t address, uint32_t count,
                     uint16_t *words, uint64_t deadline_us)
{
    modbus_t *modbus = client->modbus;
    int done = -1;
    limit_wait(client, count, deadline_us);
    switch (function) {
    case BRACE_MODBUS_READ_HOLDING: done = modbus_read_registers(modbus, (int)address, (int)count, words); break;
    case BRACE_MODBUS_READ_INPUT: done = modbus_read_input_registers(modbus, (int)address, (int)count, words); break;
    case BRACE_MODBUS_WRITE: done = modbus_write_registers(modbus, (int)address, (int)count, words); break;
    }
    if (done == (int)count) {
        return 0;
    }
    const int error = errno;
    client->is_out_of_step |= brace_modbus_exception(error) == 0;
    return error;
}

brace_client_status_t brace_modbus_connect(brace_client_t *client, uint64_t deadline_us)
{
    modbus_t *modbus = NULL;
    const brace_client_status_t made = make(client, &modbus);
    client->modbus = modbus;
    if (made != BRACE_CLIENT_OK) {
        return made;
    }
    modbus_set_byte_timeout(modbus, 0u, 0u); /* the time-out is for the whole answer */
    limit_wait(client, BRACE_MODBUS_REGISTERS_MOST, deadline_us);
    errno = 0;
    if (modbus_connect(modbus) != 0) {
        const int error = errno == EINPROGRESS || errno == 0 ? ETIMEDOUT : errno;
        modbus_free(modbus);
        client->modbus = NULL;
        return brace_client_fail(client, BRACE_CLIENT_E_NO_DEVICE, "%s: %s; %s", client->url, modbus_strerror(error),
                                 strncmp(client->url, "modbus:", 7) == 0
                                     ? "is the adapter plugged in and free? 'ls /dev/tty*' lists the devices there are"
                                     : "does anything listen there? ('brace sim' prints its port)");
    }
    return BRACE_CLIENT_OK;
}

void brace_modbus_close(brace_client_t *client)
{
    if (client->modbus != NULL) {
        modbus_close(client->modbus);
        modbus_free(client->modbus);
    }
}

#else

brace_client_status_t brace_modbus_connect(brace_client_t *client, uint64_t deadline_us)
{
    (void)deadline_us;
    return brace_modbus_fail(client, 0);
}

void brace_modbus_close(brace_client_t *client)
{
    (void)client;
}

int brace_modbus_try(brace_client_t *client, brace_modbus_function_t function, uint32_t address, uint32_t count,
                     uint16_t *words, uint64_t deadline_us)
{
    (void)client;
    (void)function;
    (void)address;
    (void)count;
    (void)words;
    (void)deadline_us;
    return -1;
}

int brace_modbus_fall_into_step(brace_client_t *client, uint64_t deadline_us)
{
    (void)client;
    (void)deadline_us;
    return -1;
}

bool brace_modbus_is_broken(int error)
{
    (void)error;
    return false;
}

bool brace_modbus_is_silent(int error)
{
    (void)error;
    return false;
}

bool brace_modbus_may_pass(int error)
{
    (void)error;
    return false;
}

int brace_modbus_exception(int error)
{
    (void)error;
    return 0;
}

brace_client_status_t brace_modbus_fail(brace_client_t *client, int error)
{
    (void)error;
    return brace_client_fail(
        client, BRACE_CLIENT_E_UNSUPPORTED,
        "%s: this client was built without libmodbus; install it (Debian: libmodbus-dev) and build again", client->url);
}

#endif
