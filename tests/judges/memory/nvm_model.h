/* A non-volatile memory whose power fails at a chosen step, in a chosen manner. Written for the power-cut enumeration;
 * shares nothing with the HALs.
 *
 * A step is one unit of a write, or one erase. Erased is 0xff. A unit that was written may not be written again before
 * an erase, save with zeros; what breaks this is counted in `misuse`. What is written into a slot whose erase was
 * interrupted may be lost.
 */
#ifndef BRACE_NVM_MODEL_H
#define BRACE_NVM_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "brace_hal.h"

#ifndef NVM_MODEL_SLOT_BYTES
#define NVM_MODEL_SLOT_BYTES 4096
#endif
enum { NVM_SLOT_BYTES = NVM_MODEL_SLOT_BYTES, NVM_FOREVER = -1 };

/* What the interrupted step leaves behind. For a write the unit was `old` (erased) and should be `new`. */
typedef enum {
    CUT_BEFORE,        /* untouched */
    CUT_AFTER,         /* whole */
    CUT_ZEROS,         /* all bits 0 */
    CUT_FIRST_HALF,    /* its first half as after, the rest as before (single bytes: the low four bits) */
    CUT_SECOND_HALF,
    CUT_EVEN_BITS,     /* bits 0, 2, 4 ... as after, the others as before */
    CUT_ODD_BITS,
    CUT_RANDOM_BITS,   /* each bit as before or as after, by lot, once */
    CUT_NOISE,         /* anything, once */
    CUT_UNSTABLE,      /* each bit as before or as after, by lot at each read */
    CUT_UNSTABLE_NOISE, /* anything, at each read */
    CUT_UNSTABLE_WHOLE, /* all as before or all as after, by lot at each read: a cell at the reader's threshold */
    CUT_MANNER_COUNT
} cut_manner_t;

typedef struct {
    uint8_t bytes[BRACE_NVM_SLOT_COUNT][NVM_SLOT_BYTES];  /* as before the interrupted step, where unstable */
    uint8_t after[BRACE_NVM_SLOT_COUNT][NVM_SLOT_BYTES];  /* as after it, where unstable */
    uint8_t unstable[BRACE_NVM_SLOT_COUNT][NVM_SLOT_BYTES]; /* 0, or the manner */
    uint8_t written[BRACE_NVM_SLOT_COUNT][NVM_SLOT_BYTES];
    uint8_t stuck_mask[BRACE_NVM_SLOT_COUNT][NVM_SLOT_BYTES]; /* bits that no write clears */
    bool half_erased[BRACE_NVM_SLOT_COUNT];
    uint32_t unit;
    int32_t steps_left; /* until power fails; NVM_FOREVER: never */
    cut_manner_t manner;
    bool dead;          /* power has failed: every call is refused and does nothing */
    bool reading_fails, writing_fails, erasing_fails, erasing_forgets;
    int32_t steps_done, erases_begun; /* since power came back */
    uint32_t misuse;
    uint32_t random;
} nvm_t;

void nvm_init(nvm_t *nvm, uint32_t unit);

/* Power comes back: nothing is changed but that calls work, and the next failure is `steps` steps away. */
void nvm_power(nvm_t *nvm, int32_t steps, cut_manner_t manner);

/* A door with this memory behind it and nothing else. */
brace_hal_t nvm_hal(nvm_t *nvm);

#endif
