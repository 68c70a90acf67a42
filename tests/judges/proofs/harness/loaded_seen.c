/* K under load in fixed point from its inputs to the links that its equations see. */
#define SEEN_ONLY
#include "loaded_whole.c"
