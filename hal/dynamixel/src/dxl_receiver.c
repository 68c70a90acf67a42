#include "brace_dxl_packet.h"

enum { LENGTH_BEHIND = 7, LENGTH_LEAST = 3 }; /* bytes before what the length counts; instruction and CRC */

void dxl_receiver_start(dxl_receiver_t *receiver)
{
    *receiver = (dxl_receiver_t){.count = 0};
}

void dxl_receiver_clear(dxl_receiver_t *receiver)
{
    receiver->count = receiver->handed = 0;
}

static void count_up(uint32_t *counter)
{
    *counter += *counter < UINT32_MAX ? 1u : 0u;
}

uint32_t dxl_receiver_take(dxl_receiver_t *receiver, const uint8_t *bytes, uint32_t count)
{
    const uint32_t room = DXL_IN_BYTES - receiver->count;
    const uint32_t taken = count < room ? count : room;
    for (uint32_t i = 0; i < taken; i++) { /* at most DXL_IN_BYTES */
        receiver->bytes[receiver->count + i] = bytes[i];
    }
    receiver->count += taken;
    return taken;
}

/* May a header begin here, as far as its bytes have come? */
static bool may_begin(const uint8_t *bytes, uint32_t count)
{
    static const uint8_t header[4] = {0xff, 0xff, 0xfd, 0x00};
    bool may = true;
    for (uint32_t i = 0; i < 4u && i < count; i++) {
        may = may && bytes[i] == header[i];
    }
    return may;
}

/* Drops a packet, or the first byte of what is none, and all bytes behind with which no header begins. */
static void drop(dxl_receiver_t *receiver, uint32_t first, bool is_sound)
{
    uint32_t from = first;
    /* at most DXL_IN_BYTES */
    while (from < receiver->count && !may_begin(&receiver->bytes[from], receiver->count - from)) {
        from++;
    }
    for (uint32_t i = is_sound ? first : 0u; i < from; i++) { /* at most DXL_IN_BYTES */
        count_up(&receiver->skipped);
    }
    for (uint32_t i = from; i < receiver->count; i++) { /* at most DXL_IN_BYTES */
        receiver->bytes[i - from] = receiver->bytes[i];
    }
    receiver->count -= from;
}

bool dxl_receiver_next(dxl_receiver_t *receiver, dxl_packet_t *packet)
{
    const uint8_t *bytes = receiver->bytes;
    if (receiver->handed > 0u) {
        drop(receiver, receiver->handed, true);
        receiver->handed = 0;
    } else if (!may_begin(bytes, receiver->count)) {
        drop(receiver, 1u, false);
    }
    for (uint32_t step = 0; step < DXL_IN_BYTES && receiver->count >= LENGTH_BEHIND; step++) {
        const uint32_t length = bytes[5] | (uint32_t)bytes[6] << 8;
        const uint32_t whole = LENGTH_BEHIND + length;
        const bool fits = length >= LENGTH_LEAST && whole <= DXL_IN_BYTES;
        if (fits && receiver->count < whole) {
            return false;
        }
        if (fits && dxl_crc(0, bytes, whole - 2u) == (bytes[whole - 2u] | (uint32_t)bytes[whole - 1u] << 8)) {
            *packet =
                (dxl_packet_t){bytes[4], bytes[7], &bytes[DXL_HEAD_BYTES], whole - DXL_HEAD_BYTES - DXL_CRC_BYTES};
            receiver->handed = whole;
            return true;
        }
        count_up(&receiver->damaged);
        drop(receiver, 1u, false);
    }
    return false;
}

uint32_t dxl_unstuff(const dxl_packet_t *packet, uint8_t *bytes, uint32_t room)
{
    const uint8_t *from = packet->parameters; /* the instruction and the length stand before it */
    uint32_t count = 0;
    for (uint32_t i = 0; i < packet->count && count <= room; i++) { /* at most DXL_IN_BYTES */
        const bool is_stuffing = i > 0u && from[i] == 0xfdu && from[(int32_t)i - 1] == 0xfdu &&
                                 from[(int32_t)i - 2] == 0xffu && from[(int32_t)i - 3] == 0xffu;
        if (!is_stuffing) {
            if (count < room) {
                bytes[count] = from[i];
            }
            count++;
        }
    }
    return count;
}

bool dxl_fast_answer(const dxl_packet_t *packet, uint32_t servos, uint32_t count, uint32_t index, dxl_answer_t *answer)
{
    const uint32_t part = 2u + count + DXL_CRC_BYTES;
    if (packet->id != DXL_ID_ALL || packet->instruction != DXL_STATUS || index >= servos ||
        packet->count + DXL_CRC_BYTES != servos * part) {
        return false;
    }
    const uint8_t *bytes = &packet->parameters[index * part];
    *answer = (dxl_answer_t){.id = bytes[1], .error = bytes[0], .data = &bytes[2]};
    return true;
}
