/* can_fuzz [REQUESTS [SEED]]: random, mutated and well-formed CAN frames to a controller, noise between them.
 * It fails when
 *   a request is not answered, or anything else is; an answer's command, parts or token are not the request's
 *   K at a posture is not physics.md's, a parameter read is not the one in force
 *   the mode becomes CONFIGURATION without the key, or parameters change without commit or rollback in that mode
 *   the heartbeat stops
 * Exit code 0 and one line when all is well. */
#include "brace/answering.h"
#include "brace/can_messages.h"
#include "fuzz.h"

enum { NODE = 5, STORE_TICKS = 3000, QUIET_TICKS = 3, NEW_LIMB_AFTER = 2000, BEAT_TICKS = 1100 };

static bool keyed, committed; /* CONFIGURATION was asked for properly; and then a commit or rollback came */
static uint32_t crc_known, beat_age, changes, k_checked, refused;
static uint8_t answer[8][8];
static uint32_t answer_count;

static uint32_t field(const uint8_t *data, uint32_t byte, uint32_t bytes)
{
    uint32_t value = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        value |= (uint32_t)data[byte + i] << (8u * i);
    }
    return value;
}

static double signed24(const uint8_t *data, uint32_t byte)
{
    return (double)((int32_t)(field(data, byte, 3) << 8) >> 8);
}

static void start(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
    ticks(30);
    brace_can_frame_t frame;
    while (brace_fake_frame_take(&fake, &frame)) {
    }
    crc_known = app.controller.parameters.crc;
    keyed = committed = false;
    beat_age = 0;
}

/* A tick, and what it put on the bus. */
static void tick(const uint8_t *request)
{
    brace_can_frame_t frame;
    ticks(1);
    beat_age++;
    while (brace_fake_frame_take(&fake, &frame)) {
        if (frame.id == 0x700u + NODE) {
            beat_age = 0;
        } else if (frame.id == 0x580u + NODE) {
            if (answer_count == 8u || frame.length != 8u) {
                fail("too many answers", request, 8);
            }
            memcpy(answer[answer_count++], frame.data, 8);
        }
    }
    if (beat_age > BEAT_TICKS) {
        fail("no heartbeat", request, 8);
    }
    if (app.controller.mode.now == BRACE_MODE_CONFIGURATION && !keyed) {
        fail("configuration without its key", request, 8);
    }
    if (app.controller.parameters.crc != crc_known) {
        if (!committed) {
            fail("parameters changed without a commit", request, 8);
        }
        crc_known = app.controller.parameters.crc;
        changes++;
    }
}

static void put(uint8_t *data, uint32_t byte, uint32_t bytes, uint32_t value)
{
    for (uint32_t i = 0; i < bytes; i++) {
        data[byte + i] = (uint8_t)(value >> (8u * i));
    }
}

static void compose(uint8_t data[8])
{
    const uint32_t kind = dice(100);
    for (int i = 0; i < 8; i++) {
        data[i] = (uint8_t)dice(256);
    }
    if (kind < 35u) { /* K somewhere in reach */
        data[0] = 3;
        put(data, 2, 3, (uint32_t)((int32_t)dice(4000000) - 1500000));
        put(data, 5, 3, 300000u + dice(2500000));
    } else if (kind < 50u) {
        data[0] = 1;
        put(data, 2, 2, dice(2) != 0u ? dice(130) : 0x1000u + dice(70));
    } else if (kind < 60u) {
        data[0] = 2;
        put(data, 2, 2, dice(130));
        const float value = (float)dice(2000) * 0.01f - 5.0f;
        memcpy(data + 4, &value, 4);
    } else if (kind < 65u) {
        data[0] = 9, data[2] = (uint8_t)(1u + dice(2));
        put(data, 3, 2, 0xc0de);
    } else if (kind < 68u) {
        data[0] = (uint8_t)(12u + dice(2));
        put(data, 2, 4, 0);
    } else if (kind < 80u) {
        data[0] = (uint8_t)dice(BRACE_REQUEST_CODE_MOST + 2u);
    } /* else: noise throughout */
    if (dice(4) == 0u) {
        mutate(data, 8);
    }
}

static void noise_frames(void)
{
    for (uint32_t left = dice(4); left > 0u; left--) {
        brace_can_frame_t frame = {.id = dice(3) != 0u ? dice(0x800) : 0x600u + NODE, .length = (uint8_t)dice(9)};
        if (frame.id == 0x600u + NODE && frame.length == 8u) {
            frame.length = (uint8_t)dice(8);
        }
        for (uint32_t i = 0; i < 8u; i++) {
            frame.data[i] = (uint8_t)dice(256);
        }
        (void)brace_fake_frame_arrives(&fake, &frame);
    }
}

