/* The client over Modbus, through libmodbus. Registers: docs/modbus.md. */
#include "client_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool brace_modbus_is_url(const char *url)
{
    return strncmp(url, "modbus:", 7) == 0 || strncmp(url, "modbus-tcp://", 13) == 0;
}

#ifdef BRACE_WITH_MODBUS

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <modbus.h>
#include <poll.h>
#include <sys/ioctl.h>

#include "brace/can_messages.h"
#include "brace/codes.h"
#include "brace/refusals.h"
#include "brace/status.h"

enum { TRY_MS = 800, ALIVE_TRY_MS = 60 /* the controller waits 130 ms for a sign of life */, BITS_PER_BYTE = 11 };
enum { READ_INPUT = 4, MARKS = 16 /* of 1, 3, ... 31 registers; a value has two */, EXCEPTION = 0x80,
       FRAME_BYTES = 21 /* of request and answer together, without values */ };
enum { REGISTERS_AT_ONCE = 125, APART_MS = 32, ASKED_MOST = 6, BUSY_MS = 20 };
enum { WRITE_BLOCK = 16, REQUEST_HEAD = 6, NOT_OURS = 7 /* exceptions: docs/modbus.md */ };

/* High word first. libmodbus 3.1.6 swaps bytes in its own float setters on this kind of host. */
static uint32_t join(const uint16_t words[2])
{
    return (uint32_t)words[0] << 16 | words[1];
}

static void split(uint32_t value, uint16_t words[2])
{
    words[0] = (uint16_t)(value >> 16);
    words[1] = (uint16_t)value;
}

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

static brace_client_status_t fail(brace_client_t *client, int error)
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
                                 "modbus:DEVICE@19200", client->url, modbus_strerror(error));
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
    if (error > MODBUS_ENOBASE) {
        client->refusal = error - MODBUS_ENOBASE;
        return brace_client_fail(client, BRACE_CLIENT_E_REFUSED, "%s: unit %u refuses: %s (exception %d)", client->url,
                                 (unsigned)client->unit, modbus_strerror(error), error - MODBUS_ENOBASE);
    }
    return brace_client_fail(client, BRACE_CLIENT_E_DOWN, "%s: %s", client->url, modbus_strerror(error));
}

/* Is another try worth it? Nothing came, or something broken, or the unit is busy. */
static bool may_pass(int error)
{
    return error == ETIMEDOUT || error == EAGAIN || error == EMBBADCRC || error == EMBBADDATA || error == EMBXSBUSY;
}

typedef int (*transfer_t)(modbus_t *, int, int, uint16_t *);

static int write_words(modbus_t *modbus, int address, int count, uint16_t *words)
{
    return modbus_write_registers(modbus, address, count, words);
}

/* The answer to the read of so many registers; all other answers have another length. returns 0, libmodbus' error for
 * an exception, or -1: another answer */
static int look_at_mark(const uint8_t *answer, int length, int header, uint32_t registers)
{
    if (length == header + 2 + 2 * (int)registers && answer[header] == READ_INPUT) {
        return 0;
    }
    const bool is_exception = length == header + 2 && answer[header] == (READ_INPUT | EXCEPTION);
    return is_exception ? MODBUS_ENOBASE + answer[header + 1] : -1;
}

/* After an answer that did not come: it may still come, and would be taken for the next one's, and so on. So this asks
 * for something whose answer is like no other, and drops all that comes before it. Marks asked for before may be late,
 * too: each has another length. returns 0, or libmodbus' error */
