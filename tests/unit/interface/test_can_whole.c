/* Requests and answers as a whole go the way of their frames: every member says what the frame's field says. And of
 * every frame: what is packed of any values comes back, and every bit that unpacking heeds is packed. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "brace/answering.h"
#include "brace/can_frames.h"
#include "frame_codecs.h"
#include "brace/status.h"
#include "unity.h"

enum { TRIES = 200, MOST_WORDS = 20, MOST_FRAME_WORDS = 80, TOKEN = 0x5a };

/* A frame's message is its token and its fields, 32 bits each. */
typedef struct {
    const char *name;
    uint32_t bytes, words;
    void (*unpack)(const uint8_t *data, uint32_t *words);
    uint32_t (*pack)(const uint32_t *words, uint8_t *data);
} frame_t;

#define ROW(name, bytes) {#name, bytes, sizeof(brace_can_##name##_t) / 4u, unpack_##name, pack_##name},
static const frame_t frames[] = {BRACE_CAN_FRAMES(ROW)};
#undef ROW

typedef struct {
    uint32_t code;
    const char *name;
    uint32_t request_words, answer_words;
} request_t;

#define ROW(code, name) {code, #name, sizeof(brace_##name##_request_t) / 4u, sizeof(brace_##name##_answer_t) / 4u},
static const request_t requests[] = {BRACE_REQUESTS(ROW)};
#undef ROW

static uint32_t seed;

void setUp(void)
{
    seed = 1u;
}

void tearDown(void) {}

static uint8_t any_byte(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (uint8_t)(seed >> 24);
}

/* A count, a code, a value, what is not known or has no bound: as a field may be sent, whatever it is. */
static uint32_t any_value(void)
{
    const float value = ((float)any_byte() - 128.0f) * (any_byte() < 128u ? 0.37f : 0.0037f);
    const float odd[] = {value, -value, (float)NAN, (float)INFINITY, 0.0f};
    uint32_t word = (uint32_t)any_byte() << (any_byte() % 3u * 8u) | any_byte();
    const uint32_t which = any_byte() % 8u;
    if (which < 5u) {
        memcpy(&word, &odd[which], 4);
    }
    return word;
}

/* Equal, or apart by one last place of one field: a float of a 24-bit number's steps rounds. */
static bool is_nearly(const uint8_t *a, const uint8_t *b)
{
    uint64_t of_a, of_b;
    memcpy(&of_a, a, 8);
    memcpy(&of_b, b, 8);
    const uint64_t apart = of_a > of_b ? of_a - of_b : of_b - of_a;
    return (apart & (apart - 1u)) == 0u;
}

static void test_what_is_packed_of_any_values_comes_back(void)
{
    for (uint32_t f = 0; f < sizeof frames / sizeof *frames; f++) {
        for (uint32_t i = 0; i < 4u * TRIES; i++) {
            uint32_t words[MOST_FRAME_WORDS] = {0}, back[MOST_FRAME_WORDS] = {0};
            uint8_t data[64] = {0}, again[64] = {0};
            TEST_ASSERT_TRUE(frames[f].words <= MOST_FRAME_WORDS);
            for (uint32_t w = 0; w < frames[f].words; w++) {
                words[w] = any_value();
            }
            (void)frames[f].pack(words, data);
            frames[f].unpack(data, back);
            (void)frames[f].pack(back, again);
            for (uint32_t at = 0; at < sizeof data; at += 8u) {
                TEST_ASSERT_TRUE_MESSAGE(is_nearly(data + at, again + at), frames[f].name);
            }
        }
    }
}

