/* The client over Modbus: what it reads, writes and asks. Registers: docs/modbus.md. */
#include <math.h>
#include <poll.h>
#include <stddef.h>
#include <string.h>

#include "client_modbus.h"
#include "client_modbus_link.h"
#include "refusal.h"

#include "brace/can_messages.h"
#include "brace/codes.h"
#include "brace/refusals.h"
#include "brace/status.h"

enum { APART_MS = 32, ASKED_MOST = 6, BUSY_MS = 20 };
enum { REQUEST_HEAD = 6, BUSY = 6, NOT_OURS = 7 /* exceptions: docs/modbus.md */ };

bool brace_modbus_is_url(const char *url)
{
    return strncmp(url, "modbus:", 7) == 0 || strncmp(url, "modbus-tcp://", 13) == 0;
}

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

/* Reads or writes so many registers from an address on. Tries again until an answer comes that is whole, and gives the
 * signs of life that are due. */
static brace_client_status_t transfer(brace_client_t *client, brace_modbus_function_t function, uint32_t address,
                                      uint32_t count, uint16_t *words, uint64_t deadline_us)
{
    int error, broken = 0; /* broken: how an answer was that came so */
    do {
        brace_modbus_tend(client, deadline_us);
        error = brace_modbus_fall_into_step(client, deadline_us);
        error = error == 0 ? brace_modbus_try(client, function, address, count, words, deadline_us) : error;
        if (error == 0) {
            return BRACE_CLIENT_OK;
        }
        broken = brace_modbus_is_broken(error) ? error : broken;
    } while (brace_modbus_may_pass(error) && brace_bus_left_ms(deadline_us) > 0);
    /* The last try may be too short for an answer. That one came broken says more than that nothing came then. */
    return brace_modbus_fail(client, broken != 0 && brace_modbus_is_silent(error) ? broken : error);
}

