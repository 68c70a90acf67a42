/* Process data: K, its eigenvalues and the posture of one snapshot, at the parameters' rates; over CAN FD in one frame.
 *
 * All frames of a snapshot are packed from one copy of it, so nothing is ever mixed from two; the next
 * snapshot is taken when the last frame of this one has left, so a busy bus thins the data and never splits
 * them. Rates are lowered in proportion when they would take more than controller.bus_load_ratio of the bus,
 * every frame counted with all the stuff bits it could have. Nodes that start together begin at different
 * moments: node * 1.25 ms within the period. */
#ifndef BRACE_APP_CYCLIC_H
#define BRACE_APP_CYCLIC_H

#include "brace/app.h"

enum {
    CYCLIC_FRAME_BITS = 135, /* standard identifier, eight bytes: 108, at most 24 stuff bits, 3 between frames */
    CYCLIC_STAGGER_US = 1250
};

/* Works the periods out; again when parameters are put in force. About 250 instructions, the divisions
 * counted. */
void cyclic_configure(brace_app_t *app);

/* Have parameters, or what the bus takes, changed since? */
bool cyclic_is_stale(const brace_app_t *app);

/* Is there a frame to be sent in this tick? About 20 instructions. */
bool cyclic_wants(const brace_app_t *app);

/* Takes the newest snapshot when one is due, sends frames. At most 250 instructions, and 130 for each frame more.
 *   most: frames that this tick has room for [1, 4] */
void cyclic_send(brace_app_t *app, uint32_t most);

#endif
