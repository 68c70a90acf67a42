/* upload_fuzz [REQUESTS [SEED]]: parameter blocks uploaded over CAN, word by word, mostly with something wrong on the
 * way: words lost, repeated, changed, out of order; a begin, a read, a roll-back or a commit in between; CONFIGURATION
 * left or let time out; the power cut; blocks that are sealed and still no good. It fails when
 *   a request is answered otherwise than the protocol page has it, or not at all
 *   a block is put in force that is not the one announced, whole, in order, of this dictionary and in range
 *   an undisturbed upload of a good one is refused, or something else than its words is in force
 * The upload is followed by a model of its own, with a CRC of its own. Exit code 0 and one line when all is well. */
#include "brace/can_messages.h"
#include "fuzz.h"

enum { NODE = 5, WORDS = BRACE_BLOCK_BYTES / 4, HEADER = 5, STORE_TICKS = 4000, SILENCE_TICKS = 10100 };
enum { READ = 1, SET_MODE = 9, BEGIN = 10, WORD = 11, COMMIT = 12, ROLLBACK = 13 };
enum {
    BLOCK_GOOD,
    BLOCK_NOT_FINITE,
    BLOCK_OUT_OF_RANGE,
    BLOCK_OTHER_SCHEMA,
    BLOCK_OTHER_HEADER,
    BLOCK_BAD_CRC,
    BLOCK_KINDS
};

static struct {
    bool open;
    uint32_t next, announced, word[WORDS];
} model; /* of the upload, as the protocol page has it */

static uint32_t block[WORDS], kind;
static brace_parameters_t in_force;
static uint8_t got[8][8];
static uint32_t got_count;
static uint32_t begun, words, taken, refused[BLOCK_KINDS], broken, silences, cuts;

/* CRC-32 of IEEE 802.3, bit by bit. */
static uint32_t crc_of(const uint32_t *word, uint32_t count)
{
    uint32_t sum = 0xffffffffu;
    for (uint32_t i = 0; i < 4u * count; i++) {
        sum ^= word[i / 4u] >> 8u * (i % 4u) & 0xffu;
        for (int bit = 0; bit < 8; bit++) {
            sum = (sum & 1u) != 0u ? sum >> 1 ^ 0xedb88320u : sum >> 1;
        }
    }
    return ~sum;
}

static void put(uint8_t *data, uint32_t byte, uint32_t bytes, uint32_t value)
{
    for (uint32_t i = 0; i < bytes; i++) {
        data[byte + i] = (uint8_t)(value >> (8u * i));
    }
}

static uint32_t field(const uint8_t *data, uint32_t byte, uint32_t bytes)
{
    uint32_t value = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        value |= (uint32_t)data[byte + i] << (8u * i);
    }
    return value;
}

static void new_block(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.femur_mm = 100.0f + 0.01f * (float)dice(10000);
    p.limb.link[BRACE_TIBIA].bending_mm_per_n = 0.05f + 1e-5f * (float)dice(10000);
    p.sensor.noise_n = 1e-4f * (float)dice(1000);
    p.slow.joint_compliance_per_degc = 1e-6f * (float)dice(1000);
    kind = dice(2) == 0u ? (uint32_t)BLOCK_GOOD : dice(BLOCK_KINDS);
    if (kind == BLOCK_NOT_FINITE) {
        float *const place[] = {&p.limb.femur_mm, &p.limb.joint[0].compliance_rad_per_n_mm, &p.drive[1].angle_max_rad,
                                &p.sensor.gain, &p.gravity.tibia_n};
        *place[dice(5)] = dice(2) == 0u ? (float)NAN : (float)INFINITY;
    } else if (kind == BLOCK_OUT_OF_RANGE) {
        *(dice(2) == 0u ? &p.limb.tibia_mm : &p.limb.link[0].axial_mm_per_n) = -1.0f;
    }
    block[0] = 0x45435242u; /* BRCE */
    block[1] = BRACE_BLOCK_FORMAT | (uint32_t)BRACE_BLOCK_HEADER_BYTES << 16;
    block[2] = BRACE_SCHEMA_HASH ^ (kind == BLOCK_OTHER_SCHEMA ? 1u << dice(32) : 0u);
    block[3] = (uint32_t)sizeof p;
    block[4] = dice(1000);
    memcpy(&block[HEADER], &p, sizeof p);
    if (kind == BLOCK_OTHER_HEADER) {
        static const uint8_t checked[] = {0, 1, 3};
        block[checked[dice(3)]] ^= 1u << dice(32);
    }
    block[WORDS - 1] = crc_of(block, WORDS - 1) ^ (kind == BLOCK_BAD_CRC ? 1u << dice(32) : 0u);
}

