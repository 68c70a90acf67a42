/* Taking up the backlash of several joints: one after the other, held, and let go in the reverse order. */
#ifndef BRACE_FLANK_TAKEUP_H
#define BRACE_FLANK_TAKEUP_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/status.h"
#include "flank/flank.h"

typedef struct {
    uint8_t order[BRACE_LINK_COUNT]; /* joints in the order of taking up */
    uint8_t count;                   /* of them that are taken up, being taken up or let go */
    bool begun;                      /* the last one has left IDLE */
    bool letting_go;
} takeup_t;

/* Asks for one joint's play to be taken up. The next joint may follow when this one holds.
 * returns BRACE_OK, BRACE_E_RANGE (joint or flank), BRACE_E_UNSUPPORTED (the joint has no play that is watched),
 *   BRACE_E_MODE (another joint does not hold yet, or the joints are being let go) */
brace_status_t takeup_request(takeup_t *takeup, flank_t *flank, int32_t joint_index, int32_t flank_sign);

/* What takeup_request would return now. It changes nothing. */
brace_status_t takeup_may_request(const takeup_t *takeup, const flank_t *flank, int32_t joint_index,
                                  int32_t flank_sign);

/* Begins to let every joint go. */
void takeup_let_go(takeup_t *takeup);

/* One tick, after flank_tick. A joint that fails takes the others with it; one that is back makes room for the next. */
void takeup_step(takeup_t *takeup, flank_t *flank);

/* Is any joint taken up, being taken up or let go? */
static inline bool takeup_runs(const takeup_t *takeup)
{
    return takeup->count > 0u;
}

/* Has every joint that was asked taken its flank? */
bool takeup_holds(const takeup_t *takeup, const flank_t *flank);

#endif
