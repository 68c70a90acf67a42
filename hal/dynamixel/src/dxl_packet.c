#include "brace_dxl_packet.h"

uint16_t dxl_crc(uint16_t crc, const uint8_t *bytes, uint32_t count)
{
    static const uint16_t of_nibble[16] = {0x0000, 0x8005, 0x800f, 0x000a, 0x801b, 0x001e, 0x0014, 0x8011,
                                           0x8033, 0x0036, 0x003c, 0x8039, 0x0028, 0x802d, 0x8027, 0x0022};
    for (uint32_t i = 0; i < count; i++) { /* at most DXL_IN_BYTES, a packet */
        crc = (uint16_t)(crc << 4) ^ of_nibble[(crc >> 12) ^ (bytes[i] >> 4)];
        crc = (uint16_t)(crc << 4) ^ of_nibble[(crc >> 12) ^ (bytes[i] & 0xfu)];
    }
    return crc;
}

static void put(dxl_out_t *out, uint8_t byte)
{
    if (out->count < DXL_OUT_BYTES) {
        out->bytes[out->count++] = byte;
    } else {
        out->overflows = true;
    }
}

/* A byte behind the length. */
static void put_stuffed(dxl_out_t *out, uint8_t byte)
{
    put(out, byte);
    const uint8_t *last = &out->bytes[out->count];
    if (byte == 0xfdu && out->count >= out->begins + DXL_HEAD_BYTES + 3u && last[-2] == 0xffu && last[-3] == 0xffu) {
        put(out, 0xfdu);
    }
}

void dxl_begin(dxl_out_t *out, uint8_t id, uint8_t instruction)
{
    out->begins = out->count;
    put(out, 0xffu);
    put(out, 0xffu);
    put(out, 0xfdu);
    put(out, 0u);
    put(out, id);
    put(out, 0u); /* the length, by dxl_end */
    put(out, 0u);
    put(out, instruction);
}

void dxl_add(dxl_out_t *out, uint32_t value, uint32_t bytes)
{
    for (uint32_t i = 0; i < bytes && i < 4u; i++) {
        put_stuffed(out, (uint8_t)(value >> (8u * i)));
    }
}

bool dxl_end(dxl_out_t *out)
{
    if (out->overflows || out->count + DXL_CRC_BYTES > DXL_OUT_BYTES) {
        out->overflows = true;
        return false;
    }
    uint8_t *packet = &out->bytes[out->begins];
    const uint32_t counted = out->count - out->begins;
    const uint32_t length = counted - (DXL_HEAD_BYTES - 1u) + DXL_CRC_BYTES;
    packet[5] = (uint8_t)length;
    packet[6] = (uint8_t)(length >> 8);
    const uint16_t crc = dxl_crc(0, packet, counted);
    put(out, (uint8_t)crc);
    put(out, (uint8_t)(crc >> 8));
    return true;
}

bool dxl_ask_ping(dxl_out_t *out, uint8_t id)
{
    dxl_begin(out, id, DXL_PING);
    return dxl_end(out);
}

bool dxl_ask_read(dxl_out_t *out, uint8_t id, uint16_t address, uint16_t count)
{
    dxl_begin(out, id, DXL_READ);
    dxl_add(out, address, 2);
    dxl_add(out, count, 2);
    return dxl_end(out);
}

bool dxl_ask_write(dxl_out_t *out, uint8_t id, uint16_t address, uint32_t value, uint32_t bytes)
{
    dxl_begin(out, id, DXL_WRITE);
    dxl_add(out, address, 2);
    dxl_add(out, value, bytes);
    return dxl_end(out);
}

bool dxl_ask_reboot(dxl_out_t *out, uint8_t id)
{
    dxl_begin(out, id, DXL_REBOOT);
    return dxl_end(out);
}
