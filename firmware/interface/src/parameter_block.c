#include <stddef.h>

#include "brace/parameters.h"
#include "brace/words.h"

static const uint8_t magic[4] = {'B', 'R', 'C', 'E'};

enum {
    AT_FORMAT = 4,
    AT_HEADER_BYTES = 6,
    AT_SCHEMA = 8,
    AT_MEMBER_BYTES = 12,
    AT_SEQUENCE = 16,
    CRC_BYTES = 4,
    MEMBER_BYTES = 4 * BRACE_PARAMETER_COUNT,
    MEMBER_BYTES_MAX = 1 << 20 /* for any dictionary */
};

brace_status_t brace_parameters_pack(const brace_parameters_t *parameters, uint32_t sequence, uint8_t *block,
                                     uint32_t room)
{
    if (parameters == NULL || block == NULL) {
        return BRACE_E_NULL;
    }
    if (room < BRACE_BLOCK_BYTES) {
        return BRACE_E_LENGTH;
    }
    const brace_status_t status = brace_parameters_check(parameters, NULL);
    if (status != BRACE_OK) {
        return status;
    }
    brace_block_compose(parameters, sequence, block);
    brace_put_u32(block + BRACE_BLOCK_BYTES - CRC_BYTES, brace_crc32(0, block, BRACE_BLOCK_BYTES - CRC_BYTES));
    return BRACE_OK;
}

void brace_block_compose(const brace_parameters_t *parameters, uint32_t sequence, uint8_t *block)
{
    memcpy(block, magic, sizeof magic);
    brace_put_u32(block + AT_FORMAT, BRACE_BLOCK_FORMAT | BRACE_BLOCK_HEADER_BYTES << 16);
    brace_put_u32(block + AT_SCHEMA, BRACE_SCHEMA_HASH);
    brace_put_u32(block + AT_MEMBER_BYTES, MEMBER_BYTES);
    brace_put_u32(block + AT_SEQUENCE, sequence);
    for (uint32_t i = 0; i < BRACE_PARAMETER_COUNT; i++) {
        brace_put_u32(block + BRACE_BLOCK_HEADER_BYTES + 4u * i, brace_member_get(parameters, i));
    }
}

brace_status_t brace_block_header(const uint8_t *block, uint32_t length, brace_block_header_t *header)
{
    if (block == NULL || header == NULL) {
        return BRACE_E_NULL;
    }
    if (length < BRACE_BLOCK_HEADER_BYTES) {
        return BRACE_E_LENGTH;
    }
    if (memcmp(block, magic, sizeof magic) != 0) {
        return BRACE_E_MAGIC;
    }
    if (brace_get_u16(block + AT_FORMAT) != BRACE_BLOCK_FORMAT ||
        brace_get_u16(block + AT_HEADER_BYTES) != BRACE_BLOCK_HEADER_BYTES) {
        return BRACE_E_FORMAT;
    }
    const uint32_t member_bytes = brace_get_u32(block + AT_MEMBER_BYTES);
    if (member_bytes > MEMBER_BYTES_MAX || member_bytes % 4u != 0u) {
        return BRACE_E_LENGTH;
    }
    header->format = BRACE_BLOCK_FORMAT;
    header->schema_hash = brace_get_u32(block + AT_SCHEMA);
    header->block_bytes = BRACE_BLOCK_HEADER_BYTES + member_bytes + CRC_BYTES;
    header->sequence = brace_get_u32(block + AT_SEQUENCE);
    return BRACE_OK;
}

void brace_block_members(const uint8_t *block, brace_parameters_t *parameters)
{
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(parameters, block + BRACE_BLOCK_HEADER_BYTES, sizeof *parameters);
#else
    for (uint32_t i = 0; i < BRACE_PARAMETER_COUNT; i++) {
        brace_member_put(parameters, i, brace_get_u32(block + BRACE_BLOCK_HEADER_BYTES + 4u * i));
    }
#endif
}

brace_status_t brace_parameters_unpack(const uint8_t *block, uint32_t length, brace_parameters_t *parameters,
                                       uint32_t *sequence, uint32_t *wrong_index)
{
    brace_block_header_t header;
    if (parameters == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_block_header(block, length, &header);
    if (status != BRACE_OK) {
        return status;
    }
    if (length != header.block_bytes) {
        return BRACE_E_LENGTH;
    }
    if (brace_crc32(0, block, length - CRC_BYTES) != brace_get_u32(block + length - CRC_BYTES)) {
        return BRACE_E_CHECKSUM;
    }
    if (header.schema_hash != BRACE_SCHEMA_HASH) {
        return BRACE_E_SCHEMA;
    }
    if (length != BRACE_BLOCK_BYTES) {
        return BRACE_E_LENGTH;
    }
    brace_parameters_t read;
    brace_block_members(block, &read);
    status = brace_parameters_check(&read, wrong_index);
    if (status != BRACE_OK) {
        return status;
    }
    *parameters = read;
    if (sequence != NULL) {
        *sequence = header.sequence;
    }
    return BRACE_OK;
}

uint32_t brace_parameters_crc(const brace_parameters_t *parameters)
{
    if (parameters == NULL) {
        return 0;
    }
    uint8_t word[4];
    brace_put_u32(word, BRACE_SCHEMA_HASH);
    uint32_t crc = brace_crc32(0, word, sizeof word);
    for (uint32_t i = 0; i < BRACE_PARAMETER_COUNT; i++) {
        brace_put_u32(word, brace_member_get(parameters, i));
        crc = brace_crc32(crc, word, sizeof word);
    }
    return crc;
}