static int fall_into_step(brace_client_t *client, uint64_t deadline_us)
{
    const uint32_t registers = 1u + 2u * (client->marks % MARKS);
    const uint8_t request[] = {(uint8_t)client->unit, READ_INPUT, 0u, 0u, 0u, (uint8_t)registers};
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

/* One request. returns 0, or libmodbus' error */
static int transfer_once(brace_client_t *client, transfer_t how, uint32_t address, uint32_t count, uint16_t *words,
                         uint64_t deadline_us)
{
    limit_wait(client, count, deadline_us);
    if (how(client->modbus, (int)address, (int)count, words) == (int)count) {
        return 0;
    }
    const int error = errno;
    const bool is_answer = error > MODBUS_ENOBASE && error <= EMBXGTAR; /* an exception */
    client->is_out_of_step |= !is_answer;
    return error;
}

static brace_client_status_t transfer(brace_client_t *client, transfer_t how, uint32_t address, uint32_t count,
                                      uint16_t *words, uint64_t deadline_us)
{
    int error = ETIMEDOUT, broken = 0; /* broken: how an answer was that came so */
    do {
        brace_client_tend(client, deadline_us);
        error = fall_into_step(client, deadline_us);
        error = error == 0 ? transfer_once(client, how, address, count, words, deadline_us) : error;
        if (error == 0) {
            return BRACE_CLIENT_OK;
        }
        broken = error == EMBBADCRC || error == EMBBADDATA ? error : broken;
    } while (may_pass(error) && brace_bus_left_ms(deadline_us) > 0);
    /* The last try may be too short for an answer. What came before tells more than that nothing came then. */
    return fail(client, broken != 0 && (error == ETIMEDOUT || error == EAGAIN) ? broken : error);
}

brace_client_status_t brace_modbus_open(brace_client_t *client, uint64_t deadline_us)
{
    modbus_t *modbus = NULL;
    const brace_client_status_t made = make(client, &modbus);
    client->modbus = modbus;
    if (made != BRACE_CLIENT_OK) {
        return made;
    }
    modbus_set_byte_timeout(modbus, 0u, 0u); /* the time-out is for the whole answer */
    limit_wait(client, REGISTERS_AT_ONCE, deadline_us);
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
    uint16_t words[8];
    const brace_client_status_t status = transfer(client, modbus_read_input_registers, 0u, 8u, words, deadline_us);
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    if (join(words) != 0x4640e600u || join(words + 2) != 0x01020304u) {
        return brace_client_fail(client, BRACE_CLIENT_E_VERSION,
                                 "%s: input registers 0 to 3 read 0x%08x 0x%08x, a Brace controller's read 0x4640e600 "
                                 "0x01020304; is it another device, or a gateway that swaps words?",
                                 client->url, (unsigned)join(words), (unsigned)join(words + 2));
    }
    if (join(words + 4) != BRACE_DICTIONARY_HASH) {
        return brace_client_fail_version(client, client->unit, join(words + 4));
    }
    client->identity = (brace_client_identity_t){
        .node = client->unit, .dictionary_hash = join(words + 4), .firmware_version = join(words + 6)};
    const brace_client_status_t crc = brace_modbus_entry(client, BRACE_CLIENT_ENTRY(parameter_crc), deadline_us,
                                                         &client->identity.parameter_crc);
    return crc != BRACE_CLIENT_OK ? crc
                                  : brace_modbus_entry(client, BRACE_CLIENT_ENTRY(parameter_origin), deadline_us,
                                                       &client->identity.parameter_origin);
}

void brace_modbus_close(brace_client_t *client)
{
    if (client->modbus != NULL) {
        modbus_close(client->modbus);
        modbus_free(client->modbus);
    }
}

static void take_space(const brace_measured_t *m, brace_client_space_t *space)
{
    *space = (brace_client_space_t){
        .k_is_valid = m->k_is_in_space == 1u,
        .k = {.k_xx_n_per_mm = m->space_k_xx_n_per_mm,
              .k_xy_n_per_mm = m->space_k_xy_n_per_mm,
              .k_xz_n_per_mm = m->space_k_xz_n_per_mm,
              .k_yy_n_per_mm = m->space_k_yy_n_per_mm,
              .k_yz_n_per_mm = m->space_k_yz_n_per_mm,
              .k_zz_n_per_mm = m->space_k_zz_n_per_mm,
              .lambda_n_per_mm = {m->space_lambda_1_n_per_mm, m->space_lambda_2_n_per_mm, m->space_lambda_3_n_per_mm},
              .flags = m->space_flags},
        .stiff_axis = {m->space_stiff_axis_x, m->space_stiff_axis_y, m->space_stiff_axis_z},
        .theta0_rad = m->theta0_rad,
        .k_across_n_per_mm = m->k_across_n_per_mm,
        .play_coxa = m->play_coxa,
    };
}

static void take_load(const brace_measured_t *m, brace_client_load_t *load)
{
    *load = (brace_client_load_t){
        .is_counted = isfinite(m->counted_force_x_n) && isfinite(m->counted_force_z_n),
        .force_x_n = m->counted_force_x_n,
        .force_z_n = m->counted_force_z_n,
        .unloaded_k_xx_n_per_mm = m->unloaded_k_xx_n_per_mm,
        .unloaded_k_xz_n_per_mm = m->unloaded_k_xz_n_per_mm,
        .unloaded_k_zz_n_per_mm = m->unloaded_k_zz_n_per_mm,
        .moved_x_mm = m->moved_x_mm,
        .moved_z_mm = m->moved_z_mm,
        .buckling_factor = m->buckling_factor,
        .gravity_direction_rad = m->gravity_direction_rad,
        .gravity_lean_rad = m->gravity_lean_rad,
        .force_y_n = m->counted_force_y_n,
        .moved_y_mm = m->moved_y_mm,
        .unloaded_k_across_n_per_mm = m->unloaded_k_across_n_per_mm,
    };
}

/* unknown: a table of measured values of which none is known. */
static void take(const brace_measured_t *m, uint64_t received_us, const brace_measured_t *unknown,
                 brace_client_snapshot_t *s)
{
    *s = (brace_client_snapshot_t){
        .parts = BRACE_PART_ALL,
        .sequence = m->sequence,
        .received_us = received_us,
        .age_ms = m->age_us == UINT32_MAX ? NAN : (float)m->age_us * 1e-3f,
        .k_is_valid = m->k_is_valid == 1u,
        .flags = m->flags,
        .k_xx_n_per_mm = m->k_xx_n_per_mm,
        .k_xz_n_per_mm = m->k_xz_n_per_mm,
        .k_zz_n_per_mm = m->k_zz_n_per_mm,
        .play_femur = m->play_femur,
        .play_tibia = m->play_tibia,
        .parameter_tag = m->parameter_crc & 0xffffu,
        .lambda_min_n_per_mm = m->lambda_min_n_per_mm,
        .lambda_max_n_per_mm = m->lambda_max_n_per_mm,
        .stiff_axis_rad = m->stiff_axis_rad,
        .theta1_rad = m->theta1_rad,
        .theta2_rad = m->theta2_rad,
        .mode = m->mode,
        .faults = m->faults,
    };
    take_space(unknown, &s->space);
    take_load(unknown, &s->load);
}

/* Reads some measured values at once, so that they are of one snapshot. The others stay unknown: NaN for a float, all
 * ones for a whole number. */
static brace_client_status_t read_measured(brace_client_t *client, uint32_t first, uint32_t count, uint64_t deadline_us,
                                           brace_measured_t *measured)
{
    uint16_t words[REGISTERS_AT_ONCE];
    uint32_t values[BRACE_MEASURED_COUNT];
    const brace_client_status_t status =
        transfer(client, modbus_read_input_registers, 2u * first, 2u * count, words, deadline_us);
    if (status == BRACE_CLIENT_OK) {
        memset(values, 0xff, sizeof values);
        for (uint32_t i = 0u; i < count; i++) {
            values[first + i] = join(words + 2u * i);
        }
        memcpy(measured, values, sizeof *measured);
    }
    return status;
}

#define PLACE_OF(member) ((uint32_t)(offsetof(brace_measured_t, member) / 4u))

static bool has_coxa_joint(const brace_measured_t *measured)
{
    return measured->k_is_in_space == 1u || isfinite(measured->theta0_rad) ||
           (measured->faults & (uint32_t)BRACE_FAULT_SENSOR_COXA) != 0u;
}

/* Reads K in space, after the rest. */
static brace_client_status_t read_space(brace_client_t *client, uint64_t deadline_us, brace_client_snapshot_t *snapshot)
{
    enum { FIRST = PLACE_OF(k_is_in_space), COUNT = PLACE_OF(play_coxa) - PLACE_OF(k_is_in_space) + 1 };
    brace_measured_t measured;
    const brace_client_status_t status = read_measured(client, FIRST, COUNT, deadline_us, &measured);
    if (status == BRACE_CLIENT_OK) {
        take_space(&measured, &snapshot->space);
        snapshot->parts |= BRACE_PART_SPACE;
    }
    return status;
}

brace_client_status_t brace_modbus_load(brace_client_t *client, uint64_t deadline_us, brace_client_load_t *load)
{
    enum { FIRST = PLACE_OF(unloaded_k_xx_n_per_mm), COUNT = PLACE_OF(unloaded_k_across_n_per_mm) - FIRST + 1 };
    brace_measured_t measured;
    const brace_client_status_t status = read_measured(client, FIRST, COUNT, deadline_us, &measured);
    if (status == BRACE_CLIENT_OK) {
        take_load(&measured, load);
    }
    return status;
}

brace_client_status_t brace_modbus_drift(brace_client_t *client, uint64_t deadline_us, brace_client_drift_t *drift)
{
    enum { FIRST = PLACE_OF(drift_state), COUNT = PLACE_OF(drift_next_step) - PLACE_OF(drift_state) + 1 };
    brace_measured_t m;
    const brace_client_status_t status = read_measured(client, FIRST, COUNT, deadline_us, &m);
    if (status == BRACE_CLIENT_OK) {
        *drift = (brace_client_drift_t){.state = m.drift_state,
                                        .cause = m.drift_cause,
                                        .could_be = m.drift_could_be,
                                        .next_step = m.drift_next_step,
                                        .evidence = m.drift_evidence,
                                        .loss_ratio = m.drift_loss_ratio,
                                        .loss_sigma_ratio = m.drift_loss_sigma_ratio,
                                        .since_readings = m.drift_since_readings,
                                        .readings = m.drift_readings};
    }
    return status;
}

/* One read of as many values as it can hold, so that all are of one snapshot. Values that it does not reach stay
 * unknown. */
brace_client_status_t brace_modbus_read(brace_client_t *client, uint32_t wanted, uint64_t deadline_us,
                                        brace_client_snapshot_t *snapshot)
{
    enum { VALUES = REGISTERS_AT_ONCE / 2 };
    _Static_assert((int)VALUES <= (int)BRACE_MEASURED_COUNT, "no more values are asked for than there are");
    brace_measured_t measured, unknown;
    brace_client_snapshot_t taken;
    brace_client_status_t status = read_measured(client, 0u, VALUES, deadline_us, &measured);
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    if (measured.dictionary_hash != BRACE_DICTIONARY_HASH) { /* the controller was flashed since */
        return brace_client_fail_version(client, client->unit, measured.dictionary_hash);
    }
    memset(&unknown, 0xff, sizeof unknown);
    take(&measured, brace_bus_now_us(), &unknown, &taken);
    const bool is_in_space = has_coxa_joint(&measured);
    if (!is_in_space && (wanted & (BRACE_PART_SPACE | BRACE_PART_LOAD_ACROSS)) != 0u) {
        return brace_client_fail(client, BRACE_CLIENT_E_UNSUPPORTED,
                                 "%s: the limb has no coxa joint, so there is no K in space; want BRACE_PART_ALL",
                                 client->url);
    }
    if ((wanted & BRACE_PART_SPACE) != 0u) {
        status = read_space(client, deadline_us, &taken);
    }
    if (status == BRACE_CLIENT_OK && (wanted & (BRACE_PART_LOAD | BRACE_PART_LOAD_ACROSS)) != 0u) {
        status = brace_modbus_load(client, deadline_us, &taken.load);
        taken.parts |= BRACE_PART_LOAD | (is_in_space ? BRACE_PART_LOAD_ACROSS : 0u);
    }
    if (status == BRACE_CLIENT_OK) {
        *snapshot = taken;
    }
    return status;
}

brace_client_status_t brace_modbus_entry(brace_client_t *client, uint32_t index, uint64_t deadline_us, uint32_t *value)
{
    uint16_t words[2];
    const bool is_answer = index >= BRACE_ENTRY_ANSWERED, is_measured = index >= BRACE_ENTRY_MEASURED;
    const uint32_t address = is_answer     ? 0x1000u + 2u * (index - BRACE_ENTRY_ANSWERED)
                             : is_measured ? 2u * (index - BRACE_ENTRY_MEASURED)
                                           : 2u * index;
    const brace_client_status_t status = transfer(
        client, is_measured ? modbus_read_input_registers : modbus_read_registers, address, 2u, words, deadline_us);
    if (status == BRACE_CLIENT_OK) {
        *value = join(words);
    }
    return status;
}

/* -------------------------------------------------------------------------------------------- commands -- */

/* Counter and check in one request. */
static int show(brace_client_t *client, uint32_t place, brace_sign_t sign, uint64_t deadline_us)
{
    uint16_t words[4];
    split(sign.counter, words);
    split(sign.check, words + 2);
    return transfer_once(client, write_words, BRACE_REGISTER_COMMANDS + 2u * place, 4u, words, deadline_us);
}

/* A refused sign of life shows in the controller's is_held and silences, a lost connection in the next request. It is
 * sent out of step, too: what matters is that it comes. */
void brace_modbus_show_life(brace_client_t *client, brace_sign_t sign, uint64_t deadline_us)
{
    (void)show(client, BRACE_CLIENT_COMMAND_PLACE(life_counter), sign, deadline_us);
}

/* The check is over the request from its function on. */
static brace_sign_t seal_of(brace_client_t *client, uint32_t address, const uint16_t *words, uint32_t words_count)
{
    uint8_t request[REQUEST_HEAD + 4 * ASKED_MOST] = {
        WRITE_BLOCK, (uint8_t)(address >> 8), (uint8_t)address, 0u, (uint8_t)words_count, (uint8_t)(2u * words_count)};
    for (uint32_t i = 0u; i < words_count; i++) {
        request[REQUEST_HEAD + 2u * i] = (uint8_t)(words[i] >> 8);
        request[REQUEST_HEAD + 2u * i + 1u] = (uint8_t)words[i];
    }
    (void)brace_owner_next_counter(&client->owner);
    return brace_owner_seal(&client->owner, request, REQUEST_HEAD + 2u * words_count);
}

/* An exception has less to say than a refusal over CAN; of who may command the controller tells the status. */
static brace_client_status_t fail_command(brace_client_t *client, uint32_t code, int error, uint64_t deadline_us)
{
    const int exception = error - MODBUS_ENOBASE;
    uint32_t told;
    int32_t status = exception == 1   ? BRACE_E_MODE
                     : exception == 3 ? BRACE_E_RANGE
                     : exception == 6 ? BRACE_REFUSED_BUSY
                                      : BRACE_E_UNSUPPORTED;
    if (exception < 1 || exception > NOT_OURS) {
        return fail(client, error);
    }
    client->refusal = exception;
    if (exception == NOT_OURS) {
        const brace_client_status_t asked =
            brace_modbus_entry(client, BRACE_CLIENT_ENTRY(last_refusal), deadline_us, &told);
        if (asked != BRACE_CLIENT_OK) {
            return asked;
        }
        client->refusal = status = (int32_t)told - 256;
    }
    return brace_client_fail(client, BRACE_CLIENT_E_REFUSED, "%s: unit %u refuses: %s (exception %d)", client->url,
                             (unsigned)client->unit, brace_client_reason(code, status, 0u), exception);
}

brace_client_status_t brace_modbus_command(brace_client_t *client, uint32_t code, uint32_t place,
                                           const uint32_t *values, uint32_t count, bool is_sealed, bool is_once,
                                           uint64_t deadline_us)
{
    const uint32_t address = BRACE_REGISTER_COMMANDS + 2u * place;
    uint16_t words[2 * ASKED_MOST];
    int error;
    for (uint32_t i = 0u; i < count; i++) {
        split(values[i], words + 2u * i);
    }
    for (;;) {
        brace_client_tend(client, deadline_us);
        error = fall_into_step(client, deadline_us);
        if (error != 0 && may_pass(error) && brace_bus_left_ms(deadline_us) > 0) {
            continue;
        }
        if (error == 0 && is_sealed && client->owner.is_open) {
            error = show(client, BRACE_CLIENT_COMMAND_PLACE(seal_counter),
                         seal_of(client, address, words, 2u * count), deadline_us);
        }
        if (error == 0) {
            error = transfer_once(client, write_words, address, 2u * count, words, deadline_us);
        }
        if (error == 0) {
            return BRACE_CLIENT_OK;
        }
        if ((error != EMBXSBUSY && (is_once || !may_pass(error))) || brace_bus_left_ms(deadline_us) <= BUSY_MS) {
            return fail_command(client, code, error, deadline_us);
        }
        poll(NULL, 0, BUSY_MS);
    }
}

/* ------------------------------------------------------------------------------------------- questions -- */

/* One try. *is_mine: no other client has asked another question in between. */
static brace_client_status_t try_question(brace_client_t *client, uint32_t address, uint32_t count,
                                          uint16_t words[2 * ASKED_MOST], uint64_t deadline_us,
                                          uint16_t answers[2 * BRACE_ANSWERED_COUNT], bool *is_mine)
{
    uint16_t readback[2 * ASKED_MOST];
    brace_client_status_t status = transfer(client, write_words, address, 2u * count, words, deadline_us);
    if (status == BRACE_CLIENT_OK) {
        status =
            transfer(client, modbus_read_input_registers, 0x1000u, 2u * BRACE_ANSWERED_COUNT, answers, deadline_us);
    }
    if (status == BRACE_CLIENT_OK) {
        status = transfer(client, modbus_read_registers, address, 2u * count, readback, deadline_us);
    }
    *is_mine = status == BRACE_CLIENT_OK && memcmp(words, readback, 4u * count) == 0;
    return status;
}

brace_client_status_t brace_modbus_ask(brace_client_t *client, uint32_t first, const uint32_t *values, uint32_t count,
                                       uint64_t deadline_us, brace_answered_t *answered)
{
    const uint32_t address = BRACE_REGISTER_COMMANDS + 2u * first;
    uint16_t words[2 * ASKED_MOST], answers[2 * BRACE_ANSWERED_COUNT];
    uint32_t told[BRACE_ANSWERED_COUNT];
    bool is_mine, is_contested = false;
    for (uint32_t i = 0u; i < count; i++) {
        split(values[i], words + 2u * i);
    }
    for (;; is_contested = true) {
        const brace_client_status_t status =
            try_question(client, address, count, words, deadline_us, answers, &is_mine);
        if (is_contested && !is_mine && (status == BRACE_CLIENT_E_SILENT || brace_bus_left_ms(deadline_us) == 0)) {
            return brace_client_fail(client, BRACE_CLIENT_E_TIMEOUT,
                                     "%s: other clients asked other questions all the time; try a longer time-out, "
                                     "or CAN, where each has its own answer", client->url);
        }
        if (status != BRACE_CLIENT_OK) {
            return status;
        }
        if (is_mine) {
            break;
        }
        const int pause_ms = (int)(brace_bus_now_us() % APART_MS), left_ms = brace_bus_left_ms(deadline_us);
        poll(NULL, 0, pause_ms < left_ms ? pause_ms : left_ms); /* the other client asks again too, at other times */
    }
    for (uint32_t i = 0u; i < BRACE_ANSWERED_COUNT; i++) {
        told[i] = join(answers + 2u * i);
    }
    memcpy(answered, told, sizeof *answered);
    return BRACE_CLIENT_OK;
}

#else

static brace_client_status_t absent(brace_client_t *client)
{
    return brace_client_fail(
        client, BRACE_CLIENT_E_UNSUPPORTED,
        "%s: this client was built without libmodbus; install it (Debian: libmodbus-dev) and build "
        "again",
        client->url);
}

brace_client_status_t brace_modbus_open(brace_client_t *client, uint64_t deadline_us)
{
    (void)deadline_us;
    return absent(client);
}

void brace_modbus_close(brace_client_t *client)
{
    (void)client;
}

brace_client_status_t brace_modbus_read(brace_client_t *client, uint32_t wanted, uint64_t deadline_us,
                                        brace_client_snapshot_t *snapshot)
{
    (void)wanted;
    (void)deadline_us;
    (void)snapshot;
    return absent(client);
}

brace_client_status_t brace_modbus_drift(brace_client_t *client, uint64_t deadline_us, brace_client_drift_t *drift)
{
    (void)deadline_us;
    (void)drift;
    return absent(client);
}

brace_client_status_t brace_modbus_entry(brace_client_t *client, uint32_t index, uint64_t deadline_us, uint32_t *value)
{
    (void)index;
    (void)deadline_us;
    (void)value;
    return absent(client);
}

brace_client_status_t brace_modbus_load(brace_client_t *client, uint64_t deadline_us, brace_client_load_t *load)
{
    (void)deadline_us;
    (void)load;
    return absent(client);
}

brace_client_status_t brace_modbus_ask(brace_client_t *client, uint32_t first, const uint32_t *values, uint32_t count,
                                       uint64_t deadline_us, brace_answered_t *answered)
{
    (void)first;
    (void)values;
    (void)count;
    (void)deadline_us;
    (void)answered;
    return absent(client);
}

brace_client_status_t brace_modbus_command(brace_client_t *client, uint32_t code, uint32_t place,
                                           const uint32_t *values, uint32_t count, bool is_sealed, bool is_once,
                                           uint64_t deadline_us)
{
    (void)code;
    (void)place;
    (void)values;
    (void)count;
    (void)is_sealed;
    (void)is_once;
    (void)deadline_us;
    return absent(client);
}

void brace_modbus_show_life(brace_client_t *client, brace_sign_t sign, uint64_t deadline_us)
{
    (void)client;
    (void)sign;
    (void)deadline_us;
}

#endif
