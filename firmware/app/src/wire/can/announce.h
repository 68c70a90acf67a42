/* What a node says by itself beside process data: a heartbeat at controller.heartbeat_hz and at every change of mode,
 * with its condition behind it, so that a newcomer knows every fault within a heartbeat's period; an emergency for
 * every change of the faults, and of the likeliest cause of a drift: the first readings of a changed limb may name
 * another cause than later ones. One for each port. */
#ifndef BRACE_WIRE_CAN_ANNOUNCE_H
#define BRACE_WIRE_CAN_ANNOUNCE_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/snapshot.h"
#include "brace_hal.h"
#include "wire/wire.h"

typedef struct {
    uint32_t beat_us;       /* when the last heartbeat left */
    bool owes_condition;    /* the last heartbeat has left, and its condition has not */
    uint32_t faults_told;
    uint32_t cause_told;    /* of a drift, as the dictionary numbers them */
    brace_mode_t mode_told;
} announce_t;

/* Gives the frame that is due, if there is one, but for the node's number in its identifier. An emergency goes first, a
 * heartbeat last.
 * returns whether a frame is due
 * About 50 instructions; 170 with a frame. */
bool announce_next(const announce_t *announce, const wire_tick_t *tick, brace_can_frame_t *frame);

/* The frame that announce_next gave in this tick, with this identifier, has left. What has not left is due again in the
 * next tick. */
void announce_sent(announce_t *announce, const wire_tick_t *tick, uint32_t function);

/* Nobody listens: whoever opens the port later is told what changes from then on. */
void announce_skip(announce_t *announce, const wire_tick_t *tick);

#endif