static void test_every_bit_that_unpacking_heeds_is_packed(void)
{
    for (uint32_t f = 0; f < sizeof frames / sizeof *frames; f++) {
        uint8_t any[64], first[64] = {0}, other[64] = {0};
        uint32_t words[MOST_FRAME_WORDS], of_other[MOST_FRAME_WORDS];
        memset(any, 0x11, sizeof any); /* small numbers: nothing is limited */
        memset(words, 0, sizeof words);
        memset(of_other, 0, sizeof of_other);
        frames[f].unpack(any, words);
        (void)frames[f].pack(words, first);
        for (uint32_t bit = 0; bit < 8u * frames[f].bytes; bit++) {
            any[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
            frames[f].unpack(any, of_other);
            any[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
            if (memcmp(words, of_other, 4u * frames[f].words) != 0) {
                (void)frames[f].pack(of_other, other);
                TEST_ASSERT_TRUE_MESSAGE(((first[bit / 8u] ^ other[bit / 8u]) >> bit % 8u & 1u) != 0u, frames[f].name);
            }
        }
    }
}

static const frame_t *frame_named(const char *name)
{
    for (uint32_t f = 0; f < sizeof frames / sizeof *frames; f++) {
        if (strcmp(frames[f].name, name) == 0) {
            return &frames[f];
        }
    }
    return NULL;
}

static const frame_t *part_of(const request_t *request, uint32_t part)
{
    char name[80];
    (void)snprintf(name, sizeof name, "%s_answer_%u", request->name, (unsigned)part);
    return frame_named(name);
}

static void test_a_request_has_what_its_frame_says(void)
{
    uint32_t with_fields = 0;
    for (uint32_t r = 0; r < sizeof requests / sizeof *requests; r++) {
        char name[80];
        (void)snprintf(name, sizeof name, "%s_request", requests[r].name);
        const frame_t *frame = frame_named(name);
        if (frame == NULL || frame->words == 1u) { /* it asks without a field */
            continue;
        }
        with_fields++;
        for (uint32_t i = 0; i < TRIES; i++) {
            uint32_t words[MOST_WORDS];
            uint8_t data[8] = {(uint8_t)requests[r].code, TOKEN};
            brace_request_t asked;
            for (uint32_t byte = 2; byte < 8u; byte++) {
                data[byte] = any_byte();
            }
            frame->unpack(data, words);
            brace_can_unpack_request(data, &asked);
            TEST_ASSERT_EQUAL_MESSAGE(frame->words - 1u, requests[r].request_words, name);
            TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(words + 1, asked.word, frame->words - 1u, name);
        }
    }
    TEST_ASSERT_GREATER_THAN(15, with_fields);
}

/* What a frame can carry comes from frames of any bytes; all of an answer's parts give all of its members. */
static void test_an_answer_says_what_its_frames_say(void)
{
    for (uint32_t r = 0; r < sizeof requests / sizeof *requests; r++) {
        const uint32_t code = requests[r].code, parts = brace_can_answer_parts[code];
        for (uint32_t i = 0; i < TRIES; i++) {
            brace_answer_t answer;
            uint8_t wanted[BRACE_CAN_ANSWER_PARTS_MOST][8], packed[BRACE_CAN_ANSWER_PARTS_MOST][8];
            uint32_t count = 0;
            memset(&answer, 0, sizeof answer);
            for (uint32_t part = 0; part < parts; part++) {
                const frame_t *frame = part_of(&requests[r], part);
                uint32_t words[MOST_WORDS] = {TOKEN};
                TEST_ASSERT_NOT_NULL_MESSAGE(frame, requests[r].name);
                if (frame->words > 1u) {
                    uint8_t any[8];
                    for (uint32_t byte = 0; byte < 8u; byte++) {
                        any[byte] = any_byte();
                    }
                    any[1] = TOKEN;
                    frame->unpack(any, words);
                    memcpy(answer.word + count, words + 1, 4u * (frame->words - 1u));
                    count += frame->words - 1u;
                }
                (void)frame->pack(words, wanted[part]);
            }
            brace_can_pack_answer(code, &answer, TOKEN, packed);
            TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(wanted, packed, 8u * parts, requests[r].name);
            TEST_ASSERT_TRUE_MESSAGE(count == requests[r].answer_words || count == 0u, requests[r].name);
        }
    }
}

/* Each number that an answer with flags carries, far beyond its range: SATURATED, and nothing else in the flags. */
static void test_a_value_beyond_its_range_is_flagged(void)
{
    static const float far = 1e9f;
    brace_k_under_load_at_posture_answer_t k = {.flags = 0};
    for (uint32_t member = 0; member < 7u; member++) {
        brace_answer_t answer;
        uint8_t packed[BRACE_CAN_ANSWER_PARTS_MOST][8];
        memset(&answer, 0, sizeof answer);
        k.buckling_factor = 5.0f;
        answer.k_under_load_at_posture = k;
        memcpy(answer.word + member, &far, 4);
        brace_can_pack_answer(BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, &answer, TOKEN, packed);
        brace_can_k_under_load_at_posture_answer_4_t last;
        brace_can_unpack_k_under_load_at_posture_answer_4(packed[4], &last);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(BRACE_FLAG_SATURATED, last.flags, "flags");
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_is_packed_of_any_values_comes_back);
    RUN_TEST(test_every_bit_that_unpacking_heeds_is_packed);
    RUN_TEST(test_a_request_has_what_its_frame_says);
    RUN_TEST(test_an_answer_says_what_its_frames_say);
    RUN_TEST(test_a_value_beyond_its_range_is_flagged);
    return UNITY_END();
}
