/* RAM that stands in for non-volatile memory on emulated boards: a reset keeps it, power-on clears it.
 *
 * It begins with the 16 characters "BRACE-NVM-IN-RAM"; without them it is set to 0xff. An emulator may load a file of
 * this marker and the slots to the address of _kept_nvm, to start a controller with parameters.
 */
#ifndef BRACE_BOARDS_KEPT_NVM_H
#define BRACE_BOARDS_KEPT_NVM_H

#include <stdint.h>

/* Address of the first slot; the second follows it. Both are erased first when the marker is missing. */
uint8_t *kept_nvm_start(uint32_t slots_bytes);

#endif
