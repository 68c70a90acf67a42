#include "report/frames.h"

static uint32_t state_of(brace_mode_t mode)
{
    switch (mode) {
    case BRACE_MODE_START: return 0x00;
    case BRACE_MODE_CONFIGURATION: return 0x7f;
    case BRACE_MODE_FAULT: return 0x04;
    default: return 0x05;
    }
}

void frame_heartbeat(uint8_t data[8], brace_mode_t mode, uint32_t faults)
{
    (void)brace_can_pack_heartbeat(
        &(brace_can_heartbeat_t){state_of(mode), mode, faults, BRACE_DICTIONARY_HASH}, data);
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

void frame_emergency(uint8_t data[8], uint32_t faults_before, uint32_t faults, brace_mode_t mode)
{
    const uint32_t error_code = frame_emergency_code(faults & ~faults_before, faults);
    (void)brace_can_pack_emergency(&(brace_can_emergency_t){error_code, faults != 0u, mode, faults}, data);
}
