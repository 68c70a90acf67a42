/* Bytes between an interrupt handler and the thread: one side writes, the other reads, and neither waits. */
#ifndef STM32F405_BYTE_RING_H
#define STM32F405_BYTE_RING_H

#include "processor.h"

enum { BYTE_RING_BYTES = 512 }; /* a power of two; two Modbus frames, 18 CAN frames as text */

typedef struct {
    volatile uint32_t written, taken; /* counts since start; their difference is the number in the ring */
    uint8_t bytes[BYTE_RING_BYTES];
} byte_ring_t;

static inline uint32_t byte_ring_used(const byte_ring_t *ring)
{
    return ring->written - ring->taken;
}

static inline bool byte_ring_put(byte_ring_t *ring, uint8_t byte)
{
    const uint32_t written = ring->written;
    if (written - ring->taken >= (uint32_t)BYTE_RING_BYTES) {
        return false;
    }
    ring->bytes[written % BYTE_RING_BYTES] = byte;
    compiler_barrier();
    ring->written = written + 1u;
    return true;
}

static inline bool byte_ring_take(byte_ring_t *ring, uint8_t *byte)
{
    const uint32_t taken = ring->taken;
    if (ring->written == taken) {
        return false;
    }
    compiler_barrier();
    *byte = ring->bytes[taken % BYTE_RING_BYTES];
    compiler_barrier();
    ring->taken = taken + 1u;
    return true;
}

#endif
