/* A Modbus master on the fake board's ports, in the test's own arithmetic: CRC bit by bit, frames by hand. */
#ifndef MODBUS_MASTER_H
#define MODBUS_MASTER_H

#include <string.h>

#include "app_bench.h"
#include "brace/can_messages.h"
#include "modbus_crc.h"

enum { UNIT = 17, ANSWER_TICKS = 200 };

typedef struct {
    uint8_t byte[260];
    uint32_t count; /* 0: no answer */
} reply_t;

/* A controller that is the unit UNIT, past its start. */
static inline void start_unit(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    bench_start(&p);
    ticks(20);
}

/* As a register pair holds it. */
static inline uint32_t bits(float value)
{
    uint32_t word;
    memcpy(&word, &value, 4);
    return word;
}

static inline void line_says(const uint8_t *bytes, uint32_t count)
{
    TEST_ASSERT_EQUAL(count, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS, bytes, count));
}

/* What the controller says on a port until it has been silent for `ticks_silent` after something. */
static inline reply_t heard(brace_serial_port_t port)
{
    reply_t reply = {.count = 0};
    for (int i = 0, silent = 0; i < ANSWER_TICKS && silent < 5; i++) {
        ticks(1);
        const uint32_t got =
            brace_fake_bytes_take(&fake, port, reply.byte + reply.count, (uint32_t)sizeof reply.byte - reply.count);
        reply.count += got;
        silent = reply.count > 0u && got == 0u ? silent + 1 : 0;
    }
    return reply;
}

/* The answer's PDU to a request's on the line; its frame is checked. */
static inline reply_t line_asks(uint8_t unit, const uint8_t *pdu, uint32_t count)
{
    uint8_t frame[300];
    frame[0] = unit;
    memcpy(frame + 1, pdu, count);
    const uint32_t crc = crc_by_bits(frame, count + 1u);
    frame[count + 1u] = (uint8_t)crc;
    frame[count + 2u] = (uint8_t)(crc >> 8);
    line_says(frame, count + 3u);
    reply_t reply = heard(BRACE_SERIAL_MODBUS);
    if (reply.count > 0u) {
        TEST_ASSERT_GREATER_THAN(3, reply.count);
        TEST_ASSERT_EQUAL_HEX8(unit, reply.byte[0]);
        TEST_ASSERT_EQUAL_HEX16(0, crc_by_bits(reply.byte, reply.count));
        reply.count -= 3u;
        memmove(reply.byte, reply.byte + 1, reply.count);
    }
    return reply;
}

/* The same over TCP. */
static inline reply_t tcp_asks(uint8_t unit, const uint8_t *pdu, uint32_t count)
{
    static uint8_t transaction;
    transaction++;
    uint8_t adu[300] = {0xab, transaction, 0, 0, (uint8_t)((count + 1u) >> 8), (uint8_t)(count + 1u), unit};
    memcpy(adu + 7, pdu, count);
    TEST_ASSERT_EQUAL(count + 7u, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, adu, count + 7u));
    reply_t reply = heard(BRACE_SERIAL_MODBUS_TCP);
    if (reply.count > 0u) {
        TEST_ASSERT_GREATER_THAN(8, reply.count);
        TEST_ASSERT_EQUAL_HEX8(0xab, reply.byte[0]);
        TEST_ASSERT_EQUAL_HEX8(transaction, reply.byte[1]);
        TEST_ASSERT_EQUAL(0, reply.byte[2] | reply.byte[3]);
        TEST_ASSERT_EQUAL(reply.count - 6u, reply.byte[4] << 8 | reply.byte[5]);
        TEST_ASSERT_EQUAL_HEX8(unit, reply.byte[6]);
        reply.count -= 7u;
        memmove(reply.byte, reply.byte + 7, reply.count);
    }
    return reply;
}

static inline reply_t read_asks(uint8_t function, uint32_t start, uint32_t count)
{
    const uint8_t pdu[] = {function, (uint8_t)(start >> 8), (uint8_t)start, (uint8_t)(count >> 8), (uint8_t)count};
    return line_asks(UNIT, pdu, sizeof pdu);
}

static inline reply_t write_one(uint32_t start, uint32_t value)
{
    const uint8_t pdu[] = {6, (uint8_t)(start >> 8), (uint8_t)start, (uint8_t)(value >> 8), (uint8_t)value};
    return line_asks(UNIT, pdu, sizeof pdu);
}

/* Function 16 with whole values. */
static inline reply_t write_values(uint32_t start, const uint32_t *values, uint32_t count)
{
    uint8_t pdu[260] = {16, (uint8_t)(start >> 8), (uint8_t)start, 0, (uint8_t)(2u * count), (uint8_t)(4u * count)};
    for (uint32_t i = 0; i < 4u * count; i++) {
        pdu[6u + i] = (uint8_t)(values[i / 4u] >> (24u - 8u * (i % 4u)));
    }
    return line_asks(UNIT, pdu, 6u + 4u * count);
}

static inline reply_t write_value(uint32_t start, uint32_t value)
{
    return write_values(start, &value, 1);
}

static inline uint32_t value_at(const reply_t *reply, uint32_t index)
{
    const uint8_t *b = reply->byte + 2u + 4u * index;
    TEST_ASSERT_GREATER_OR_EQUAL(6u + 4u * index, reply->count);
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

static inline float float_at(const reply_t *reply, uint32_t index)
{
    const uint32_t word = value_at(reply, index);
    float value;
    memcpy(&value, &word, 4);
    return value;
}

static inline void refused(reply_t reply, uint8_t function, uint8_t code)
{
    TEST_ASSERT_EQUAL(2, reply.count);
    TEST_ASSERT_EQUAL_HEX8(function | 0x80, reply.byte[0]);
    TEST_ASSERT_EQUAL_HEX8(code, reply.byte[1]);
}

#endif