/* ------------------------------------------------------------------------------------------------- the bus -- */

static void take_frames(const uint8_t *request)
{
    brace_can_frame_t frame;
    while (brace_fake_frame_take(&fake, &frame)) {
        if (frame.id == 0x580u + NODE) {
            if (got_count == 8u || frame.length != 8u) {
                fail("too many answers", request, 8);
            }
            memcpy(got[got_count++], frame.data, 8);
        }
    }
}

static void unchanged(const uint8_t *request)
{
    if (memcmp(&in_force, &app.controller.parameters.in_force, sizeof in_force) != 0) {
        fail("parameters changed without an accepted commit", request, 8);
    }
}

/* Asks, waits for the answer. */
static void ask(const uint8_t data[8])
{
    brace_can_frame_t frame = {.id = 0x600u + NODE, .length = 8};
    memcpy(frame.data, data, 8);
    got_count = 0;
    fed++;
    (void)brace_fake_frame_arrives(&fake, &frame);
    const bool stores = data[0] == COMMIT || data[0] == ROLLBACK;
    const uint32_t patience = stores ? (uint32_t)STORE_TICKS : 10u;
    /* what nobody may do while a set is stored */
    const uint32_t meddles = stores && dice(4) == 0u ? 1u + dice(20) : 0u;
    for (uint32_t i = 0; i < patience && got_count == 0u; i++) {
        if (!stores) {
            unchanged(data);
        }
        if (i > 0u && i == meddles) {
            (void)brace_fake_frame_arrives(
                &fake, &(brace_can_frame_t){.id = 0x600u + NODE, .length = 8, .data = {BEGIN, 0xfe, 3, 0, 1, 2, 3, 4}});
        }
        ticks(1);
        take_frames(data);
        if (got_count > 0u && got[0][1] == 0xfeu && data[1] != 0xfeu) {
            if (got[0][0] != BRACE_ANSWER_REFUSED || got[0][2] != BEGIN) {
                fail("a begin of three bytes was taken", data, 8);
            }
            got_count--; /* in the same tick there may be the answer that is waited for */
            memmove(got[0], got[1], sizeof got[0] * got_count);
        }
    }
    if (got_count == 0u) {
        fail("no answer", data, 8);
    }
    ticks(1);
    take_frames(data);
}

static bool ok(const uint8_t *data)
{
    const bool is_refusal = got[0][0] == BRACE_ANSWER_REFUSED;
    if (got[0][1] != data[1] || (is_refusal ? got[0][2] : brace_can_answer_frames[got[0][0]].code) != data[0]) {
        fail("another request's answer", data, 8);
    }
    return !is_refusal;
}

/* ---------------------------------------------------------------------------------------------- the judge -- */

static void judge_begin(const uint8_t *data, bool may)
{
    const bool right = may && field(data, 2, 2) == (uint32_t)BRACE_BLOCK_BYTES;
    if (ok(data) != right) {
        fail(right ? "a begin was refused" : "a begin was taken", data, 8);
    }
    if (right) {
        model.open = true, model.next = 0, model.announced = field(data, 4, 4);
        begun++;
    }
}

