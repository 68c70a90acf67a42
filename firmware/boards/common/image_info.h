/* What an image says of itself, in the image: brace flash reads it before it writes, the banner when it runs.
 *
 * Text fields are padded with zeros. The block lies behind the vector table and is found by its magic; layout fixed:
 * magic 8, format 4, board 24, version 16, hash 32, build 16 bytes.
 */
#ifndef BRACE_BOARDS_IMAGE_INFO_H
#define BRACE_BOARDS_IMAGE_INFO_H

#include <stdint.h>

typedef struct {
    char magic[8];    /* "BRACEIMG" */
    uint32_t format;  /* 1 */
    char board[24];   /* the image is for this board only */
    char version[16];
    char hash[32];    /* of the source's commit, '-dirty' behind it when the source had changed since */
    char build[16];   /* Release, Debug, ... */
} image_info_t;

extern const image_info_t image_info;

#endif
