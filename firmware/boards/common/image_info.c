#include "image_info.h"

#include "build_info.h" /* written by the build */

__attribute__((section(".image_info"), used)) const image_info_t image_info = {
    .magic = {'B', 'R', 'A', 'C', 'E', 'I', 'M', 'G'},
    .format = 1u,
    .board = BRACE_BOARD_NAME,
    .version = BRACE_VERSION,
    .hash = BRACE_SOURCE_HASH,
    .build = BRACE_BUILD_TYPE,
};