static void judge_word(const uint8_t *data, bool may)
{
    const uint32_t word = field(data, 2, 2);
    const bool right = may && model.open && word < (uint32_t)WORDS && (word == model.next || word + 1u == model.next);
    if (ok(data) != right) {
        fail(right ? "a word was refused" : "a word out of order was taken", data, 8);
    }
    if (right) {
        model.word[word] = field(data, 4, 4), model.next = word + 1u;
        words++;
        if (memcmp(got[0] + 2, data + 2, 6) != 0) {
            fail("a word was read back otherwise", data, 8);
        }
    }
}

static void judge_commit(const uint8_t *data, bool may)
{
    const uint32_t crc = field(data, 2, 4);
    const bool whole = may && model.open && model.next == (uint32_t)WORDS;
    const bool sealed =
        whole && crc == model.announced && crc == model.word[WORDS - 1] && crc == crc_of(model.word, WORDS - 1);
    const bool right = sealed && kind == BLOCK_GOOD && memcmp(model.word, block, sizeof block) == 0;
    if (ok(data) != right) {
        fail(right ? "a good block was refused" : "a block that is none was taken", data, 8);
    }
    model.open = model.open && !whole;
    if (!right) {
        unchanged(data);
        refused[kind] += whole && memcmp(model.word, block, sizeof block) == 0;
        broken += whole && memcmp(model.word, block, sizeof block) != 0;
        return;
    }
    if (memcmp(&app.controller.parameters.in_force, &model.word[HEADER], sizeof in_force) != 0) {
        fail("another set is in force", data, 8);
    }
    if (got_count != 2u || field(got[1], 2, 4) != app.controller.parameters.crc) {
        fail("another CRC was reported", data, 8);
    }
    in_force = app.controller.parameters.in_force;
    taken++;
}

static void send(const uint8_t data[8])
{
    const bool may = app.controller.mode.now == BRACE_MODE_CONFIGURATION;
    app.controller.parameters.apart_us = 10000000u; /* commits are 10 s apart: here that passes at once */
    ask(data);
    switch (data[0]) {
    case BEGIN: judge_begin(data, may); break;
    case WORD: judge_word(data, may); break;
    case COMMIT: judge_commit(data, may); break;
    case ROLLBACK:
        if (!may && ok(data)) {
            fail("rolled back outside CONFIGURATION", data, 8);
        }
        in_force = app.controller.parameters.in_force;
        break;
    default: unchanged(data);
    }
    model.open = model.open && app.controller.mode.now == BRACE_MODE_CONFIGURATION;
}

/* ------------------------------------------------------------------------------------------------ requests -- */

static void say(uint32_t code, uint32_t from, uint32_t bytes, uint32_t value)
{
    uint8_t data[8] = {(uint8_t)code, (uint8_t)dice(250)};
    put(data, from, bytes, value);
    if (code == SET_MODE) {
        put(data, 3, 2, 0xc0de);
    }
    send(data);
}

static void say_begin(void)
{
    uint8_t data[8] = {BEGIN, (uint8_t)dice(250)};
    put(data, 2, 2, BRACE_BLOCK_BYTES);
    put(data, 4, 4, block[WORDS - 1] ^ (dice(40) == 0u ? 1u << dice(32) : 0u)); /* now and then another is announced */
    send(data);
}

static void say_word(uint32_t word, uint32_t value)
{
    uint8_t data[8] = {WORD, (uint8_t)dice(250)};
    put(data, 2, 2, word);
    put(data, 4, 4, value);
    send(data);
}

static void cut_power(void)
{
    cuts++;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(20);
    brace_can_frame_t frame;
    while (brace_fake_frame_take(&fake, &frame)) {
    }
    model.open = false;
    unchanged((const uint8_t[8]){0});
}

