#include "brace/app.h"

_Static_assert(BRACE_PARAMETERS_DEFAULT == 0, "an application of zeroes runs on defaults");
