/* Random and mutated Modbus requests, on the line and over TCP, against the whole controller on the fake board: each is
 * answered as the standard says or, on the line, not at all; what is answered is right; no parameter changes without
 * its commit, none is staged outside CONFIGURATION, and the controller ticks on. Build it with the sanitizers.
 *
 *     modbus_registers_fuzz [REQUESTS] [SEED]     exit code 1 and the request, at the first thing wrong
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app_bench.h"
#include "brace/measured.h"
#include "modbus_crc.h"

enum {
    UNIT = 17,
    WORDS = BRACE_PARAMETER_NUMBERS,
    MOST_TICKS = 120,
    HEADER = 7,
    ANSWERED = 42,
    COMMANDS = 41 /* values from 4096 and from 16384 on, by docs/modbus.md */
};

static const uint32_t key = 0xc0de0000u;

typedef struct {
    uint8_t byte[300];
    uint32_t count;
} bytes_t;

void setUp(void) {}
void tearDown(void) {}

static uint64_t chance;
static unsigned long number;
static brace_parameters_t in_force; /* as the oracle knows them */
static unsigned long questions[COMMANDS]; /* answered, by the first value's place after 16396 */
static unsigned long answered, refused_by[256], silent, commits;

static uint32_t dice(uint32_t sides)
{
    chance ^= chance << 13;
    chance ^= chance >> 7;
    chance ^= chance << 17;
    return (uint32_t)(chance >> 32) % sides;
}

static void wrong(const char *what, const bytes_t *sent, const bytes_t *got)
{
    printf("request %lu: %s\n  sent", number, what);
    for (uint32_t i = 0; i < sent->count; i++) {
        printf(" %02x", sent->byte[i]);
    }
    printf("\n  got ");
    for (uint32_t i = 0; i < got->count; i++) {
        printf(" %02x", got->byte[i]);
    }
    printf("\n  mode %d, parameters %s\n", (int)app.controller.mode.now,
           parameter_job_is_busy(&app.controller.parameters) ? "being stored" : "at rest");
    exit(1);
}

static uint32_t word(const void *values, uint32_t index)
{
    uint32_t value;
    memcpy(&value, (const uint8_t *)values + 4u * index, 4);
    return value;
}

/* A parameter by the place of its registers. */
static uint32_t parameter_at(const brace_parameters_t *set, uint32_t place)
{
    return word(set, brace_parameter_index(place));
}

static uint32_t bits(float value)
{
    return word(&value, 0);
}

static void put16(bytes_t *b, uint32_t value)
{
    b->byte[b->count++] = (uint8_t)(value >> 8);
    b->byte[b->count++] = (uint8_t)value;
}

static uint32_t at16(const uint8_t *b)
{
    return (uint32_t)b[0] << 8 | b[1];
}

static uint32_t at32(const uint8_t *b)
{
    return at16(b) << 16 | at16(b + 2);
}

/* ----------------------------------------------------------------------------------------- requests -- */

static uint32_t some_start(void)
{
    static const uint16_t edge[] = {0,     2,     114,   116,   208,   210,   4096,  4108,  4110,  16384,
                                    16386, 16388, 16390, 16392, 16394, 16396, 16398, 16400, 16406, 16410,
                                    16414, 16416, 16418, 16422, 16430, 16440, 16452, 16454, 16456, 16460,
                                    4122,  4126,  4152,  4180,  65535, 65534, 32768};
    return dice(4) == 0u ? dice(65536) : edge[dice(sizeof edge / sizeof *edge)];
}

