/* Somebody on the other end of the fake board's CAN bus: asks, and collects what comes back. */
#ifndef CAN_BENCH_H
#define CAN_BENCH_H

#include <string.h>

#include "answer_frames.h"
#include "app_bench.h"
#include "brace/can_messages.h"
#include "brace/measured.h"
#include "brace/refusals.h"

/* A K that is asked for: taken in one tick, worked out in the next, answered in the third. */
enum { NODE = 5, PATIENCE_TICKS = 14, K_TICKS = 4 };

/* Whoever asks here has this number: the upper bits of its tokens. */
static const brace_who_t can_master = {BRACE_ASKER_CAN, 0};

static inline void begin_to_live(void)
{
    living_master = &can_master;
}

/* The frames of one answer. */
typedef struct {
    int count;
    uint8_t part[BRACE_CAN_ANSWER_PARTS_MOST][8];
} answer_t;

static inline void drain(void)
{
    brace_can_frame_t frame;
    while (brace_fake_frame_take(&fake, &frame)) {
    }
}

static inline void arrives(uint32_t id, const uint8_t *data, uint8_t length)
{
    brace_can_frame_t frame = {.id = id, .length = length};
    memcpy(frame.data, data, length);
    TEST_ASSERT_TRUE(brace_fake_frame_arrives(&fake, &frame));
}

static inline void collect(answer_t *answer)
{
    brace_can_frame_t frame;
    while (brace_fake_frame_take(&fake, &frame)) {
        if (frame.id == 0x580u + NODE) {
            TEST_ASSERT_EQUAL(8, frame.length);
            TEST_ASSERT_TRUE(answer->count < BRACE_CAN_ANSWER_PARTS_MOST);
            memcpy(answer->part[answer->count++], frame.data, 8);
        }
    }
}

/* What comes back within so many ticks, until something does. */
static inline answer_t ask_within(const uint8_t data[8], int count)
{
    answer_t answer = {0};
    arrives(0x600u + NODE, data, 8);
    for (int i = 0; i < count && answer.count == 0; i++) {
        ticks(1);
        collect(&answer);
    }
    return answer;
}

static inline answer_t ask(const uint8_t data[8])
{
    return ask_within(data, PATIENCE_TICKS);
}

static inline brace_can_refusal_t refusal_of(const answer_t *answer, uint32_t code)
{
    brace_can_refusal_t refusal = {0};
    TEST_ASSERT_EQUAL(1, answer->count);
    TEST_ASSERT_EQUAL_HEX8(BRACE_ANSWER_REFUSED, answer->part[0][0]);
    brace_can_unpack_refusal(answer->part[0], &refusal);
    TEST_ASSERT_EQUAL(code, refusal.code);
    return refusal;
}

static inline answer_t set_mode(uint32_t mode)
{
    uint8_t data[8];
    brace_can_pack_set_mode_request(&(brace_can_set_mode_request_t){7, mode, 0xc0de}, data);
    return ask(data);
}

static inline uint32_t read_entry(uint32_t index)
{
    uint8_t data[8];
    brace_can_read_entry_answer_0_t read;
    brace_can_pack_read_entry_request(&(brace_can_read_entry_request_t){9, index}, data);
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(1, answer.count);
    TEST_ASSERT_EQUAL_HEX8(BRACE_READ_ENTRY_ANSWER_0, answer.part[0][0]);
    brace_can_unpack_read_entry_answer_0(answer.part[0], &read);
    TEST_ASSERT_EQUAL(index, read.index);
    TEST_ASSERT_EQUAL(9, read.token);
    return read.value;
}

/* The request number `step` of pushing a block: begin, words, commit. */
enum { PUSH_STEPS = BRACE_BLOCK_BYTES / 4 + 2 };
static inline void push_request(const uint8_t block[BRACE_BLOCK_BYTES], int step, uint8_t data[8])
{
    uint32_t crc, word;
    memcpy(&crc, &block[BRACE_BLOCK_BYTES - 4], 4);
    if (step == 0) {
        brace_can_pack_upload_begin_request(&(brace_can_upload_begin_request_t){1, BRACE_BLOCK_BYTES, crc}, data);
    } else if (step < PUSH_STEPS - 1) {
        memcpy(&word, &block[4 * (step - 1)], 4);
        brace_can_pack_upload_word_request(
            &(brace_can_upload_word_request_t){(uint32_t)step & 0xffu, (uint32_t)step - 1u, word}, data);
    } else {
        brace_can_pack_commit_request(&(brace_can_commit_request_t){3, crc}, data);
    }
}

#endif
