/* Faults, and how long each lasts after its cause has gone. */
#ifndef BRACE_MODE_FAULTS_H
#define BRACE_MODE_FAULTS_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/snapshot.h"

typedef struct {
    uint32_t now;                        /* BRACE_FAULT_... */
    uint32_t away_us[BRACE_FAULT_COUNT]; /* how long the cause of each fault has been away */
} faults_t;

/* The faults of this tick.
 *   causes: faults whose cause is there in this tick. A fault is over when its cause has been away for 100 ms, the
 *     fault TICK_LATE after 1 s.
 *   lasting: faults that stand as long as somebody says so: PARAMETERS, STORE, MODEL_DRIFT, CRASHED, OLD_PARAMETERS,
 *     JUMP_COXA, JUMP_FEMUR, JUMP_TIBIA
 *   may_begin: whether a fault that comes and goes may begin; not in START, where nothing has been seen yet */
void faults_update(faults_t *faults, uint32_t causes, uint32_t lasting, bool may_begin, uint32_t tick_us);

#endif