brace_client_status_t brace_modbus_open(brace_client_t *client, uint64_t deadline_us)
{
    uint16_t words[8];
    brace_client_status_t status = brace_modbus_connect(client, deadline_us);
    if (status == BRACE_CLIENT_OK) {
        status = transfer(client, BRACE_MODBUS_READ_INPUT, 0u, 8u, words, deadline_us);
    }
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
    const brace_client_status_t crc =
        brace_modbus_entry(client, BRACE_CLIENT_ENTRY(parameter_crc), deadline_us, &client->identity.parameter_crc);
    return crc != BRACE_CLIENT_OK ? crc
                                  : brace_modbus_entry(client, BRACE_CLIENT_ENTRY(parameter_origin), deadline_us,
                                                       &client->identity.parameter_origin);
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

static void take_sigma(const brace_measured_t *m, brace_client_snapshot_t *s)
{
    s->sigma = (brace_client_sigma_t){
        .k_xx_n_per_mm = m->sigma_k_xx_n_per_mm,
        .k_xz_n_per_mm = m->sigma_k_xz_n_per_mm,
        .k_zz_n_per_mm = m->sigma_k_zz_n_per_mm,
        .lambda_min_n_per_mm = m->sigma_lambda_min_n_per_mm,
        .lambda_max_n_per_mm = m->sigma_lambda_max_n_per_mm,
        .stiff_axis_rad = m->sigma_stiff_axis_rad,
    };
    s->space_sigma = (brace_client_space_sigma_t){
        .k_xx_n_per_mm = m->sigma_space_k_xx_n_per_mm,
        .k_xy_n_per_mm = m->sigma_space_k_xy_n_per_mm,
        .k_xz_n_per_mm = m->sigma_space_k_xz_n_per_mm,
        .k_yy_n_per_mm = m->sigma_space_k_yy_n_per_mm,
        .k_yz_n_per_mm = m->sigma_space_k_yz_n_per_mm,
        .k_zz_n_per_mm = m->sigma_space_k_zz_n_per_mm,
        .lambda_n_per_mm = {m->sigma_space_lambda_1_n_per_mm, m->sigma_space_lambda_2_n_per_mm,
                            m->sigma_space_lambda_3_n_per_mm},
        .k_across_n_per_mm = m->sigma_k_across_n_per_mm,
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
    take_sigma(unknown, s);
}

/* Reads some measured values at once, so that they are of one snapshot. The others stay unknown: NaN for a float, all
 * ones for a whole number. */
static brace_client_status_t read_measured(brace_client_t *client, uint32_t first, uint32_t count, uint64_t deadline_us,
                                           brace_measured_t *measured)
{
    uint16_t words[BRACE_MODBUS_REGISTERS_MOST];
    uint32_t values[BRACE_MEASURED_COUNT];
    const brace_client_status_t status =
        transfer(client, BRACE_MODBUS_READ_INPUT, 2u * first, 2u * count, words, deadline_us);
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

static brace_client_status_t read_sigma(brace_client_t *client, uint64_t deadline_us, bool is_in_space,
                                        brace_client_snapshot_t *snapshot)
{
    enum { FIRST = PLACE_OF(sigma_k_xx_n_per_mm), COUNT = PLACE_OF(sigma_k_across_n_per_mm) - FIRST + 1 };
    brace_measured_t measured;
    const brace_client_status_t status = read_measured(client, FIRST, COUNT, deadline_us, &measured);
    if (status == BRACE_CLIENT_OK) {
        take_sigma(&measured, snapshot);
        snapshot->parts |= BRACE_PART_SIGMA | (is_in_space ? BRACE_PART_SIGMA_SPACE : 0u);
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
    enum { VALUES = BRACE_MODBUS_REGISTERS_MOST / 2 };
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
    if (!is_in_space && (wanted & (BRACE_PART_SPACE | BRACE_PART_LOAD_ACROSS | BRACE_PART_SIGMA_SPACE)) != 0u) {
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
    if (status == BRACE_CLIENT_OK && (wanted & (BRACE_PART_SIGMA | BRACE_PART_SIGMA_SPACE)) != 0u) {
        status = read_sigma(client, deadline_us, is_in_space, &taken);
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
        client, is_measured ? BRACE_MODBUS_READ_INPUT : BRACE_MODBUS_READ_HOLDING, address, 2u, words, deadline_us);
    if (status == BRACE_CLIENT_OK) {
        *value = join(words);
    }
    return status;
}

/* -------------------------------------------------------------------------------------------- commands -- */

/* A number or counter, and its check, in one request. */
static int show(brace_client_t *client, uint32_t place, uint32_t number, uint32_t check, uint64_t deadline_us)
{
    uint16_t words[4];
    split(number, words);
    split(check, words + 2);
    return brace_modbus_try(client, BRACE_MODBUS_WRITE, BRACE_REGISTER_COMMANDS + 2u * place, 4u, words, deadline_us);
}

static int read_number(brace_client_t *client, uint32_t index, uint64_t deadline_us, uint32_t *number)
{
    uint16_t words[2];
    const int error =
        brace_modbus_try(client, BRACE_MODBUS_READ_INPUT, 2u * (index - BRACE_ENTRY_MEASURED), 2u, words, deadline_us);
    *number = error == 0 ? join(words) : 0u;
    return error;
}

/* A refused sign of life shows in the controller's is_held and silences, a lost connection in the next request. Answers
 * that come late, after one that has not come, are dropped before: they would be taken for the number. */
void brace_modbus_show_life(brace_client_t *client, uint64_t deadline_us)
{
    brace_client_owner_t *owner = &client->owner;
    uint32_t number;
    int error = brace_modbus_fall_into_step(client, deadline_us);
    if (error == 0 && !owner->has_begin) {
        error = read_number(client, BRACE_CLIENT_ENTRY(life_number), deadline_us, &number);
        if (error == 0) {
            brace_owner_hears(owner, number);
        }
    }
    if (error != 0) {
        return;
    }
    const brace_client_life_t life = brace_owner_life(owner);
    error = show(client, BRACE_CLIENT_COMMAND_PLACE(life_heard), life.number, life.check, deadline_us);
    if (owner->has_begin && (error == 0 || brace_modbus_exception(error) != 0)) {
        owner->has_begin = false;
        client->motion.has_begun |= error == 0;
    }
}

void brace_modbus_tend(brace_client_t *client, uint64_t deadline_us)
{
    if (brace_client_life_is_due(client)) {
        brace_modbus_show_life(client, deadline_us);
    }
}

/* The check is over the request from its function on. */
static brace_client_seal_t seal_of(brace_client_t *client, uint32_t address, const uint16_t *words,
                                   uint32_t words_count)
{
    uint8_t request[REQUEST_HEAD + 4 * ASKED_MOST] = {BRACE_MODBUS_WRITE,   (uint8_t)(address >> 8),
                                                      (uint8_t)address,     0u,
                                                      (uint8_t)words_count, (uint8_t)(2u * words_count)};
    for (uint32_t i = 0u; i < words_count; i++) {
        request[REQUEST_HEAD + 2u * i] = (uint8_t)(words[i] >> 8);
        request[REQUEST_HEAD + 2u * i + 1u] = (uint8_t)words[i];
    }
    (void)brace_owner_next_counter(&client->owner);
    return brace_owner_seal(&client->owner, request, REQUEST_HEAD + 2u * words_count);
}

/* An exception has less to say than a refusal over CAN; who may command the controller is in the status. */
static brace_client_status_t fail_command(brace_client_t *client, uint32_t code, int error, uint64_t deadline_us)
{
    const int exception = brace_modbus_exception(error);
    uint32_t last_refusal;
    int32_t status = exception == 1   ? BRACE_E_MODE
                     : exception == 3 ? BRACE_E_RANGE
                     : exception == 6 ? BRACE_REFUSED_BUSY
                                      : BRACE_E_UNSUPPORTED;
    if (exception < 1 || exception > NOT_OURS) {
        return brace_modbus_fail(client, error);
    }
    client->refusal = exception;
    if (exception == NOT_OURS) {
        const brace_client_status_t asked =
            brace_modbus_entry(client, BRACE_CLIENT_ENTRY(last_refusal), deadline_us, &last_refusal);
        if (asked != BRACE_CLIENT_OK) {
            return asked;
        }
        client->refusal = status = (int32_t)last_refusal - 256;
    }
    return brace_client_fail(client, BRACE_CLIENT_E_REFUSED, "%s: unit %u refuses: %s (exception %d)", client->url,
                             (unsigned)client->unit, brace_client_reason(code, status, 0u), exception);
}

brace_client_status_t brace_modbus_command(brace_client_t *client, uint32_t code, uint32_t place,
                                           const uint32_t *values, uint32_t count, bool is_sealed, bool moves,
                                           uint64_t deadline_us)
{
    const uint32_t address = BRACE_REGISTER_COMMANDS + 2u * place;
    uint16_t words[2 * ASKED_MOST];
    uint32_t begin = UINT32_MAX;
    int error;
    for (uint32_t i = 0u; i < count; i++) {
        split(values[i], words + 2u * i);
    }
    for (;;) {
        brace_modbus_tend(client, deadline_us);
        error = brace_modbus_fall_into_step(client, deadline_us);
        if (error != 0 && brace_modbus_may_pass(error) && brace_bus_left_ms(deadline_us) > 0) {
            continue;
        }
        if (error == 0 && is_sealed && client->owner.is_open) {
            const brace_client_seal_t seal = seal_of(client, address, words, 2u * count);
            error = show(client, BRACE_CLIENT_COMMAND_PLACE(seal_counter), seal.counter, seal.check, deadline_us);
        }
        if (error == 0) {
            error = brace_modbus_try(client, BRACE_MODBUS_WRITE, address, 2u * count, words, deadline_us);
        }
        if (error == 0 && moves) {
            error = read_number(client, BRACE_CLIENT_ENTRY(begin_number), deadline_us, &begin);
        }
        if (error == 0) {
            if (begin != UINT32_MAX) {
                brace_owner_may_begin(&client->owner, begin);
            }
            return BRACE_CLIENT_OK;
        }
        const bool is_worth_it = brace_modbus_exception(error) == BUSY || brace_modbus_may_pass(error);
        if (!is_worth_it || brace_bus_left_ms(deadline_us) <= BUSY_MS) {
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
    brace_client_status_t status = transfer(client, BRACE_MODBUS_WRITE, address, 2u * count, words, deadline_us);
    if (status == BRACE_CLIENT_OK) {
        status = transfer(client, BRACE_MODBUS_READ_INPUT, 0x1000u, 2u * BRACE_ANSWERED_COUNT, answers, deadline_us);
    }
    if (status == BRACE_CLIENT_OK) {
        status = transfer(client, BRACE_MODBUS_READ_HOLDING, address, 2u * count, readback, deadline_us);
    }
    *is_mine = status == BRACE_CLIENT_OK && memcmp(words, readback, 4u * count) == 0;
    return status;
}

brace_client_status_t brace_modbus_ask(brace_client_t *client, uint32_t first, const uint32_t *values, uint32_t count,
                                       uint64_t deadline_us, brace_answered_t *answered)
{
    const uint32_t address = BRACE_REGISTER_COMMANDS + 2u * first;
    uint16_t words[2 * ASKED_MOST], answers[2 * BRACE_ANSWERED_COUNT];
    uint32_t values_read[BRACE_ANSWERED_COUNT];
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
                                     "or CAN, where each has its own answer",
                                     client->url);
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
        values_read[i] = join(answers + 2u * i);
    }
    memcpy(answered, values_read, sizeof *answered);
    return BRACE_CLIENT_OK;
}