/* A value that is right where it goes, mostly. */
static uint32_t some_value(uint32_t start)
{
    if (start < 2u * WORDS && dice(4) != 0u) {
        return parameter_at(&app.controller.parameters.in_force, start / 2u) + (dice(3) == 0u ? dice(64) : 0u);
    }
    switch (start) {
    case 16384: return key | (1u + dice(2));
    case 16386:
    case 16388: return dice(8) == 0u ? key | 1u : dice(4);
    case 16454: return dice(2) == 0u ? dice(65536) : brace_parameters_crc(brace_app_parameters_staged(&app));
    case 16392: return 256u << dice(2) | (1u + dice(2));
    case 16396:
    case 16398:
    case 16426:
    case 16428:
    case 16446:
    case 16448:
    case 16450: return bits(0.3f + 1e-3f * (float)dice(1000));
    case 16400:
    case 16402:
    case 16434:
    case 16436: return bits((float)dice(600) - 300.0f);
    case 16404:
    case 16438: return dice(8) == 0u ? dice(4) : dice(2);
    case 16406:
    case 16408:
    case 16410:
    case 16412:
    case 16414:
    case 16416:
    case 16418:
    case 16420:
    case 16422:
    case 16424:
    case 16430:
    case 16432:
    case 16440:
    case 16442:
    case 16444: return bits(1e-2f * (float)dice(200) - 0.5f);
    default: return dice(2) == 0u ? dice(1024) : dice(0x10000) << 16 | dice(0x10000);
    }
}

/* Values of the question that begins there. */
static uint32_t question_of(uint32_t start)
{
    switch (start) {
    case 16396u:
    case 16406u:
    case 16410u:
    case 16414u:
    case 16418u: return 2;
    case 16400u: return 3;
    case 16422u: return 4;
    case 16430u: return 5;
    case 16440u: return 6;
    case 16452u: /* stop, commit_crc, end_test: single; a sign of life and a seal: two values */
    case 16454u:
    case 16464u: return 1;
    case 16456u:
    case 16460u: return 2;
    default: return 0;
    }
}

static void some_pdu(bytes_t *b)
{
    static const uint8_t functions[] = {3, 3, 4, 4, 6, 8, 16, 16, 16, 17, 43};
    const uint32_t function = dice(16) == 0u ? dice(256) : functions[dice(sizeof functions)];
    uint32_t start = some_start();
    b->byte[b->count++] = (uint8_t)function;
    if (function == 17u) {
        return;
    }
    if (function == 43u) {
        put16(b, 14u << 8 | (1u + dice(4)));
        b->byte[b->count++] = (uint8_t)dice(4);
        return;
    }
    if (function == 8u) {
        put16(b, dice(20));
        put16(b, dice(3) == 0u ? dice(65536) : 0u);
        return;
    }
    put16(b, start);
    if (function != 16u) {
        put16(b, function == 6u || dice(8) == 0u ? dice(65536) : 1u + dice(130));
        return;
    }
    const uint32_t question = dice(16) == 0u ? 0u : question_of(start);
    const uint32_t values = question > 0u ? question : start >= 16384u || dice(2) != 0u ? 1u : 1u + dice(61);
    put16(b, 2u * values);
    b->byte[b->count++] = (uint8_t)(4u * values);
    for (uint32_t i = 0; i < values; i++, start += 2u) {
        const uint32_t value = some_value(start);
        put16(b, value >> 16);
        put16(b, value & 0xffffu);
    }
}

