/* What the requests of one port have begun and not ended: an upload, a download, storing that is to be answered. */
#ifndef BRACE_WIRE_CAN_SESSION_H
#define BRACE_WIRE_CAN_SESSION_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"

typedef struct {
    uint8_t storing;         /* code of the commit or roll-back that is answered once the store has ended; 0: none */
    uint8_t storing_token;

    bool upload_is_open;
    uint32_t upload_next;    /* word that is expected; words before it have come [0, BRACE_BLOCK_BYTES / 4] */
    uint32_t upload_crc;     /* the CRC that the block will end with, as it was announced */
    uint32_t upload_sum;     /* CRC of all words but the last one that has come */
    uint8_t upload[BRACE_BLOCK_BYTES];

    uint32_t download_next;  /* word that is expected to be asked for [0, BRACE_BLOCK_BYTES / 4] */
    uint32_t download_sum;   /* CRC of the words before it */
    uint32_t download_set;   /* brace_parameters_crc of the set that they are of */
} can_session_t;

#endif
