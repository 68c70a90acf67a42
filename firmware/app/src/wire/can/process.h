/* Process data: K, its eigenvalues, the posture, the load and K's uncertainty of one snapshot, at the parameters'
 * rates; of a limb whose coxa joint is fitted also K in space and the load across the plane; over CAN FD in one frame
 * to four. One for each port.
 *
 * All frames of a snapshot are made from one copy of it, so nothing is ever mixed from two. The next snapshot is taken
 * when the last frame of this one has left, so a busy bus thins the data and never splits them. Rates are lowered in
 * proportion when they would take more than controller.bus_load_ratio of the bus, every frame counted with all the
 * stuff bits that it could have. Nodes that start together begin at different moments: node * 1.25 ms within the
 * period. */
#ifndef BRACE_WIRE_CAN_PROCESS_H
#define BRACE_WIRE_CAN_PROCESS_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/measured.h"
#include "brace_hal.h"
#include "wire/wire.h"

enum {
    PROCESS_FRAME_BITS = 135, /* standard identifier, eight bytes: 108, at most 24 stuff bits, 3 between frames */
    PROCESS_STAGGER_US = 1250,
    PROCESS_FRAMES_PER_TICK = 2 /* of a controller's three mailboxes one stays free for an answer */
};

/* What the periods depend on beside the parameters in force; it stays from start to start. */
typedef struct {
    uint32_t node_id;
    uint32_t bit_rate;    /* [bit/s] */
    uint32_t fd_bit_rate; /* [bit/s]; 0: snapshots leave in classic frames */
} process_bus_t;

/* Rates that frames follow: controller.stiffness_hz, posture_hz, load_hz, sigma_hz. */
typedef enum { PROCESS_STIFFNESS = 0, PROCESS_POSTURE, PROCESS_LOAD, PROCESS_SIGMA, PROCESS_RATES } process_rate_t;

/* The frames that follow one rate: every so many snapshots. */
typedef struct {
    uint64_t frames; /* as bits */
    uint32_t count;  /* of them */
    uint32_t every;  /* 0: never */
    uint32_t left;   /* snapshots until the next one that is told */
} process_share_t;

typedef struct {
    bool is_configured;
    uint32_t parameter_crc;    /* of the set that the periods were worked out from */
    uint32_t period_us;        /* from snapshot to snapshot; 0: none is ever sent */
    uint32_t next_us;          /* when the next snapshot is due */
    process_share_t share[PROCESS_RATES];
    uint64_t due;              /* frames of the snapshot that have still to be sent, as bits */
    uint32_t taken_us;         /* when the snapshot was taken */
    brace_measured_t snapshot; /* the one whose frames are due */
} process_t;

/* Each tick, before process_next: works the periods out where the parameters have changed; else takes the newest
 * snapshot where one is due and the frames of the one before have left.
 * returns how much that was (wire/wire.h), counted in requests. At most 1,100 instructions where the parameters have
 *   changed, else 250. */
uint32_t process_tick(process_t *process, const process_bus_t *bus, const wire_tick_t *tick);

/* Gives the next frame that is due, if there is one, but for the node's number in its identifier. The frame is made
 * when it is sent, so that the age in it is that of this moment. At most 130 instructions; with CAN FD 260. */
bool process_next(const process_t *process, const wire_tick_t *tick, brace_can_frame_t *frame);

/* The frame that process_next gave has left. */
void process_sent(process_t *process);

/* Nobody listens: what is still due is not told any more. */
void process_skip(process_t *process);

#endif
