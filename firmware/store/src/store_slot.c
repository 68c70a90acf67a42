#include "store_slot.h"

#include <string.h>

enum {
    CRC_BYTES = 4,
    SEQUENCE_AT = 16, /* of a block; brace_block_compose puts it there */
    MARKS_BYTES = BRACE_STORE_MARK_COUNT * BRACE_STORE_MARK_BYTES
};

_Static_assert(BRACE_STORE_BLOCK_ROOM <= BRACE_STORE_MARKS_AT, "a block ends before the marks");

static uint32_t get_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

bool store_fits(const brace_hal_t *hal)
{
    const uint32_t unit = hal->nvm_shape.write_bytes;
    return hal->nvm_read != NULL && hal->nvm_write != NULL && hal->nvm_erase != NULL &&
           hal->nvm_shape.slot_bytes >= BRACE_STORE_MARKS_AT + MARKS_BYTES &&
           (unit == 1u || unit == 2u || unit == 4u || unit == 8u);
}

bool store_is_ours(const brace_slot_report_t *report)
{
    return report->condition == BRACE_SLOT_COUNTS || report->condition == BRACE_SLOT_NOT_COMMITTED ||
           report->condition == BRACE_SLOT_VOID || report->condition == BRACE_SLOT_REFUSED;
}

void store_mark(uint8_t mark[BRACE_STORE_MARK_BYTES], store_word_t word, uint32_t later, uint32_t block_crc)
{
    memcpy(mark, word == STORE_KEEP ? "KEEP" : word == STORE_VOID ? "VOID" : "PS__", 4);
    if (word == STORE_PAST) {
        mark[2] = (uint8_t)later;
        mark[3] = (uint8_t)(later >> 8);
    }
    for (uint32_t i = 0; i < 4u; i++) {
        mark[4u + i] = (uint8_t)(block_crc >> (8u * i));
    }
}

static bool read(const brace_store_t *store, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    return store->hal->nvm_read(store->hal->context, slot, offset, bytes, count) == BRACE_HAL_OK;
}

static bool is_blank(const uint8_t *bytes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (bytes[i] != 0xffu) {
            return false;
        }
    }
    return true;
}

/* The CRC of a block of any length, as read now. */
static bool crc_fits(const brace_store_t *store, uint32_t slot, uint32_t block_bytes)
{
    uint8_t piece[BRACE_STORE_PIECE_BYTES];
    const uint32_t covered = block_bytes - CRC_BYTES;
    uint32_t crc = 0;
    for (uint32_t at = 0; at < covered; at += sizeof piece) {
        const uint32_t count = covered - at < sizeof piece ? covered - at : (uint32_t)sizeof piece;
        if (!read(store, slot, at, piece, count)) {
            return false;
        }
        crc = brace_crc32(crc, piece, count);
    }
    return read(store, slot, covered, piece, CRC_BYTES) && crc == get_u32(piece);
}

/* What a mark says. */
typedef enum { SAYS_NOTHING, SAYS_KEEP, SAYS_VOID, SAYS_PAST } says_t;

static says_t word_of(const uint8_t mark[BRACE_STORE_MARK_BYTES])
{
    return memcmp(mark, "KEEP", 4) == 0   ? SAYS_KEEP
           : memcmp(mark, "VOID", 4) == 0 ? SAYS_VOID
           : memcmp(mark, "PS", 2) == 0   ? SAYS_PAST
                                          : SAYS_NOTHING;
}

/* The last legible mark of a block, and the last place where anything was ever written (-1: nowhere). */
typedef struct {
    bool readable;
    says_t last_said; /* of marks that name the block's CRC */
    uint32_t later;   /* of the last PAST */
    says_t last_word; /* of marks that name any CRC, */
    uint32_t crc;     /* which is this */
    int32_t last;
} marks_t;

static void take_mark(marks_t *marks, const uint8_t mark[BRACE_STORE_MARK_BYTES], uint32_t block_crc)
{
    const says_t word = word_of(mark);
    if (word == SAYS_NOTHING) {
        return;
    }
    marks->last_word = word;
    marks->crc = get_u32(mark + 4);
    if (marks->crc == block_crc) {
        marks->last_said = word;
        marks->later = word == SAYS_PAST ? (uint32_t)mark[2] | (uint32_t)mark[3] << 8 : 0u;
    }
}

