/* modbus_fuzz [REQUESTS [SEED]]: random, mutated and well-formed Modbus requests to a controller, over the line and as
 * whole TCP frames. It fails when
 *   a sound request for the unit is not answered, or answered twice, or with a broken frame; anything else is answered
 *   an answer is neither the request's function at its proper length nor one of the exceptions 1, 2, 3, 4, 6
 *   a probe register, or a parameter outside CONFIGURATION, reads otherwise than it is
 *   the mode becomes CONFIGURATION without the key, or parameters change without commit or rollback in that mode
 * Exit code 0 and one line when all is well. */
#include "fuzz.h"
#include "modbus_crc.h"

enum { UNIT = 17, CONFIGURE = 16384, COMMIT = 16386, ROLLBACK = 16388, PDU_BYTES = 253, NEW_LIMB_AFTER = 2000 };
enum { ANSWER_TICKS = 400, QUIET_TICKS = 6, LINE_QUIET_TICKS = 40 };
static const uint32_t configuration_key = 0xc0de0002u;

static bool keyed, committed;
static uint32_t crc_known, changes, answered, exceptions, silent;
static uint8_t pdu[300], reply[600];
static uint32_t pdu_count, reply_count;

static uint32_t word(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 8 | bytes[1];
}

static uint32_t value_of(const uint8_t *bytes)
{
    return word(bytes) << 16 | word(bytes + 2);
}

static void put_word(uint32_t at, uint32_t value)
{
    pdu[at] = (uint8_t)(value >> 8), pdu[at + 1u] = (uint8_t)value;
}

static void put_value(uint32_t at, uint32_t value)
{
    put_word(at, value >> 16), put_word(at + 2u, value & 0xffffu);
}

static void start(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    bench_start(&p);
    ticks(30);
    crc_known = app.controller.parameters.crc;
    keyed = committed = false;
}

static uint32_t somewhere(void)
{
    switch (dice(6)) {
    case 0: return dice(4) * 2u;
    case 1: return dice(0x10000);
    case 2: return CONFIGURE + dice(14);
    default: return dice(120) * (1u + dice(2));
    }
}

static void compose(void)
{
    static const uint8_t known[] = {3, 3, 4, 4, 4, 6, 16, 16, 17, 8, 0x2b};
    const uint32_t start_register = somewhere();
    const uint32_t values = dice(8) != 0u ? 1u + dice(4) : dice(62);
    const uint32_t count = dice(8) != 0u ? 2u * values : dice(130);
    pdu[0] = known[dice(sizeof known)];
    put_word(1, start_register);
    put_word(3, count);
    pdu_count = 5;
    if (pdu[0] == 16u) {
        put_word(3, 2u * values);
        pdu[5] = (uint8_t)(4u * values);
        pdu_count = 6u + 4u * values;
        for (uint32_t i = 6; i < pdu_count; i++) {
            pdu[i] = (uint8_t)dice(256);
        }
    } else if (pdu[0] == 17u) {
        pdu_count = 1;
    } else if (pdu[0] == 8u) {
        put_word(1, dice(24));
    } else if (pdu[0] == 0x2bu) {
        pdu[1] = 14, pdu[2] = (uint8_t)(1u + dice(4)), pdu[3] = (uint8_t)dice(8);
        pdu_count = 4;
    }
    if (dice(12) == 0u) { /* a command, as it should be */
        const uint32_t which = dice(3);
        pdu[0] = 16;
        put_word(1, CONFIGURE + 2u * which);
        put_word(3, 2), pdu[5] = 4;
        put_value(6, which == 0u ? 0xc0de0001u + dice(2) : 0xc0de0001u);
        pdu_count = 10;
    }
    if (dice(4) == 0u) {
        mutate(pdu, pdu_count);
    }
    if (dice(12) == 0u) {
        const uint32_t more = 1u + dice(PDU_BYTES);
        for (uint32_t i = pdu_count; i < more; i++) {
            pdu[i] = (uint8_t)dice(256);
        }
        pdu_count = more;
    }
}

