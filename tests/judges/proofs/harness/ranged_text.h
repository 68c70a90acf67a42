/* What harnesses use that run the firmware's text with ranges. */
#ifndef BRACE_PROOF_RANGED_TEXT_H
#define BRACE_PROOF_RANGED_TEXT_H

#include "ranged.h"

#define PROVE(condition, claim) \
    do { \
        enum { PROVED }; \
        if (!(condition)) { \
            ranged::now.complain(claim); \
        } \
    } while (0)

/* A function that its own file calls: its definition, whose first parameter begins with a type, becomes text_..., and a
 * call of it becomes a stand-in's. */
#define SECOND(first, second, ...) second
#define PICK(...) SECOND(__VA_ARGS__)

#endif
