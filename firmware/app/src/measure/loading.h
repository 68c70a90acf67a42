/* The loading test: brace/loading.h. It advances in every tick; what costs more has a tick of its own. */
#ifndef BRACE_APP_LOADING_H
#define BRACE_APP_LOADING_H

#include "brace/app.h"

enum {
    LOADING_IDLE = 0,
    LOADING_MOVE = 1,
    LOADING_DWELL = 2,
    LOADING_READ = 3,  /* a piece: slope and row */
    LOADING_DRIFT = 4, /* a piece, with nothing beside it: the reading goes to the drift detector */
    LOADING_JUDGE = 5, /* a piece, with nothing beside it: slopes */
    LOADING_COMPARE = 6, /* a piece, with nothing beside it: how sure the model is */
    LOADING_TELL = 7,    /* a piece, with nothing beside it: slopes against the model */
    LOADING_RETURN = 8
};

brace_status_t loading_start(brace_app_t *app, const brace_loading_setup_t *setup);

/* What the test adds to a joint's set-point [rad]; index: 0 femur, 1 tibia */
float loading_offset(const brace_loading_t *test, int index);

/* Ends a test that runs: back to where it began. */
void loading_end(brace_app_t *app, brace_loading_outcome_t outcome);

/* A tick of it, from this tick's samples. At most 150 instructions. */
void loading_advance(brace_app_t *app, const brace_snapshot_t *snapshot);

/* The piece that is due: READ in a tick that computes no K, at most 550 instructions; DRIFT, JUDGE, COMPARE and TELL in
 * one that does nothing else but answer, at most 2,450. */
void loading_piece(brace_app_t *app);

#endif