/* Of what is fed, what can lead to a change. */
static void note(void)
{
    if (pdu[0] != 16u && pdu[0] != 6u) {
        return;
    }
    const uint32_t first = word(pdu + 1), last = pdu[0] == 6u ? first : first + word(pdu + 3) - 1u;
    if (pdu[0] == 16u && pdu_count >= 10u && first <= CONFIGURE && last > CONFIGURE &&
        6u + 2u * (CONFIGURE - first) + 4u <= pdu_count &&
        value_of(pdu + 6u + 2u * (CONFIGURE - first)) == configuration_key) {
        keyed = true;
    }
    committed = committed || (keyed && last >= COMMIT && first < ROLLBACK + 2u);
}

static void tick(brace_serial_port_t port)
{
    ticks(1);
    reply_count += brace_fake_bytes_take(&fake, port, reply + reply_count, (uint32_t)sizeof reply - reply_count);
    if (app.controller.mode.now == BRACE_MODE_CONFIGURATION && !keyed) {
        fail("configuration without its key", pdu, pdu_count);
    }
    if (app.controller.parameters.crc != crc_known) {
        if (!committed) {
            fail("parameters changed without a commit", pdu, pdu_count);
        }
        crc_known = app.controller.parameters.crc;
        changes++;
    }
}

static void exchange(brace_serial_port_t port, const uint8_t *bytes, uint32_t count, bool is_sound)
{
    reply_count = 0;
    if (brace_fake_bytes_arrive(&fake, port, bytes, count) != count) {
        fail("bytes are not taken", bytes, count);
    }
    uint32_t quiet = 0;
    for (uint32_t i = 0; i < ANSWER_TICKS && quiet < QUIET_TICKS + (is_sound && reply_count == 0u ? ANSWER_TICKS : 0u) +
                                                         (is_sound ? 0u : LINE_QUIET_TICKS);
         i++) {
        const uint32_t before = reply_count;
        tick(port);
        quiet = reply_count == before ? quiet + 1u : 0u;
    }
}

/* The answer's PDU against the request's. */
static void check(const uint8_t *answer, uint32_t count, bool was_configuring)
{
    if (count == 2u && answer[0] == (pdu[0] | 0x80u)) {
        const uint32_t code = answer[1];
        exceptions++;
        if (code < 1u || code > 7u || code == 5u) {
            fail("an exception that there is not", pdu, pdu_count);
        }
        return;
    }
    answered++;
    if (count == 0u || answer[0] != pdu[0] || (answer[0] & 0x80u) != 0u) {
        fail("another function", pdu, pdu_count);
    }
    if (pdu[0] == 3u || pdu[0] == 4u) {
        const uint32_t first = word(pdu + 1), registers = word(pdu + 3);
        if (pdu_count != 5u || registers == 0u || registers > 125u || count != 2u + 2u * registers ||
            answer[1] != 2u * registers) {
            fail("a read of another length", pdu, pdu_count);
        }
        for (uint32_t i = first % 2u; i + 1u < registers; i += 2u) {
            const uint32_t at = first + i, got = value_of(answer + 2u + 2u * i);
            uint32_t held = got;
            if (pdu[0] == 4u && at == 0u) {
                held = 0x4640e600u;
            } else if (pdu[0] == 4u && at == 2u) {
                held = 0x01020304u;
            } else if (pdu[0] == 3u && at / 2u < (uint32_t)BRACE_PARAMETER_NUMBERS && !was_configuring) {
                const uint8_t *in_force = (const uint8_t *)&app.controller.parameters.in_force;
                memcpy(&held, in_force + 4u * brace_parameter_index(at / 2u), 4);
            }
            if (got != held) {
                fail("another value", pdu, pdu_count);
            }
        }
    } else if ((pdu[0] == 6u || pdu[0] == 16u || pdu[0] == 8u) &&
               (count < 5u || memcmp(answer, pdu, pdu[0] == 8u ? 3u : 5u) != 0)) {
        fail("no echo", pdu, pdu_count);
    } else if (pdu[0] != 6u && pdu[0] != 16u && pdu[0] != 8u && pdu[0] != 17u && pdu[0] != 0x2bu) {
        fail("an answer to a function that there is not", pdu, pdu_count);
    }
}

