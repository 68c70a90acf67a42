/* The door (brace_hal.h) on an STM32F405, 407, 415 or 417: clocks, time, USARTs, bxCAN, flash, watchdog.
 *
 * What is the chip's is here; what is the board's (pins, crystal, joints, where a crash record lies) comes in through
 * stm32f405_board_t. Registers as in ST's reference manual RM0090, times and currents as in the data sheet DS8626.
 * The layer was judged by register models written from that manual (tests/silicon_model) and on QEMU's netduinoplus2,
 * which has the USARTs and timers; neither is silicon.
 *
 * One chip, one instance: the state is static and belongs to this layer. Interrupt handlers move bytes and frames
 * between registers and ring buffers, are bounded and use no floating point. One caller, not from an interrupt, as
 * brace_hal.h says.
 *
 * What stays the board's: start-up code and vector table, with these handlers in it (exception number = 16 + n):
 *   n = 20 can1_rx0_handler, 37 usart1_handler, 38 usart2_handler, 39 usart3_handler
 * Instructions of one call: at most 200 with a full receive FIFO, 120 with a byte in and two out.
 * The FPU, if used, is switched on by the start-up code. SysTick is free for the board.
 */
#ifndef BRACE_HAL_STM32F405_H
#define BRACE_HAL_STM32F405_H

#include "brace_hal.h"

/* A pin by its port 'A'-'I' and number 0-15; port 0: not connected. */
typedef struct {
    char port;
    uint8_t number;
} stm32f405_pin_t;

/* A serial port: which USART, on which pins (alternate function 7). */
typedef struct {
    uint8_t usart;                /* 1, 2 or 3; 0: the board has no such port */
    stm32f405_pin_t tx, rx;       /* 1: PA9 PA10, PB6 PB7; 2: PA2 PA3, PD5 PD6; 3: PB10 PB11, PD8 PD9 */
    stm32f405_pin_t drive_enable; /* of an RS-485 transceiver: high from the first bit sent to the last */
} stm32f405_serial_t;

/* Clocks that already run when the firmware starts. An emulator's RCC does nothing, so it can only be told. */
typedef struct {
    uint32_t core_hz;
    uint32_t apb1_hz, apb2_hz; /* of the buses: CAN, USART2, USART3 on the first, USART1 on the second */
    uint32_t timer_hz;         /* of TIM2: twice APB1 when APB1 is divided */
} stm32f405_clocks_t;

/* The limb's joints and force sensor, which are the board's. Entries and answers as in brace_hal.h, context is this
 * struct's. Null entries: the board has no such thing; read null: joint_read answers E_UNSUPPORTED. */
typedef struct {
    void *context;
    int32_t (*read)(void *context, int32_t joint_index, brace_hal_joint_t *joint);
    int32_t (*command)(void *context, int32_t joint_index, const brace_hal_joint_command_t *command);
    int32_t (*tip_force_read)(void *context, float *force_x_n, float *force_z_n);
} stm32f405_joints_t;

typedef struct {
    const char *name; /* for the banner */

    /* Crystal [4e6, 26e6], whole MHz; 0: none. Without one, or when it does not start within 0.1 s, the chip's own
     * 16 MHz oscillator (1 %, -8 % to 4.5 % over temperature) feeds the PLL: same speed, and CAN may then listen only,
     * since it would disturb the bus. */
    uint32_t hse_hz;
    const stm32f405_clocks_t *clocks_given; /* null: set the clocks up, 168 MHz */

    stm32f405_serial_t serial[BRACE_SERIAL_PORT_COUNT];
    stm32f405_pin_t can_rx, can_tx; /* CAN1, alternate function 9: PA11, PB8 or PD0; PA12, PB9 or PD1; none: no CAN */

    /* The two slots of non-volatile memory: two different flash sectors that the image leaves free, equal in size
     * (1-3: 16 KiB at 0x08004000, 0x08008000, 0x0800c000; 5-11: 128 KiB at 0x08020000 and on). Needs a supply of
     * 2.7 V or more. */
    uint8_t nvm_sector[BRACE_NVM_SLOT_COUNT];
    /* Instead of flash, for emulators: BRACE_NVM_SLOT_COUNT * STM32F405_NVM_RAM_SLOT_BYTES bytes that a reset does not
     * clear, 4-aligned; null: flash. */
    uint8_t *nvm_ram;

    bool watchdog; /* start the independent watchdog; once started it can not be stopped */

    const stm32f405_joints_t *joints; /* null: none */

    /* The start-up code's account of the last crash and of the stack, as brace_hal.h's entries; the context handed
     * to them is null. Null entries: nothing is known. */
    bool reset_by_fault; /* the last reset was the fault handler's */
    int32_t (*crash_read)(void *context, brace_crash_record_t *record);
    void (*crash_clear)(void *context);
    uint32_t (*stack_unused_bytes)(void *context);
} stm32f405_board_t;

enum { STM32F405_NVM_RAM_SLOT_BYTES = 4096 };

/* Where an image's vector table and code may not be: addresses and sizes of a sector 0-11 [byte]; 0 out of range. */
uint32_t stm32f405_sector_address(uint8_t sector);
uint32_t stm32f405_sector_bytes(uint8_t sector);

/* Starts clocks, time, pins, watchdog; the serial ports start with serial_setup and CAN with can_setup.
 *
 * board: lives as long as the firmware. Returns the filled door, static; never null. What the chip does not answer is
 * left out instead of waited for: see stm32f405_clock_report.
 * Worst case 0.4 s, when neither crystal nor PLL starts; 5 ms typical. Call once, from main. Stack below 200 bytes.
 *
 * Specific to this chip, within what brace_hal.h allows:
 *   now_us       TIM2 at 1 MHz, goes on while flash is erased; steps of 1 us
 *   serial_*     rings of 512 bytes each way; a byte with a parity or framing error is dropped, so a frame's check
 *                fails; baud [1200, 2e6] that the clock meets to 2 %, else E_RANGE
 *   can_setup    E_UNSUPPORTED: no pins, or CAN FD asked for; E_RANGE: bit rate not to be had from APB1; E_DEVICE: the
 *                controller does not answer (an emulator), the bus is held dominant, or there is no crystal and
 *                neither listen_only nor loopback is asked for
 *   can_send     three mailboxes, first in first out whatever the identifiers, so order is kept; AGAIN when all three
 *                are full; E_UNSUPPORTED when listening only
 *   can_receive  ring of 64 frames; extended and remote frames are turned away by the filter
 *   can_recover  forgets the frames that wait in the mailboxes: they are stale by then
 *   nvm_write    whole words of 4 bytes: 16 us each, 100 us at most; in one call up to 10 words are within 1 ms surely
 *   nvm_erase    16 KiB: 0.25 s, at most 0.5 s; 128 KiB: 1 s, at most 2 s. The processor stands still; the watchdog is
 *                fed before. E_DEVICE: protected, or not finished in twice that time
 *   watchdog     3.5 s by the LSI as measured at the start, 2.8 s at the fastest; where it can not be measured, by
 *                its nominal 32 kHz
 *   restart      SYSRESETREQ
 */
const brace_hal_t *brace_hal_stm32f405(const stm32f405_board_t *board);

/* What the clocks came to, for the banner. */
typedef struct {
    stm32f405_clocks_t clocks;
    bool crystal;   /* the crystal feeds them */
    bool pll;       /* the PLL runs; else 16 MHz */
} stm32f405_clock_report_t;
stm32f405_clock_report_t stm32f405_clock_report(void);

void can1_rx0_handler(void);
void usart1_handler(void);
void usart2_handler(void);
void usart3_handler(void);

#endif
