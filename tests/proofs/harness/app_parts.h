/* A controller that has only the parts that a proof is about: the code under proof is compiled against these, with the
 * parts' own types, and does not compile if it uses others. CBMC's formulas grow with the whole struct's 20 kB else.
 * Included before all else, with APP_PARTS as the members (proofs.toml: parts). */
#ifndef BRACE_PROOF_APP_PARTS_H
#define BRACE_PROOF_APP_PARTS_H

#define brace_app_t brace_app_whole_t
#include "brace/app.h"
#undef brace_app_t

typedef struct {
    const brace_hal_t *hal;
    APP_PARTS
} brace_app_t;

#endif
