#include "report/frames.h"

static void put_u16(uint8_t *bytes, uint32_t value)
{
    bytes[0] = (uint8_t)value;
    bytes[1] = (uint8_t)(value >> 8);
}

static void put_u32(uint8_t *bytes, uint32_t value)
{
    put_u16(bytes, value);
    put_u16(bytes + 2, value >> 16);
}

static uint8_t state_of(brace_mode_t mode)
{
    switch (mode) {
    case BRACE_MODE_START: return 0x00;
    case BRACE_MODE_CONFIGURATION: return 0x7f;
    case BRACE_MODE_FAULT: return 0x04;
    default: return 0x05;
    }
}

void frame_heartbeat(brace_can_frame_t *frame, uint8_t node_id, brace_mode_t mode, uint32_t faults)
{
    frame->id = 0x700u + node_id;
    frame->length = 8;
    frame->fd = false;
    frame->data[0] = state_of(mode);
    frame->data[1] = (uint8_t)mode;
    put_u16(&frame->data[2], faults);
    put_u32(&frame->data[4], BRACE_SCHEMA_HASH);
}

/* CANopen's ranges: 0x5000 device hardware, 0x6000 software and data, 0x7000 additional modules, 0x8000
 * monitoring. */
static const uint16_t code[] = {0x7300, 0x7300, 0x7305, 0x6100, 0x6320, 0x5530, 0x8140, 0xff01, 0x6010};

uint16_t frame_emergency_code(uint32_t fresh, uint32_t faults)
{
    for (uint32_t bit = 0; bit < sizeof code / sizeof *code; bit++) {
        if ((fresh & (1u << bit)) != 0u) {
            return code[bit];
        }
    }
    return faults != 0u ? 0x1000 : 0;
}

void frame_emergency(brace_can_frame_t *frame, uint8_t node_id, uint32_t faults_before, uint32_t faults,
                     brace_mode_t mode)
{
    frame->id = 0x080u + node_id;
    frame->length = 8;
    frame->fd = false;
    put_u16(frame->data, frame_emergency_code(faults & ~faults_before, faults));
    frame->data[2] = (uint8_t)mode;
    frame->data[3] = 0;
    put_u32(&frame->data[4], faults);
}
