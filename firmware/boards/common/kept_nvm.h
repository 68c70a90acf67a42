/* RAM that stands in for non-volatile memory on emulated boards: kept over a reset, blank at power-on.
 *
 * It begins with the 16 characters "BRACE-NVM-IN-RAM"; without them it is erased to 0xff. An emulator may load a
 * file of marker and slots to the address of _kept_nvm, to start a controller with parameters.
 */
#ifndef BRACE_BOARDS_KEPT_NVM_H
#define BRACE_BOARDS_KEPT_NVM_H

#include <stdint.h>

/* Where the slots begin, one behind the other; erased first when nothing sound is there. */
uint8_t *kept_nvm_start(uint32_t slots_bytes);

#endif