static void mutate(bytes_t *b, uint32_t from)
{
    for (uint32_t times = 1u + dice(3); times > 0u && b->count > from; times--) {
        uint8_t *byte = &b->byte[from + dice(b->count - from)];
        switch (dice(4)) {
        case 0: *byte ^= (uint8_t)(1u << dice(8)); break;
        case 1: *byte = (uint8_t)dice(256); break;
        case 2: b->count -= dice(b->count - from) / 4u; break;
        default:
            if (b->count < 250u) {
                b->byte[b->count++] = (uint8_t)dice(256);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------- oracle -- */

static bool holds(uint32_t start, uint32_t count, uint32_t first, uint32_t values)
{
    return start >= first && start + count <= first + 2u * values;
}

static uint32_t read_exception(const uint8_t *pdu, uint32_t length)
{
    const uint32_t start = at16(pdu + 1), count = at16(pdu + 3);
    if (length != 5u || count < 1u || count > 125u) {
        return 3;
    }
    const bool there = pdu[0] == 4u
                           ? holds(start, count, 0, BRACE_MEASURED_COUNT) || holds(start, count, 4096, ANSWERED)
                           : holds(start, count, 0, WORDS) || holds(start, count, 16384, COMMANDS);
    return there && (count == 1u || start % 2u == 0u) ? 0u : 2u;
}

typedef struct {
    brace_mode_t mode;
    bool begun;
    brace_parameters_t staged;
} before_t;

/* Are these the registers of that set, as far as they are parameters? */
static bool are_of(const uint8_t *answer, uint32_t start, uint32_t count, const brace_parameters_t *set)
{
    bool same = true;
    for (uint32_t i = 0; i < count && start + i < 2u * WORDS; i++) {
        const uint32_t value = parameter_at(set, (start + i) / 2u);
        same = same && at16(answer + 2u + 2u * i) == (((start + i) & 1u) == 0u ? value >> 16 : value & 0xffffu);
    }
    return same;
}

/* What a read must return, where the oracle knows it: probes, and parameters: of one set, the one from before the
 * request, or the one from after it, when a commit has ended meanwhile. */
static void judge_read(const bytes_t *sent, const uint8_t *pdu, const bytes_t *got, const uint8_t *answer,
                       uint32_t length, const before_t *before)
{
    const uint32_t start = at16(pdu + 1), count = at16(pdu + 3);
    if (length != 2u + 2u * count || answer[1] != 2u * count) {
        wrong("an answer of the wrong length", sent, got);
    }
    for (uint32_t i = 0; pdu[0] == 4u && i < count && start + i < 4u; i++) {
        static const uint16_t probe[] = {0x4640, 0xe600, 0x0102, 0x0304};
        if (at16(answer + 2u + 2u * i) != probe[start + i]) {
            wrong("a probe read wrong", sent, got);
        }
    }
    const brace_parameters_t *old = before->begun ? &before->staged : &in_force;
    const brace_parameters_t *new = brace_app_parameters_staged(&app);
    if (pdu[0] == 3u && !are_of(answer, start, count, old) && !are_of(answer, start, count, new)) {
        wrong("a parameter read wrong", sent, got);
    }
}

static void judge_write(const bytes_t *sent, const uint8_t *pdu, uint32_t length, const bytes_t *got,
                        const before_t *before)
{
    const uint32_t start = at16(pdu + 1);
    if (pdu[0] == 16u && (length < 6u || length != 6u + pdu[5] || pdu[5] != 2u * at16(pdu + 3))) {
        wrong("a write of the wrong length was taken", sent, got);
    }
    if (start < 2u * WORDS && before->mode != BRACE_MODE_CONFIGURATION) {
        wrong("a parameter was written outside CONFIGURATION", sent, got);
    }
    if (pdu[0] != 16u) {
        return;
    }
    const uint32_t value = at32(pdu + 6);
    if (start == 16386u || start == 16388u || start == 16454u) {
        if ((value != (key | 1u) && start != 16454u) || before->mode != BRACE_MODE_CONFIGURATION) {
            wrong("a commit without its key or mode", sent, got);
        }
        commits++;
    }
    if (start == 16384u && (value & ~3u) != key) {
        wrong("a mode was set without its key", sent, got);
    }
    if (start >= 16396u && start < 16384u + 2u * COMMANDS && (pdu[5] / 4u != question_of(start) || pdu[5] == 0u)) {
        wrong("half a question was answered", sent, got);
    }
    questions[(start - 16396u) / 2u % COMMANDS] += start >= 16396u;
    if (start < 2u * WORDS) {
        for (uint32_t i = 0; i < pdu[5] / 4u; i++) {
            if (parameter_at(&app.controller.parameters.staged, start / 2u + i) != at32(pdu + 6u + 4u * i)) {
                wrong("what was written is not what is staged", sent, got);
            }
        }
    }
}

static void judge(const bytes_t *sent, const uint8_t *pdu, uint32_t length, const bytes_t *got, const uint8_t *answer,
                  uint32_t answer_length, const before_t *before)
{
    answered++;
    if ((answer[0] & 0x7fu) != (pdu[0] & 0x7fu)) {
        wrong("another function answered", sent, got);
    }
    const bool is_refusal = (answer[0] & 0x80u) != 0u;
    const bool is_read = pdu[0] == 3u || pdu[0] == 4u;
    if (is_refusal) {
        static const uint8_t codes[] = {1, 2, 3, 4, 6, 7};
        if (answer_length != 2u || memchr(codes, answer[1], sizeof codes) == NULL) {
            wrong("a refusal of no kind", sent, got);
        }
        refused_by[answer[1]]++;
    }
    if (is_read && (is_refusal ? answer[1] : 0u) != read_exception(pdu, length)) {
        wrong("a read's exception", sent, got);
    }
    if (is_refusal) {
        if (before->begun && app.controller.parameters.has_staged &&
            memcmp(&before->staged, &app.controller.parameters.staged, sizeof before->staged) != 0) {
            wrong("a refused request changed what is staged", sent, got);
        }
    } else if (is_read) {
        judge_read(sent, pdu, got, answer, answer_length, before);
    } else if (pdu[0] == 6u || pdu[0] == 16u) {
        if (answer_length != 5u || memcmp(pdu, answer, 5) != 0) {
            wrong("a write answered with other registers", sent, got);
        }
        judge_write(sent, pdu, length, got, before);
    } else if (pdu[0] != 8u && pdu[0] != 17u && pdu[0] != 43u) {
        wrong("a function that is not there was answered", sent, got);
    }
}

/* --------------------------------------------------------------------------------------------- wires -- */

static bool hear(brace_serial_port_t port, bytes_t *got, int most)
{
    got->count = 0;
    for (int i = 0; i < most; i++) {
        const uint32_t before = got->count;
        ticks(1);
        got->count +=
            brace_fake_bytes_take(&fake, port, got->byte + got->count, (uint32_t)sizeof got->byte - got->count);
        if (got->count > 0u && got->count == before) {
            return true; /* a long answer leaves the line's port in parts, tick after tick */
        }
    }
    return got->count > 0u;
}

static void over_tcp(const before_t *before)
{
    bytes_t sent = {{(uint8_t)(number >> 8), (uint8_t)number, 0, 0, 0, 0, UNIT}, HEADER}, got;
    some_pdu(&sent);
    if (dice(3) == 0u) {
        mutate(&sent, HEADER + 1);
    }
    const uint32_t length = sent.count - HEADER;
    sent.byte[4] = (uint8_t)((length + 1u) >> 8);
    sent.byte[5] = (uint8_t)(length + 1u);
    (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, sent.byte, sent.count);
    if (!hear(BRACE_SERIAL_MODBUS_TCP, &got, MOST_TICKS)) {
        wrong("no answer over TCP", &sent, &got);
    }
    if (memcmp(got.byte, sent.byte, 4) != 0 || got.byte[6] != UNIT || at16(got.byte + 4) != got.count - 6u) {
        wrong("a header that does not fit", &sent, &got);
    }
    judge(&sent, sent.byte + HEADER, length, &got, got.byte + HEADER, got.count - HEADER, before);
}

static void on_the_line(const before_t *before)
{
    bytes_t sent = {{dice(16) == 0u ? (uint8_t)dice(256) : UNIT}, 1}, got;
    some_pdu(&sent);
    if (dice(3) == 0u) {
        mutate(&sent, 2);
    }
    const uint32_t sum = crc_by_bits(sent.byte, sent.count);
    sent.byte[sent.count++] = (uint8_t)sum;
    sent.byte[sent.count++] = (uint8_t)(sum >> 8);
    if (dice(3) == 0u) {
        mutate(&sent, 0);
    }
    (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS, sent.byte, sent.count);
    const bool whole = sent.count >= 4u && sent.count <= 256u && crc_by_bits(sent.byte, sent.count) == 0u;
    const bool due = whole && sent.byte[0] == UNIT && sent.byte[1] < 0x80u;
    const bool came = hear(BRACE_SERIAL_MODBUS, &got, due ? MOST_TICKS : 50);
    silent += !came;
    if (came != due) {
        wrong(due ? "no answer" : "an answer that nobody may give", &sent, &got);
    }
    if (came && (got.byte[0] != UNIT || got.count < 4u || crc_by_bits(got.byte, got.count) != 0u)) {
        wrong("an answer with a wrong check", &sent, &got);
    }
    if (came) {
        judge(&sent, sent.byte + 1, sent.count - 3u, &got, got.byte + 1, got.count - 3u, before);
    } else if (whole && sent.byte[0] == 0u) {
        const uint8_t *pdu = sent.byte + 1;
        commits += pdu[0] == 16u && (at16(pdu + 1) == 16386u || at16(pdu + 1) == 16388u || at16(pdu + 1) == 16454u);
    }
}

/* In force is what was, unless a commit was accepted. */
static void check_parameters(unsigned long commits_before, const bytes_t *nothing)
{
    static unsigned long settled;
    if (memcmp(&in_force, &app.controller.parameters.in_force, sizeof in_force) == 0) {
        return;
    }
    if (commits == settled && commits == commits_before) {
        wrong("parameters changed without a commit", nothing, nothing);
    }
    settled = commits;
    in_force = app.controller.parameters.in_force;
}

static void start(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    bench_start(&p);
    in_force = app.controller.parameters.in_force;
    ticks(20);
}

int main(int argc, char **argv)
{
    const unsigned long requests = argc > 1 ? strtoul(argv[1], NULL, 10) : 100000ul;
    const bytes_t nothing = {.count = 0};
    chance = 0x9e3779b97f4a7c15ull ^ (argc > 2 ? strtoull(argv[2], NULL, 10) : 1ull);
    start();
    unsigned long commits_seen = 0;
    for (number = 1; number <= requests; number++) {
        const uint32_t sequence = app.controller.sequence;
        parameter_job_t *job = &app.controller.parameters;
        /* commits are 10 s apart: here that passes at once */
        job->apart_us = dice(4) == 0u ? job->apart_us : 10000000u;
        const before_t before = {app.controller.mode.now, job->has_staged, job->staged};
        if (dice(4) == 0u) {
            on_the_line(&before);
        } else {
            over_tcp(&before);
        }
        check_parameters(commits_seen, &nothing);
        commits_seen = parameter_job_is_busy(&app.controller.parameters) ? commits_seen : commits;
        while (parameter_job_is_busy(&app.controller.parameters)) {
            ticks(1);
            if (dice(3) == 0u) {
                break; /* the next request may come while a set is stored */
            }
        }
        check_parameters(commits_seen, &nothing);
        if (app.controller.sequence == sequence) {
            wrong("no snapshot since the last request", &nothing, &nothing);
        }
        if (number % 5000u == 0u) {
            start(); /* a node's own number, or a tick of another length, may have been committed */
            commits_seen = commits;
        }
    }
    printf(
        "%lu requests: %lu answered (refused: 01 %lu, 02 %lu, 03 %lu, 04 %lu, 06 %lu), %lu in silence, %lu commits\n",
        requests, answered, refused_by[1], refused_by[2], refused_by[3], refused_by[4], refused_by[6], silent, commits);
    const bool asked = questions[0] > 0u && questions[2] > 0u && questions[5] > 0u && questions[7] > 0u &&
                       questions[9] > 0u && questions[22] > 0u;
    const bool every = asked && answered > 0u && refused_by[1] > 0u && refused_by[2] > 0u && refused_by[3] > 0u &&
                       refused_by[4] > 0u && refused_by[6] > 0u && silent > 0u && commits > 0u;
    if (!every && requests >= 20000ul) {
        printf("chance never came to some of these: the test has lost its point\n");
        return 1;
    }
    return 0;
}
