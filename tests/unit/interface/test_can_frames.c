/* Every frame of CAN and CAN FD: what is packed comes back, each member has its own bits, and what a frame cannot carry
 * is counted. */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "brace/answering.h"
#include "brace/can_frames.h"
#include "frame_codecs.h"
#include "unity.h"

enum { TRIES = 100, MOST_WORDS = 32, MOST_BYTES = 64 };

/* A message's members have 32 bits each. */
typedef struct {
    const char *name;
    uint32_t bytes, words;
    void (*unpack)(const uint8_t *data, uint32_t *words);
    uint32_t (*pack)(const uint32_t *words, uint8_t *data);
} frame_t;

#define ROW(name, bytes) {#name, bytes, sizeof(brace_can_##name##_t) / 4u, unpack_##name, pack_##name},
static const frame_t frames[] = {BRACE_CAN_FRAMES(ROW)};
#undef ROW
enum { FRAMES = sizeof frames / sizeof *frames };

static uint32_t seed;

void setUp(void)
{
    seed = 1u;
}

void tearDown(void) {}

static void any_bytes(uint8_t *data, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        seed = seed * 1664525u + 1013904223u;
        data[i] = (uint8_t)(seed >> 24);
    }
}

/* Bytes and members as a sender of this frame has them: what any bytes say, said by it. At 24 bits a float rounds by up
 * to a step, so that others are tried until the same step comes back. */
static void any_message(const frame_t *frame, uint32_t *words, uint8_t *data)
{
    for (int i = 0; i < 1000; i++) {
        uint32_t back[MOST_WORDS];
        any_bytes(data, frame->bytes);
        frame->unpack(data, words);
        (void)frame->pack(words, data);
        frame->unpack(data, back);
        if (memcmp(words, back, 4u * frame->words) == 0) {
            return;
        }
    }
    TEST_FAIL_MESSAGE(frame->name);
}

static void test_what_is_packed_comes_back(void)
{
    for (uint32_t f = 0; f < FRAMES; f++) {
        const frame_t *frame = &frames[f];
        TEST_ASSERT_TRUE_MESSAGE(frame->words <= MOST_WORDS && frame->bytes <= MOST_BYTES, frame->name);
        for (uint32_t i = 0; i < TRIES; i++) {
            uint32_t words[MOST_WORDS], back[MOST_WORDS];
            uint8_t data[MOST_BYTES + 1], again[MOST_BYTES + 1];
            any_message(frame, words, data);
            memset(again, 0x5a, sizeof again);
            TEST_ASSERT_EQUAL_MESSAGE(0, frame->pack(words, again), frame->name); /* nothing was limited */
            TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(data, again, frame->bytes, frame->name);
            TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x5a, again[frame->bytes], frame->name);
            memset(back, 0x5a, sizeof back);
            frame->unpack(again, back);
            TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(words, back, frame->words, frame->name);
        }
    }
}

