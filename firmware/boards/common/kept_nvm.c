#include "kept_nvm.h"

extern uint8_t _kept_nvm[];

enum { MARKER_BYTES = 16, ERASED = 0xff };

uint8_t *kept_nvm_start(uint32_t slots_bytes)
{
    static const uint8_t marker[MARKER_BYTES] = "BRACE-NVM-IN-RAM"; /* no closing zero */
    uint32_t differ = 0u;
    for (uint32_t i = 0u; i < MARKER_BYTES; i++) {
        differ |= (uint32_t)(_kept_nvm[i] ^ marker[i]);
    }
    uint8_t *const slots = _kept_nvm + MARKER_BYTES;
    if (differ != 0u) {
        for (uint32_t i = 0u; i < slots_bytes; i++) { /* at most what the linker script keeps */
            slots[i] = ERASED;
        }
        for (uint32_t i = 0u; i < MARKER_BYTES; i++) {
            _kept_nvm[i] = marker[i];
        }
    }
    return slots;
}
