/* For claims about so few inputs that a processor goes through all: the harness is compiled for this machine and
 * run. What is under proof there is integers of fixed width, which are the same on every machine. */
#ifndef BRACE_PROOF_COUNTED_H
#define BRACE_PROOF_COUNTED_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define PROVE(condition, claim) \
    do { \
        enum { PROVED }; \
        if (!(condition)) { \
            printf("%s:%d: %s\n", __FILE__, __LINE__, (claim)); \
            exit(1); \
        } \
    } while (0)

#endif