static void over_line(bool was_configuring)
{
    uint8_t frame[310];
    const bool other = dice(10) == 0u, broken = dice(6) == 0u;
    frame[0] = other ? (uint8_t)(1u + dice(247)) : UNIT;
    memcpy(frame + 1, pdu, pdu_count);
    uint32_t count = pdu_count + 1u;
    const uint32_t crc = crc_by_bits(frame, count);
    frame[count++] = (uint8_t)crc, frame[count++] = (uint8_t)(crc >> 8);
    if (broken && dice(2) != 0u) {
        count = dice(count);
    } else if (broken) {
        mutate(frame, count);
    }
    /* a function code with the top bit is an answer's, come back over a line of two wires */
    const bool sound = count >= 4u && frame[0] == UNIT && crc_by_bits(frame, count) == 0u && frame[1] < 0x80u;
    if (sound) { /* a mutation may have left it so */
        pdu_count = count - 3u;
        memcpy(pdu, frame + 1, pdu_count);
        note();
    } else if (count >= 4u && frame[0] == 0u && crc_by_bits(frame, count) == 0u) {
        pdu_count = count - 3u;
        memcpy(pdu, frame + 1, pdu_count);
        note(); /* to all: obeyed, not answered */
    }
    exchange(BRACE_SERIAL_MODBUS, frame, count, sound);
    if (!sound) {
        silent += reply_count == 0u;
        if (reply_count > 0u) {
            fail("an answer to what was no request", frame, count);
        }
    } else if (reply_count < 4u || reply[0] != UNIT || crc_by_bits(reply, reply_count) != 0u) {
        fail("no sound answer", frame, count);
    } else {
        check(reply + 1, reply_count - 3u, was_configuring);
    }
}

static void over_tcp(bool was_configuring)
{
    uint8_t frame[310] = {(uint8_t)dice(256),
                          (uint8_t)dice(256),
                          0,
                          0,
                          (uint8_t)((pdu_count + 1u) >> 8),
                          (uint8_t)(pdu_count + 1u),
                          UNIT};
    memcpy(frame + 7, pdu, pdu_count);
    note();
    exchange(BRACE_SERIAL_MODBUS_TCP, frame, pdu_count + 7u, true);
    if (reply_count < 9u || memcmp(reply, frame, 4) != 0 || word(reply + 4) != reply_count - 6u || reply[6] != UNIT) {
        fail("no sound answer", frame, pdu_count + 7u);
    }
    check(reply + 7, reply_count - 7u, was_configuring);
}

int main(int count, char **arguments)
{
    const unsigned long wanted = count > 1 ? strtoul(arguments[1], NULL, 10) : 1000000ul;
    fuzz_seed(count > 2 ? arguments[2] : NULL);
    for (fed = 0; fed < wanted; fed++) {
        if (fed % NEW_LIMB_AFTER == 0u) {
            start();
        }
        compose();
        const bool was_configuring = app.controller.mode.now == BRACE_MODE_CONFIGURATION || keyed;
        if (dice(2) != 0u) {
            over_line(was_configuring);
        } else {
            over_tcp(was_configuring);
        }
    }
    printf("%lu Modbus requests: %u answered, %u exceptions, %u not for anybody, parameters changed %u times\n", wanted,
           answered, exceptions, silent, changes);
    return wanted < 10000u || (answered > wanted / 10u && exceptions > 0u && silent > 0u && changes > 0u) ? 0 : 1;
}
