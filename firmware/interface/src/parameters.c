#include "brace/parameters.h"

/* One translation unit at least, until the block's codecs stand here. */
extern const unsigned brace_parameter_block_format;
const unsigned brace_parameter_block_format = 1u;
