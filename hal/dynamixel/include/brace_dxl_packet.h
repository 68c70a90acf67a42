/* Packets of Dynamixel Protocol 2.0, made and read. It knows no line, no clock and no servo.
 *
 *   FF FF FD 00 | id | length, low byte first | instruction | parameters | CRC-16, low byte first
 *
 * The length counts the bytes behind it. The CRC has the polynomial 0x8005, begins at 0 and covers all bytes before it.
 * Wherever FF FF FD stands behind the length, FD is sent once more (stuffing), so that no packet looks like a header.
 * The answer to a fast sync read is not stuffed: its first servo says the length before the others have said anything.
 *
 * What damage is seen: up to three flipped bits, as long as the length is whole; bursts of up to 10 bits on the line.
 * Of the bursts of 11 to 16 bits the CRC misses one at each byte, because the line sends the lowest bit first and the
 * CRC counts from the highest. Where the length is damaged too, the CRC lies elsewhere and misses one packet of 65,536.
 * So whoever asked compares the length with what was asked for, and the values with those before.
 */
#ifndef BRACE_DXL_PACKET_H
#define BRACE_DXL_PACKET_H

#include <stdbool.h>
#include <stdint.h>

enum {
    DXL_PING = 0x01,
    DXL_READ = 0x02,
    DXL_WRITE = 0x03,
    DXL_REBOOT = 0x08,
    DXL_STATUS = 0x55,
    DXL_SYNC_READ = 0x82,
    DXL_SYNC_WRITE = 0x83,
    DXL_FAST_SYNC_READ = 0x8a
};

enum { DXL_ID_MOST = 252, DXL_ID_ALL = 254 };

/* The error byte of a status packet: a number, and a bit that says that the servo's hardware has an error. */
enum {
    DXL_ERROR_NUMBER = 0x7f,
    DXL_ERROR_ALERT = 0x80,
    DXL_ERROR_RESULT = 1,
    DXL_ERROR_INSTRUCTION = 2,
    DXL_ERROR_CRC = 3,
    DXL_ERROR_RANGE = 4,
    DXL_ERROR_LENGTH = 5,
    DXL_ERROR_LIMIT = 6,
    DXL_ERROR_ACCESS = 7
};

enum { DXL_HEAD_BYTES = 8, DXL_CRC_BYTES = 2 }; /* up to the instruction; behind the parameters */

/* Goes on with a CRC; it begins with 0. 14 instructions a byte. */
uint16_t dxl_crc(uint16_t crc, const uint8_t *bytes, uint32_t count);

/* ----------------------------------------------------------------------------------------- making packets -- */

/* Packets that are sent one behind the other, as bytes. What finds no room makes the whole unusable. */
enum { DXL_OUT_BYTES = 128 };
typedef struct {
    uint32_t count;  /* bytes of whole packets and of the one that is being made */
    uint32_t begins; /* of the packet that is being made */
    bool overflows;
    uint8_t bytes[DXL_OUT_BYTES];
} dxl_out_t;

/* begin, any number of adds, end. add stuffs; values have the low byte first. end: false when there was no room. */
void dxl_begin(dxl_out_t *out, uint8_t id, uint8_t instruction);
void dxl_add(dxl_out_t *out, uint32_t value, uint32_t bytes);
bool dxl_end(dxl_out_t *out);

/* Whole packets of one call. */
bool dxl_ask_ping(dxl_out_t *out, uint8_t id);
bool dxl_ask_read(dxl_out_t *out, uint8_t id, uint16_t address, uint16_t count);
bool dxl_ask_write(dxl_out_t *out, uint8_t id, uint16_t address, uint32_t value, uint32_t bytes);
bool dxl_ask_reboot(dxl_out_t *out, uint8_t id);

/* --------------------------------------------------------------------------------------- reading packets -- */

enum { DXL_IN_BYTES = 160 };

typedef struct {
    uint32_t count;
    uint32_t handed;   /* bytes of the packet that was handed out last; they leave with the next call */
    uint32_t damaged;  /* packets whose CRC or length is wrong; saturates */
    uint32_t skipped;  /* bytes that belonged to no sound packet; saturates */
    uint8_t bytes[DXL_IN_BYTES];
} dxl_receiver_t;

/* A sound packet. parameters points into the receiver and is valid until its next call. */
typedef struct {
    uint8_t id, instruction;
    const uint8_t *parameters; /* with the stuffing still in it: see dxl_unstuff */
    uint32_t count;
} dxl_packet_t;

void dxl_receiver_start(dxl_receiver_t *receiver);

/* Forgets what has come, and goes on counting. */
void dxl_receiver_clear(dxl_receiver_t *receiver);

/* Takes bytes that have come; returns how many found room. */
uint32_t dxl_receiver_take(dxl_receiver_t *receiver, const uint8_t *bytes, uint32_t count);

/* The next sound packet among what has come. After damage it looks for the next header behind the damaged one's, and
 * loses no sound packet. false: nothing more. At most DXL_IN_BYTES steps; a CRC for each header found. */
bool dxl_receiver_next(dxl_receiver_t *receiver, dxl_packet_t *packet);

/* Copies a packet's parameters without the stuffing; returns how many they are, or room + 1 when they are more. */
uint32_t dxl_unstuff(const dxl_packet_t *packet, uint8_t *bytes, uint32_t room);

/* What one servo said. */
typedef struct {
    uint8_t id, error;
    const uint8_t *data;
} dxl_answer_t;

/* The part of servo `index` in an answer to a fast sync read of `servos` servos with `count` bytes each. Each part has
 * its own CRC, which the last one's covers; so a sound packet's parts are sound. false: the packet is no such
 * answer. */
bool dxl_fast_answer(const dxl_packet_t *packet, uint32_t servos, uint32_t count, uint32_t index, dxl_answer_t *answer);

#endif
