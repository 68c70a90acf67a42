/* Loops whose bound cannot be seen. Every line that says so has to be found, and no other. */
#include <stdint.h>

typedef struct {
    uint32_t other;
} elsewhere_t; /* reach of something else [0, 9]: says nothing of an argument of that name */

typedef struct node {
    struct node *next;
} node_t;

extern volatile uint32_t ready;
void loops_bad(uint32_t reach, uint8_t *bytes, const node_t *node);

void loops_bad(uint32_t reach, uint8_t *bytes, const node_t *node)
{
    while (1) { /* BAD: loop without a bound */
    }
    for (;;) { /* BAD: loop without a bound */
        ready = 0u;
    }
    while ((ready & 1u) == 0u) { /* BAD: loop without a bound */
    }
    for (uint32_t i = 0; i < reach; i++) { /* BAD: loop without a bound */
        bytes[i] = 0;
    }
    for (const node_t *at = node; at != 0; at = at->next) { /* BAD: loop without a bound */
    }
    for (uint32_t i = 0; i < 8; i++) { /* BAD: loop without a bound */
        if (bytes[i] == 0) {
            i = 0;
        }
    }
    uint32_t goal = 8;
    for (uint32_t i = 0; i < goal; i++) { /* BAD: loop without a bound */
        goal++;
    }
    uint32_t tries = 0;
    while (tries < 100) { /* BAD: loop without a bound */
        if (ready != 0u) {
            tries++;
        }
    }
    tries = 0;
    while (tries < 100) { /* BAD: loop without a bound */
        if (ready != 0u) {
            continue;
        }
        tries++;
    }
    for (uint32_t i = 0; i < 100; i--) { /* BAD: loop without a bound */
    }
    do { /* BAD: loop without a bound */
    } while (ready == 0u);
again:
    if (ready == 0u) {
        goto again; /* BAD: loop without a bound */
    }
}
