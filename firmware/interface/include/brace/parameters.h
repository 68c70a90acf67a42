/* The parameters that a controller is given and keeps: the limb, its drives, its instruments, and its own settings.
 *
 * brace_parameters_t is one struct of plain 32-bit numbers. The dictionary (firmware/interface/dictionary.toml) lists
 * every member in the struct's order, with its key in limb.toml, unit, range and default. The struct
 * (brace/parameter_fields.h), its ranges (brace/ranges.h), its tables and its list of members
 * (brace/parameter_list.h: count, schema hash, an index for each member) are generated from the dictionary. A parameter
 * block is this struct as bytes: header, members little-endian in the same order, CRC.
 *
 *   offset  0  magic "BRCE"           4
 *           4  format = 1             2
 *           6  header bytes = 20      2
 *           8  schema hash            4   CRC-32 of the member list's keys, types and units
 *          12  members' bytes         4
 *          16  sequence               4   of the parameter set; newer is larger, modulo 2^32
 *          20  members ...
 *        last  CRC-32 of all before   4   (IEEE 802.3, as zlib)
 *
 * Pure functions, any thread, not for the tick; no heap, no recursion, loops over the fixed list of members. A refused
 * call leaves its outputs untouched, unless its comment says otherwise. Costs are instructions on a Cortex-M4F; the
 * bench's plugin counts them while the unit tests run.
 */
#ifndef BRACE_PARAMETERS_H
#define BRACE_PARAMETERS_H

#include <stddef.h>
#include <stdint.h>

#include "brace/limb.h"
#include "brace/parameter_fields.h"
#include "brace/parameter_list.h"
#include "brace/status.h"

/* Where the parameters in force came from. */
typedef enum {
    BRACE_PARAMETERS_DEFAULT = 0, /* no valid set is stored: safe defaults, every K is UNCALIBRATED */
    BRACE_PARAMETERS_SLOT_A = 1,
    BRACE_PARAMETERS_SLOT_B = 2
} brace_parameter_origin_t;

enum {
    BRACE_BLOCK_FORMAT = 1,
    BRACE_BLOCK_HEADER_BYTES = 20,
    BRACE_BLOCK_BYTES = BRACE_BLOCK_HEADER_BYTES + 4 * BRACE_PARAMETER_COUNT + 4
};

/* The contents of a block's header. */
typedef struct {
    uint32_t format;
    uint32_t schema_hash;
    uint32_t block_bytes; /* header, members and CRC */
    uint32_t sequence;
} brace_block_header_t;

/* Safe defaults: the paper's limb, with compliance as its only effect, node unset, listen only. A K computed from them
 * is UNCALIBRATED. Null is ignored. */
void brace_parameters_default(brace_parameters_t *parameters);

/* Could a controller run with these parameters? Every member has to be in its range. Then members have to agree: noise,
 * bias and take-up torque within the torque range, travel from low to high, bit rates that exist, an age limit above
 * the tick. Last, brace_limb_check has to accept the limb.
 *   wrong_index (out, may be null): the first member at fault (BRACE_PARAMETER_..., brace_parameter_key), or
 *     BRACE_PARAMETER_COUNT when the limb as a whole is; written only with BRACE_E_PARAMETER, BRACE_E_NOT_FINITE
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE (NaN), BRACE_E_PARAMETER
 * cost: 3,200 instructions; stack 100 bytes */
brace_status_t brace_parameters_check(const brace_parameters_t *parameters, uint32_t *wrong_index);

/* The same in pieces, for a tick: call pieces 0 to BRACE_CHECK_PIECES - 1 in this order until one refuses. The last
 * piece checks whether members agree; it relies on each member being in its range.
 * returns also BRACE_E_RANGE (no such piece); cost: at most 1,000 instructions */
enum {
    BRACE_CHECK_MEMBERS = 24, /* members in a piece */
    BRACE_CHECK_TOGETHER = (BRACE_PARAMETER_COUNT + BRACE_CHECK_MEMBERS - 1) / BRACE_CHECK_MEMBERS,
    BRACE_CHECK_PIECES = BRACE_CHECK_TOGETHER + 1
};
brace_status_t brace_parameters_check_piece(const brace_parameters_t *parameters, uint32_t piece,
                                            uint32_t *wrong_index);

