/* Every frame that the dictionary makes: what is packed is what was unpacked, whichever bit is set, and no field
 * reaches into another. */
#include <stdbool.h>
#include <string.h>

#include "brace/answering.h"
#include "brace/can_frames.h"
#include "brace/can_snapshot.h"
#include "unity.h"

enum { MOST_BYTES = 64 };

/* Packs what a frame says, unpacks that, and packs it again: the same. */
#define ROUND(name, bytes) \
    static void round_##name(const uint8_t *any, uint8_t *first, uint8_t *again) \
    { \
        brace_can_##name##_t message; \
        memset(&message, 0, sizeof message); \
        brace_can_unpack_##name(any, &message); \
        (void)brace_can_pack_##name(&message, first); \
        memset(&message, 0xa5, sizeof message); \
        brace_can_unpack_##name(first, &message); \
        (void)brace_can_pack_##name(&message, again); \
    }
BRACE_CAN_FRAMES(ROUND)
#undef ROUND

typedef struct {
    const char *name;
    uint32_t bytes;
    void (*round)(const uint8_t *any, uint8_t *first, uint8_t *again);
} frame_t;

#define ROW(name, bytes) {#name, bytes, round_##name},
static const frame_t frames[] = {BRACE_CAN_FRAMES(ROW)};
#undef ROW
enum { FRAMES = sizeof frames / sizeof *frames };

void setUp(void) {}

void tearDown(void) {}

static void test_what_a_frame_says_is_packed_as_it_was(void)
{
    for (uint32_t f = 0; f < (uint32_t)FRAMES; f++) {
        for (uint32_t bit = 0; bit < 8u * frames[f].bytes; bit++) {
            uint8_t any[MOST_BYTES] = {0}, first[MOST_BYTES] = {0}, again[MOST_BYTES] = {0};
            any[bit / 8u] = (uint8_t)(1u << bit % 8u);
            frames[f].round(any, first, again);
            TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(first, again, frames[f].bytes, frames[f].name);
        }
    }
}

/* Bits of a frame that do not come back are reserved ones, which are 0, and the codes that lead it. Each other bit is
 * some field's, so that no two fields can lie on one another unseen. */
static void test_a_bit_that_changes_changes_one_field_alone(void)
{
    for (uint32_t f = 0; f < (uint32_t)FRAMES; f++) {
        uint8_t any[MOST_BYTES], first[MOST_BYTES] = {0}, other[MOST_BYTES] = {0}, ignored[MOST_BYTES];
        for (uint32_t i = 0; i < frames[f].bytes; i++) {
            any[i] = 0x11u; /* small numbers: nothing is limited */
        }
        frames[f].round(any, first, ignored);
        uint32_t carried = 0;
        for (uint32_t bit = 0; bit < 8u * frames[f].bytes; bit++) {
            any[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
            frames[f].round(any, other, ignored);
            any[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
            const bool shows = memcmp(first, other, frames[f].bytes) != 0;
            const bool shows_there = ((first[bit / 8u] ^ other[bit / 8u]) >> bit % 8u & 1u) != 0u;
            TEST_ASSERT_TRUE_MESSAGE(!shows || shows_there, frames[f].name);
            carried += shows;
        }
        TEST_ASSERT_GREATER_THAN_MESSAGE(0, carried, frames[f].name);
    }
}

/* A request that is unpacked and an answer that is packed as a whole go the same way as their frames. */
static void test_every_request_is_unpacked_and_every_answer_packed(void)
{
    for (uint32_t code = 0; code < 256u; code++) {
        uint8_t data[8] = {(uint8_t)code, 0x5a, 1, 0, 0, 0, 0, 0}, parts[8][8];
        brace_request_t asked;
        brace_answer_t answer;
        memset(&asked, 0, sizeof asked);
        memset(&answer, 0, sizeof answer);
        memset(parts, 0xee, sizeof parts);
        brace_can_unpack_request(data, &asked);
        brace_can_pack_answer(code, &answer, 0x5au, parts);
        for (uint32_t part = 0; part < 8u; part++) {
            const bool there = part < brace_can_answer_parts[code];
            const brace_can_answer_frame_t *is = &brace_can_answer_frames[parts[part][0]];
            TEST_ASSERT_EQUAL(there ? code : is->code, is->code);
            TEST_ASSERT_EQUAL(there ? part : is->part, is->part);
            TEST_ASSERT_EQUAL(there ? brace_can_answer_parts[code] : is->parts, is->parts);
            TEST_ASSERT_EQUAL(there, parts[part][0] != 0xeeu);
            TEST_ASSERT_EQUAL_HEX8(there ? 0x5au : 0xeeu, parts[part][1]);
        }
    }
}

static void test_a_part_says_which_it_is(void)
{
    for (uint32_t part = 0; part < 256u; part++) {
        const uint8_t data[8] = {9, (uint8_t)part, 7, 7, 7, 7, 7, 7};
        TEST_ASSERT_EQUAL(part, brace_can_details_part(data));
        TEST_ASSERT_EQUAL(part, brace_can_details_fd_part(data));
    }
}

/* A snapshot as frames: every measured message is made of the values that it is named after. */
static void test_every_measured_frame_is_made_of_its_values(void)
{
    brace_measured_t measured, other;
    memset(&measured, 0, sizeof measured);
    memset(&other, 0, sizeof other);
    for (uint32_t i = 0; i < sizeof other / 4u; i++) {
        const float one = 1.0f;
        memcpy((uint8_t *)&other + 4u * i, &one, 4);
    }
    other.sequence = 7;
#define MADE(ID, name, rate, coxa) \
    { \
        uint8_t of_zeros[MOST_BYTES] = {0}, of_ones[MOST_BYTES] = {0}; \
        brace_can_make_##name(&measured, 0.0f, of_zeros); \
        brace_can_make_##name(&other, 20.0f, of_ones); \
        TEST_ASSERT_NOT_EQUAL_MESSAGE(0, memcmp(of_zeros, of_ones, MOST_BYTES), #name); \
    }
    BRACE_CAN_PROCESS(MADE)
    BRACE_CAN_PROCESS_FD(MADE)
#undef MADE
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_a_frame_says_is_packed_as_it_was);
    RUN_TEST(test_a_bit_that_changes_changes_one_field_alone);
    RUN_TEST(test_every_request_is_unpacked_and_every_answer_packed);
    RUN_TEST(test_a_part_says_which_it_is);
    RUN_TEST(test_every_measured_frame_is_made_of_its_values);
    return UNITY_END();
}