static void check_k(const uint8_t *request)
{
    const double theta1 = 1e-6 * signed24(request, 2), theta2 = 1e-6 * signed24(request, 5);
    double k[3];
    const brace_parameters_t p = bench_parameters();
    if (fabs(theta1) > 3.0 || theta2 < 0.3 || theta2 > 2.8 || !paper_stiffness(&p, theta1, theta2, k)) {
        return;
    }
    const double reported[3] = {signed24(answer[0], 2) * 0.0005, signed24(answer[0], 5) * 0.0005,
                                signed24(answer[1], 2) * 0.0005};
    const double room = 0.00025 + 5e-6 * (k[0] > k[2] ? k[0] : k[2]);
    for (int i = 0; i < 3; i++) {
        if (!(fabs(reported[i] - k[i]) <= room)) {
            fail("another K", request, 8);
        }
    }
    k_checked++;
}

static void check_answer(const uint8_t *request, bool is_the_benchs)
{
    const uint32_t command = request[0];
    if (answer_count == 1u && answer[0][0] == BRACE_ANSWER_REFUSED && answer[0][1] == request[1] &&
        answer[0][2] == command) {
        refused++;
        if ((int8_t)answer[0][3] >= 0) {
            fail("a refusal that is none", request, 8);
        }
        if (command == 3u && is_the_benchs && app.controller.mode.now != BRACE_MODE_CONFIGURATION &&
            fabs(signed24(request, 2)) < 3e6 && signed24(request, 5) > 3e5 && signed24(request, 5) < 2.8e6) {
            fail("no K where there is one", request, 8);
        }
        return;
    }
    if (answer_count != brace_can_answer_parts[command] || command == 0u) {
        fail("as many parts as no answer has", request, 8);
    }
    for (uint32_t part = 0; part < answer_count; part++) {
        const brace_can_answer_frame_t *is = &brace_can_answer_frames[answer[part][0]];
        if (is->parts == 0u || is->code != command || is->part != part || answer[part][1] != request[1]) {
            fail("another request's answer", request, 8);
        }
    }
    if (command == 3u && is_the_benchs) {
        check_k(request);
    } else if (command == 1u) {
        const uint32_t index = field(request, 2, 2), value = field(answer[0], 4, 4);
        uint32_t held;
        if (index < (uint32_t)BRACE_PARAMETER_NUMBERS) {
            memcpy(&held, (const uint8_t *)&app.controller.parameters.in_force + 4u * brace_parameter_index(index), 4);
        } else {
            held = index == 0x1001u ? 0x01020304u : value;
        }
        if (field(answer[0], 2, 2) != index || (value != held && app.controller.mode.now != BRACE_MODE_CONFIGURATION)) {
            fail("another entry", request, 8);
        }
    }
}

static void feed(const uint32_t crc_of_the_bench)
{
    uint8_t data[8];
    compose(data);
    keyed = keyed || (data[0] == 9u && data[2] == 2u && field(data, 3, 2) == 0xc0deu);
    committed = committed || (keyed && (data[0] == 12u || data[0] == 13u));
    const bool is_the_benchs = app.controller.parameters.crc == crc_of_the_bench;
    answer_count = 0;
    noise_frames();
    brace_can_frame_t frame = {.id = 0x600u + NODE, .length = 8};
    memcpy(frame.data, data, 8);
    if (!brace_fake_frame_arrives(&fake, &frame)) {
        fail("frames are not taken", data, 8);
    }
    uint32_t waited = 0;
    for (uint32_t quiet = 0; quiet < QUIET_TICKS && waited < STORE_TICKS; waited++) {
        const uint32_t before = answer_count;
        tick(data);
        quiet = answer_count > 0u && answer_count == before ? quiet + 1u : 0u;
    }
    if (answer_count == 0u) {
        fail("no answer", data, 8);
    }
    check_answer(data, is_the_benchs && app.controller.parameters.crc == crc_of_the_bench);
}

int main(int count, char **arguments)
{
    const unsigned long wanted = count > 1 ? strtoul(arguments[1], NULL, 10) : 1000000ul;
    fuzz_seed(count > 2 ? arguments[2] : NULL);
    uint32_t crc_of_the_bench = 0;
    for (fed = 0; fed < wanted; fed++) {
        if (fed % NEW_LIMB_AFTER == 0u) {
            start();
            crc_of_the_bench = crc_known;
        }
        feed(crc_of_the_bench);
    }
    printf("%lu CAN requests: %u refused, %u K checked, parameters changed %u times, each after a commit\n", wanted,
           refused, k_checked, changes);
    return wanted < 10000u || (k_checked > wanted / 20u && changes > 0u && refused > 0u) ? 0 : 1;
}