/* Is one member, given as its 32 bits, in its own range? Only brace_parameters_check checks whether members agree.
 * returns BRACE_OK, BRACE_E_RANGE (no such member), BRACE_E_PARAMETER, BRACE_E_NOT_FINITE;
 * cost: at most 60 instructions */
brace_status_t brace_parameter_in_range(uint32_t index, uint32_t word);

/* Writes parameters as a block of BRACE_BLOCK_BYTES. It refuses what brace_parameters_check refuses.
 *   room: size of `block` in bytes
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_LENGTH (room), BRACE_E_NOT_FINITE, BRACE_E_PARAMETER
 * cost: 8,100 instructions; stack 150 bytes */
brace_status_t brace_parameters_pack(const brace_parameters_t *parameters, uint32_t sequence, uint8_t *block,
                                     uint32_t room);

/* The same in pieces: writes a block except its last four bytes, the CRC-32 of all before. Checks nothing. Not null.
 * cost: 560 instructions */
void brace_block_compose(const brace_parameters_t *parameters, uint32_t sequence, uint8_t *block);

/* Reads parameters from a block. It uses no value before the CRC has proved right.
 *   length: bytes of the block, exactly
 *   sequence (out, may be null)
 *   wrong_index (out, may be null): as brace_parameters_check, and written with the same refusals only
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_LENGTH (too short for a header, or not as long as the header says),
 *   BRACE_E_MAGIC, BRACE_E_FORMAT, BRACE_E_CHECKSUM, BRACE_E_SCHEMA (sound, but of another dictionary: compare the hash
 *   of brace_block_header with BRACE_SCHEMA_HASH), BRACE_E_NOT_FINITE, BRACE_E_PARAMETER
 * cost: 8,400 instructions; stack 560 bytes */
brace_status_t brace_parameters_unpack(const uint8_t *block, uint32_t length, brace_parameters_t *parameters,
                                       uint32_t *sequence, uint32_t *wrong_index);

/* Reads only a block's header. It checks magic and format and not the schema, so that a caller can show both hashes.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_LENGTH (less than a header, or it names an impossible length),
 *   BRACE_E_MAGIC, BRACE_E_FORMAT; cost: 40 instructions */
brace_status_t brace_block_header(const uint8_t *block, uint32_t length, brace_block_header_t *header);

/* Reads the members of a block that brace_parameters_unpack accepts. Checks nothing. Not null.
 * cost: 430 instructions */
void brace_block_members(const uint8_t *block, brace_parameters_t *parameters);

/* Identity of a set of values: CRC-32 of schema hash and members, without the sequence. Equal values give an equal
 * number on every controller and in every tool. 0 for null. cost: 6,000 instructions */
uint32_t brace_parameters_crc(const brace_parameters_t *parameters);

/* CRC-32 (IEEE 802.3, reflected, as zlib's crc32): of `count` bytes, continued from `crc` (0 at first).
 * cost: 14 instructions a byte */
uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count);

/* Key or unit of a member, by its index, for messages; constant storage. key: as in limb.toml; "the limb as a whole"
 * from BRACE_PARAMETER_COUNT on. For hosts: an image that does not call these has no texts in it. */
const char *brace_parameter_key(uint32_t index);
const char *brace_parameter_unit(uint32_t index);

/* The index of the member that has this number on the wire: half its Modbus register,
 * and its number on CAN. BRACE_PARAMETER_COUNT where no member has that number. In the header, because an answer can
 * look up 62 of them. cost: 5 instructions */
static inline uint32_t brace_parameter_index(uint32_t number)
{
    return number < (uint32_t)BRACE_PARAMETER_NUMBERS ? brace_parameter_indices[number]
                                                      : (uint32_t)BRACE_PARAMETER_COUNT;
}

/* The number on the wire of the member that has this index. From BRACE_PARAMETER_COUNT on it is
 * BRACE_PARAMETER_NUMBERS, which belongs to no parameter. cost: 10 instructions */
uint32_t brace_parameter_number(uint32_t index);

#endif
