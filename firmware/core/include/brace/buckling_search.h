/* What a search for the buckling factor keeps between its steps (brace/loaded_space.h). */
#ifndef BRACE_BUCKLING_SEARCH_H
#define BRACE_BUCKLING_SEARCH_H

/* Other code must not read its members. */
typedef struct {
    float before, low, high;          /* multiples of the load */
    float at_before, at_low, at_high; /* the limb's determinant there */
    int step;
} brace_buckling_search_t;

#endif