static marks_t read_marks(const brace_store_t *store, uint32_t slot, uint32_t block_crc)
{
    marks_t marks = {.readable = true, .last = -1};
    uint8_t found[BRACE_STORE_MARK_BYTES];
    for (int32_t i = 0; i < BRACE_STORE_MARK_COUNT && marks.readable; i++) {
        const uint32_t at = BRACE_STORE_MARKS_AT + (uint32_t)i * BRACE_STORE_MARK_BYTES;
        marks.readable = read(store, slot, at, found, sizeof found);
        if (marks.readable) {
            take_mark(&marks, found, block_crc);
            marks.last = is_blank(found, sizeof found) ? marks.last : i;
        }
    }
    return marks;
}

/* Was the block in store->block once kept by a mark with this CRC? Its header still names it, or its CRC is still the
 * mark's, or all but its CRC is still what the mark was put to. What an update has withdrawn has zeros in front. */
static bool was_kept(const brace_store_t *store, const marks_t *marks)
{
    static const uint8_t withdrawn[2 * BRACE_STORE_MARK_BYTES];
    brace_block_header_t header;
    const uint32_t covered = BRACE_BLOCK_BYTES - CRC_BYTES;
    return marks->last_word == SAYS_KEEP && memcmp(store->block, withdrawn, sizeof withdrawn) != 0 &&
           (brace_block_header(store->block, BRACE_BLOCK_BYTES, &header) == BRACE_OK ||
            get_u32(store->block + covered) == marks->crc || brace_crc32(0, store->block, covered) == marks->crc);
}

/* The block in store->block as parameters. */
static brace_slot_condition_t judge_block(brace_store_t *store, uint32_t slot, brace_slot_report_t *report,
                                          brace_parameters_t *parameters)
{
    brace_block_header_t header;
    const brace_status_t legible = brace_block_header(store->block, BRACE_BLOCK_BYTES, &header);
    if (legible == BRACE_E_MAGIC) {
        return BRACE_SLOT_EMPTY;
    }
    if (legible != BRACE_OK || header.block_bytes > BRACE_STORE_MARKS_AT) {
        return BRACE_SLOT_DAMAGED;
    }
    if (header.schema_hash != BRACE_SCHEMA_HASH && crc_fits(store, slot, header.block_bytes)) {
        report->schema_hash = header.schema_hash;
        report->sequence = header.sequence;
        return BRACE_SLOT_OTHER_SCHEMA;
    }
    uint32_t wrong_index = 0;
    const brace_status_t status =
        brace_parameters_unpack(store->block, BRACE_BLOCK_BYTES, parameters, NULL, &wrong_index);
    if (status != BRACE_OK && status != BRACE_E_PARAMETER && status != BRACE_E_NOT_FINITE) {
        return BRACE_SLOT_DAMAGED;
    }
    report->schema_hash = header.schema_hash;
    report->sequence = header.sequence;
    report->block_crc = get_u32(store->block + BRACE_BLOCK_BYTES - CRC_BYTES);
    report->wrong_index = status == BRACE_OK ? 0u : wrong_index;
    return status == BRACE_OK ? BRACE_SLOT_COUNTS : BRACE_SLOT_REFUSED;
}

void store_look(brace_store_t *store, uint32_t slot, brace_parameters_t *parameters, store_claim_t *claim)
{
    brace_slot_report_t *report = &store->slot[slot];
    brace_parameters_t found;
    memset(report, 0, sizeof *report);
    *claim = (store_claim_t){.is_past = false};
    store->affirmed[slot] = store->clean[slot] = false;
    if (!read(store, slot, 0, store->block, BRACE_BLOCK_BYTES)) {
        report->condition = BRACE_SLOT_UNREADABLE;
        return;
    }
    report->condition = judge_block(store, slot, report, &found);
    const marks_t marks = read_marks(store, slot, report->block_crc);
    if (!marks.readable) {
        report->condition = BRACE_SLOT_UNREADABLE;
        return;
    }
    store->next_mark[slot] = (uint8_t)(marks.last + 1);
    const bool is_kept = marks.last_said == SAYS_KEEP || marks.last_said == SAYS_PAST;
    if (report->condition == BRACE_SLOT_COUNTS && is_kept) {
        *parameters = found;
        claim->is_past = marks.last_said == SAYS_PAST;
        claim->later = marks.later;
    } else if (report->condition == BRACE_SLOT_COUNTS) {
        report->condition = marks.last_said == SAYS_VOID ? BRACE_SLOT_VOID : BRACE_SLOT_NOT_COMMITTED;
    } else if (report->condition != BRACE_SLOT_OTHER_SCHEMA && was_kept(store, &marks)) {
        report->condition = report->condition == BRACE_SLOT_REFUSED ? BRACE_SLOT_REFUSED : BRACE_SLOT_DAMAGED;
        claim->is_rotten = true;
        claim->sequence = get_u32(store->block + SEQUENCE_AT);
    }
}
