/* Joins the frames of one snapshot. It never gives a K of two ticks: frames count as one snapshot's when they carry one
 * sequence number, came within BRACE_JOINER_SPAN_US of each other, and nothing was lost in between. The span is shorter
 * than the shortest round of the 8-bit number (256 ticks of 500 us), so that an old half finds no partner a round
 * later. */
#ifndef BRACE_JOINER_H
#define BRACE_JOINER_H

#include "brace/bus.h"
#include "brace/client.h"

enum { BRACE_JOINER_SPAN_US = 40000, BRACE_JOINER_SLOTS = 2 };

typedef struct {
    bool used;
    brace_client_snapshot_t snapshot;
    uint32_t frames; /* that have come, one bit each */
} brace_joiner_slot_t;

typedef struct {
    brace_joiner_slot_t slots[BRACE_JOINER_SLOTS]; /* two, because a new K may be sent before an older posture */
    uint32_t lost;
    bool faults_are_known; /* since the last frame that was lost */
    uint32_t faults; /* as last heard */
} brace_joiner_t;

/* What the controller has answered about its faults. lost: as below. */
void brace_joiner_hear_faults(brace_joiner_t *joiner, uint32_t faults, uint32_t lost);

/* Takes one frame of process data (0x180, 0x200, 0x280, 0x380, 0x480 + node; with CAN FD, 0x300 and 0x500 + node), or
 * an emergency (0x080 + node), and ignores any other frame. lost: the bus' count of lost frames up to this one.
 * returns the snapshot to which this frame has completed a part, valid until the next call; null: there is none */
const brace_client_snapshot_t *brace_joiner_add(brace_joiner_t *joiner, uint32_t node, const brace_bus_frame_t *frame,
                                                uint32_t lost);

#endif