/* Something that does not belong there. Gives the word at which the sender goes on. */
static uint32_t disturb(uint32_t at)
{
    uint8_t data[8] = {WORD, (uint8_t)dice(250)};
    switch (dice(13)) {
    case 0: return at + 1u; /* a word is lost */
    case 1: say_word(at > 0u ? at - 1u : 0u, block[at > 0u ? at - 1u : 0u]); return at; /* one comes twice */
    case 2: say_word(at > 0u ? at - 1u : 0u, dice(0x10000)); return at; /* and not the same */
    case 3: say_word(at, block[at] ^ 1u << dice(32)); return at + 1u;
    case 4: say_word(dice(2) == 0u ? dice(WORDS + 3) : dice(65536), block[at]); return at;
    case 5: say_begin(); return dice(2) == 0u ? 0u : at;
    case 6: say(READ, 2, 2, dice(100)); return at;
    case 7: say(COMMIT, 2, 4, block[WORDS - 1]); return at;
    case 8: say(ROLLBACK, 2, 4, 0); return at;
    case 9: say(SET_MODE, 2, 1, BRACE_MODE_MONITOR); return at;
    case 10:
        if (dice(8) == 0u) {
            cut_power();
        }
        return at;
    case 11:
        if (dice(16) == 0u) { /* the sender has died: CONFIGURATION ends by itself */
            silences++;
            ticks(SILENCE_TICKS);
            take_frames(data);
            if (app.controller.mode.now == BRACE_MODE_CONFIGURATION) {
                fail("CONFIGURATION does not end", data, 8);
            }
            model.open = false;
            unchanged(data);
        }
        return at;
    default: /* a request of the three, noise behind its code */
        data[0] = (uint8_t)(BEGIN + dice(2));
        for (int i = 2; i < 8; i++) {
            data[i] = (uint8_t)dice(256);
        }
        send(data);
        return at;
    }
}

static void push(void)
{
    const uint32_t one_in = dice(3) == 0u ? 0u : 1u << (1u + dice(9)); /* 0: nothing goes wrong */
    new_block();
    if (app.controller.mode.now != BRACE_MODE_CONFIGURATION && dice(20) != 0u) {
        say(SET_MODE, 2, 1, BRACE_MODE_CONFIGURATION);
    }
    say_begin();
    for (uint32_t at = 0; at < (uint32_t)WORDS;) {
        if (one_in > 0u && dice(one_in) == 0u) {
            at = disturb(at);
        } else {
            say_word(at, block[at]);
            at++;
        }
        if (one_in == 2u && dice(40) == 0u) {
            break; /* given up */
        }
    }
    say(COMMIT, 2, 4, dice(50) == 0u ? 1u + dice(65536) : block[WORDS - 1]);
    if (dice(4) == 0u) {
        say(COMMIT, 2, 4, block[WORDS - 1]); /* once more: nothing is open any longer */
    }
}

static void start(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
    ticks(30);
    brace_can_frame_t frame;
    while (brace_fake_frame_take(&fake, &frame)) {
    }
    in_force = app.controller.parameters.in_force;
    model.open = false;
}

int main(int count, char **arguments)
{
    const unsigned long wanted = count > 1 ? strtoul(arguments[1], NULL, 10) : 1000000ul;
    fuzz_seed(count > 2 ? arguments[2] : NULL);
    start();
    while (fed < wanted) {
        push();
    }
    printf("%lu requests: %u uploads begun, %u words, %u put in force, %u broken ones refused; whole ones refused:",
           fed, begun, words, taken, broken);
    bool every = taken > 0u && broken > 0u && silences > 0u && cuts > 0u;
    for (uint32_t i = BLOCK_NOT_FINITE; i < BLOCK_KINDS; i++) {
        printf(" %u", refused[i]);
        every = every && refused[i] > 0u;
    }
    printf(" by kind; %u silences, %u restarts\n", silences, cuts);
    return wanted < 100000u || every ? 0 : 1;
}
