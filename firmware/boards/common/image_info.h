/* A block in each image that describes it. brace flash reads the block before it writes, the banner when the image
 * runs.
 *
 * Text fields are padded with zeros. The block lies behind the vector table, and readers find it by its magic. Its
 * layout never changes:
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
    char hash[32];    /* of the source's commit, with '-dirty' appended if the source has changed since */
    char build[16];   /* Release, Debug, ... */
} image_info_t;

extern const image_info_t image_info;

#endif
