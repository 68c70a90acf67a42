/* The door (brace_hal.h) on Arm's MPS2 board with the AN385 or AN386 image, as emulators have it.
 *
 * Time comes from the board's counter. There are three serial ports (CMSDK UARTs 0-2: console, Modbus, SLCAN) and the
 * CMSDK watchdog. Two slots in RAM stand in for non-volatile memory, and the caller gives the joints. There is no CAN
 * controller and no force sensor.
 *
 * There is one board and one instance; the state is static. Interrupt handlers, to be listed in the vector table:
 *   exception 2 (NMI)  the watchdog's first time-out; the board's own, see mps2_board_t
 *   n = 0, 2, 4        uart0_rx_handler, uart1_rx_handler, uart2_rx_handler (exception number 16 + n)
 */
#ifndef BRACE_HAL_MPS2_H
#define BRACE_HAL_MPS2_H

#include "brace_hal.h"

enum { MPS2_NVM_SLOT_BYTES = 4096, MPS2_NVM_BYTES = BRACE_NVM_SLOT_COUNT * MPS2_NVM_SLOT_BYTES };

/* The processor's clock, which SysTick counts [Hz]. */
enum { MPS2_CORE_HZ = 25000000 };

typedef struct {
    const char *name; /* for the banner */

    uint8_t *nvm; /* MPS2_NVM_BYTES bytes that a reset does not clear */

    /* Start the watchdog: after 3 s without a feed it raises the NMI, after another 3 s it resets the processor. The
     * board's NMI handler says where the processor hung. */
    bool watchdog;

    /* As joint_read of brace_hal.h, with a null context; null: the board has no joints. */
    int32_t (*joint_read)(void *context, int32_t joint_index, brace_hal_joint_t *joint);

    /* The start-up code's functions for these entries of brace_hal.h, with a null context. */
    brace_reset_cause_t (*reset_cause)(void *context);
    int32_t (*crash_read)(void *context, brace_crash_record_t *record);
    void (*crash_clear)(void *context);
    uint32_t (*stack_unused_bytes)(void *context);
    void (*restart)(void *context);
} mps2_board_t;

/* Starts time and watchdog; the serial ports start with serial_setup. board: lives as long as the firmware.
 * Returns the filled door, static; never null. Call once, from main. Does not wait for anything.
 *
 *   now_us        1 MHz counter, steps of 1 us
 *   serial_setup  sets baud [1200, 1500000]; accepts a parity without effect, because an emulator passes bytes and no
 *                 bits
 *   serial_write  writes to the transmitter as many bytes as it takes at once
 *   serial_read   reads a ring of 512 bytes
 *   nvm_...       RAM that a reset keeps and the emulator's end does not; write unit 4
 */
const brace_hal_t *brace_hal_mps2(const mps2_board_t *board);

/* The same counter, for a fault handler. Before brace_hal_mps2 it returns 0 or a time of an earlier run. */
uint32_t mps2_now_us(void);

void uart0_rx_handler(void);
void uart1_rx_handler(void);
void uart2_rx_handler(void);

#endif