/* A bit changes one member or none, and every member has bits. */
static void test_each_member_has_its_own_bits(void)
{
    for (uint32_t f = 0; f < FRAMES; f++) {
        const frame_t *frame = &frames[f];
        uint32_t words[MOST_WORDS], bits[MOST_WORDS] = {0};
        uint8_t data[MOST_BYTES];
        any_message(frame, words, data);
        for (uint32_t bit = 0; bit < 8u * frame->bytes; bit++) {
            uint32_t changed[MOST_WORDS], count = 0;
            data[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
            frame->unpack(data, changed);
            data[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
            for (uint32_t word = 0; word < frame->words; word++) {
                count += changed[word] != words[word];
                bits[word] += changed[word] != words[word];
            }
            TEST_ASSERT_TRUE_MESSAGE(count <= 1u, frame->name);
        }
        for (uint32_t word = 0; word < frame->words; word++) {
            TEST_ASSERT_TRUE_MESSAGE(bits[word] > 0u && bits[word] <= 32u, frame->name);
        }
    }
}

/* A member far beyond its range, either way: counted where it does not come back, and the others stay as they are. */
static void test_what_a_frame_cannot_carry_is_counted(void)
{
    static const uint32_t far[] = {0x7149f2cau, 0xf149f2cau}; /* 1e30 and -1e30, or numbers as great */
    for (uint32_t f = 0; f < FRAMES; f++) {
        const frame_t *frame = &frames[f];
        const bool has_token = strstr(frame->name, "_request") != NULL || strstr(frame->name, "_answer_") != NULL ||
                               strcmp(frame->name, "refusal") == 0; /* of which the low bits are sent */
        for (uint32_t word = has_token ? 2u : 0u; word < 2u * frame->words; word++) {
            uint32_t words[MOST_WORDS], back[MOST_WORDS];
            uint8_t data[MOST_BYTES];
            any_message(frame, words, data);
            words[word / 2u] = far[word % 2u];
            const uint32_t limited = frame->pack(words, data);
            frame->unpack(data, back);
            const uint32_t lost = back[word / 2u] != words[word / 2u];
            TEST_ASSERT_EQUAL_MESSAGE(lost, limited, frame->name);
            back[word / 2u] = words[word / 2u];
            TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(words, back, frame->words, frame->name);
        }
    }
}

/* The byte of a frame that is sent without a member: of a request its code, of an answer its code and its part, of a
 * message in parts its part. Zeros are sent as zeros beside it. */
static const frame_t *frame_named(const char *name)
{
    for (uint32_t f = 0; f < FRAMES; f++) {
        if (strcmp(frames[f].name, name) == 0) {
            return &frames[f];
        }
    }
    return NULL;
}

static void sends_zeros(const frame_t *frame, uint32_t first, uint32_t second)
{
    uint32_t words[MOST_WORDS] = {0};
    uint8_t data[MOST_BYTES];
    TEST_ASSERT_EQUAL_MESSAGE(0, frame->pack(words, data), frame->name);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(first, data[0], frame->name);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(second, data[1], frame->name);
    for (uint32_t i = 2; i < frame->bytes; i++) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0, data[i], frame->name);
    }
}

/* The number of a frame of an answer; no number: 256. */
static uint32_t number_of(uint32_t code, uint32_t part)
{
    for (uint32_t number = 0; number < 256u; number++) {
        const brace_can_answer_frame_t *is = &brace_can_answer_frames[number];
        if (is->parts > 0u && is->code == code && is->part == part) {
            return number;
        }
    }
    return 256;
}

static void test_zeros_are_sent_behind_code_and_part(void)
{
    uint32_t requests = 0, parts = 0;
    char name[80];
#define CODE(code, request) \
    if (frame_named(#request "_request") != NULL) { \
        sends_zeros(frame_named(#request "_request"), (uint32_t)(code), 0); \
        requests++; \
    } \
    for (uint32_t part = 0; part < brace_can_answer_parts[code]; part++) { \
        (void)snprintf(name, sizeof name, #request "_answer_%u", (unsigned)part); \
        sends_zeros(frame_named(name), number_of(code, part), 0); \
        parts++; \
    }
    BRACE_REQUESTS(CODE)
#undef CODE
    TEST_ASSERT_TRUE(requests > 20u && parts > 40u);
    /* The numbers stay for good: whoever changes one changes what older logs say. */
    static const struct {
        const char *group;
        uint32_t first, count;
    } details[] = {{"space", 16, 7}, {"load", 32, 6}, {"load_across", 48, 2}, {"sigma", 64, 2}, {"sigma_space", 80, 4}};
    for (uint32_t i = 0; i < sizeof details / sizeof *details; i++) {
        for (uint32_t part = 0; part < details[i].count; part++) {
            (void)snprintf(name, sizeof name, "%s_%u", details[i].group, (unsigned)part);
            sends_zeros(frame_named(name), 0, details[i].first + part);
        }
    }
    sends_zeros(frame_named("space_fd"), 0, 16);
    sends_zeros(frame_named("load_fd"), 0, 32);
    sends_zeros(frame_named("sigma_fd"), 0, 64);
    static const char *const whole[] = {"stiffness_a", "stiffness_b", "eigenvalues", "posture",
                                        "snapshot_fd", "condition",   "emergency"};
    for (uint32_t i = 0; i < sizeof whole / sizeof *whole; i++) {
        sends_zeros(frame_named(whole[i]), 0, 0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_is_packed_comes_back);
    RUN_TEST(test_each_member_has_its_own_bits);
    RUN_TEST(test_what_a_frame_cannot_carry_is_counted);
    RUN_TEST(test_zeros_are_sent_behind_code_and_part);
    return UNITY_END();
}
