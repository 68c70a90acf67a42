/* The door (brace_hal.h) on an STM32F405, 407, 415 or 417: clocks, time, USARTs, bxCAN, flash, watchdog.
 *
 * This layer has what belongs to the chip. What belongs to the board (pins, crystal, joints, place of a crash record)
 * comes in through stm32f405_board_t. Registers are those of ST's reference manual RM0090, times and currents those of
 * the data sheet DS8626. The layer was judged by register models written from that manual (tests/silicon_model) and on
 * QEMU's netduinoplus2, which has the USARTs and timers; neither is silicon.
 *
 * There is one chip and one instance; the state is static and belongs to this layer. Interrupt handlers move bytes and
 * frames between registers and ring buffers, are bounded and use no floating point. One caller, not from an interrupt,
 * as brace_hal.h says.
 *
 * The board provides start-up code and a vector table with these handlers in it (exception number = 16 + n):
 *   exception 2 nmi_handler: the crystal has stopped
 *   n = 20 can1_rx0_handler, 37 usart1_handler, 38 usart2_handler, 39 usart3_handler, 71 usart6_handler
 * One call of a handler: at most 200 instructions with a full receive FIFO, 120 with a byte in and two out.
 * The start-up code switches the FPU on, if it is used. SysTick is free for the board.
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
    stm32f405_pin_t drive_enable; /* pin that enables an RS-485 transmitter: high from the first bit sent to the last */
} stm32f405_serial_t;

/* Clocks that already run when the firmware starts. An emulator's RCC does nothing, so the board has to give its
 * rates. */
typedef struct {
    uint32_t core_hz;
    uint32_t apb1_hz, apb2_hz; /* rates of the buses: CAN, USART2, USART3 on the first, USART1 on the second */
    uint32_t timer_hz; /* rate of TIM2: twice APB1 when APB1 is divided */
} stm32f405_clocks_t;

/* A half-duplex line to servos: USART6, its bytes moved by DMA 2, streams 1 and 6. The direction pin is high from
 * before the first bit to behind the last. Set it up once, after brace_hal_stm32f405.
 *   baud [9600, 4500000] that the clock meets to 2 %
 *   is_polled: for emulators without DMA; bytes then move within the calls
 * returns OK, or E_RANGE */
typedef struct {
    stm32f405_pin_t tx, rx; /* PC6 PC7 or PG14 PG9, alternate function 8 */
    stm32f405_pin_t drive_enable;
    uint32_t baud;
    bool is_polled;
} stm32f405_servo_line_t;
int32_t stm32f405_servo_line(const stm32f405_servo_line_t *wires);

/* send takes at most STM32F405_SERVO_LINE_BYTES and copies them: OK; AGAIN: it is still sending; E_RANGE. receive gives
 * what has come. Bytes that come faster than they are taken overwrite one another after 256. The context is ignored. */
enum { STM32F405_SERVO_LINE_BYTES = 128 };
int32_t stm32f405_servo_send(void *context, const uint8_t *bytes, uint32_t count);
int32_t stm32f405_servo_receive(void *context, uint8_t *bytes, uint32_t room);

/* The limb's joints and force sensor, which belong to the board. Entries and answers are those of brace_hal.h; the
 * context is this struct's. A null entry: the board has no such thing. With a null read, joint_read answers
 * E_UNSUPPORTED. */
typedef struct {
    void *context;
    int32_t (*read)(void *context, int32_t joint_index, brace_hal_joint_t *joint);
    int32_t (*command)(void *context, int32_t joint_index, const brace_hal_joint_command_t *command);
    int32_t (*tip_force_read)(void *context, float *force_x_n, float *force_z_n);
} stm32f405_joints_t;

typedef struct {
    const char *name; /* for the banner */

    /* Crystal [4e6, 26e6], whole MHz; 0: there is none. Without a crystal, or when it does not start within 0.1 s, the
     * chip's own 16 MHz oscillator (1 %, -8 % to 4.5 % over temperature) feeds the PLL. The speed is the same, but CAN
     * may then only listen, because an inexact clock would disturb the bus. */
    uint32_t hse_hz;
    const stm32f405_clocks_t *clocks_given; /* null: this layer sets the clocks up, 168 MHz */

    stm32f405_serial_t serial[BRACE_SERIAL_PORT_COUNT];
    stm32f405_pin_t can_rx, can_tx; /* CAN1, alternate function 9: PA11, PB8 or PD0; PA12, PB9 or PD1; none: no CAN */

    /* The two slots of non-volatile memory: two different flash sectors that the image leaves free, equal in size
     * (1-3: 16 KiB at 0x08004000, 0x08008000, 0x0800c000; 5-11: 128 KiB at 0x08020000 and on). Needs a supply of
     * 2.7 V or more. */
    uint8_t nvm_sector[BRACE_NVM_SLOT_COUNT];
    /* For emulators, instead of flash: BRACE_NVM_SLOT_COUNT * STM32F405_NVM_RAM_SLOT_BYTES bytes that a reset does not
     * clear, 4-aligned; null: flash. */
    uint8_t *nvm_ram;

    /* Set the brown-out reset to 2.8 V (an option of the flash, written once), and refuse to write flash below 2.9 V.
     * For a supply of 3.0 V or more. */
    bool guards_supply;

    /* The board is guarded: it keeps a key in the chip's one-time programmable memory, and refuses motion until it has
     * one. false: whoever is on its buses may move the limb. */
    bool keeps_key;

    bool watchdog; /* start the independent watchdog; once started it cannot be stopped */

    const stm32f405_joints_t *joints; /* null: the board has no joints */

    /* The start-up code's functions for these entries of brace_hal.h, called with a null context. Null entries: nothing
     * is known of the last crash and of the stack. */
    bool reset_by_fault; /* the fault handler made the last reset */
    int32_t (*crash_read)(void *context, brace_crash_record_t *record);
    void (*crash_clear)(void *context);
    uint32_t (*stack_unused_bytes)(void *context);
} stm32f405_board_t;

enum { STM32F405_NVM_RAM_SLOT_BYTES = 4096 };

/* Address and size of a sector 0-11 [byte], where an image's vector table and code must not lie; 0 out of range. */
uint32_t stm32f405_sector_address(uint8_t sector);
uint32_t stm32f405_sector_bytes(uint8_t sector);

/* Starts clocks, time, pins, watchdog; the serial ports start with serial_setup and CAN with can_setup.
 *
 * board: lives as long as the firmware. Returns the filled door, static; never null. A part of the chip that does not
 * answer is left out, and not waited for: see stm32f405_clock_report.
 * Worst case 0.4 s, when neither crystal nor PLL starts; 5 ms typical. Call once, from main. Stack below 200 bytes.
 *
 * Specific to this chip, within what brace_hal.h allows:
 *   now_us       TIM2 at 1 MHz, runs while flash is erased; steps of 1 us
 *   serial_*     rings of 512 bytes each way; a byte with a parity or framing error is dropped, so a frame's check
 *                fails; baud [1200, 2e6] that the clock meets to 2 %, else E_RANGE
 *   can_setup    E_UNSUPPORTED: no pins, or CAN FD asked for; E_RANGE: APB1 cannot give the bit rate; E_DEVICE: the
 *                controller does not answer (an emulator), or there is no crystal and neither listen_only nor loopback
 *                is asked for. On a bus that is held dominant, can_health reports bus_off until the bus is free
 *   can_send     three mailboxes, first in first out whatever the identifiers, so the order is kept; AGAIN when all
 *                three are full, or until the bus has been quiet once after can_setup; E_UNSUPPORTED when
 *                listening only. A frame that nobody takes for 100 ms is dropped by the next can_health
 *   can_receive  ring of 64 frames; the controller's filter rejects extended and remote frames, and other identifiers
 *   can_recover  drops the frames that wait in the mailboxes, because they are stale by then; E_DEVICE: the crystal was
 *                lost, and CAN stays off
 *   nvm_write    E_DEVICE while the supply is below 2.9 V and board.guards_supply is set; whole words of 4 bytes: 16 us
 *                each, 100 us at most; up to 10 words in one call always end within 1 ms
 *   nvm_erase    16 KiB: 0.25 s, at most 0.5 s; 128 KiB: 1 s, at most 2 s; before, up to 0.6 s until what is being sent
 *                has left. The processor stands still; the watchdog is fed before. E_DEVICE: the supply, as above;
 *                protected, or not finished in twice that time
 *   key_read     from the first block of one-time programmable memory (0x1fff7800) that holds a key. Nothing erases it.
 *                KEY_OPEN: its block is not locked; each start tries to lock it. E_DAMAGED: no key, and a block that is
 *                neither blank nor open
 *   key_write    once; 0.3 ms. It locks the block (0x1fff7a00), so that no image that is flashed later replaces the
 *                key. A write that the power cut costs one of 16 blocks. Others' blocks are left alone, but for bytes
 *                15 and 31 of a block before the key's that a key could be made of
 *   random_read  2 us, at most 20; E_DEVICE: without the PLL, whose clock the generator needs
 *   watchdog     3.5 s by the LSI as measured at the start, 2.8 s with the fastest LSI; where it cannot be measured, by
 *                its nominal 32 kHz
 *   restart      SYSRESETREQ
 */
const brace_hal_t *brace_hal_stm32f405(const stm32f405_board_t *board);

/* The clocks as they run, for the banner. */
typedef struct {
    stm32f405_clocks_t clocks;
    bool crystal; /* the crystal feeds them */
    bool pll; /* the PLL runs; else 16 MHz */
    bool crystal_was_lost; /* it stopped while it fed the clocks: CAN has stopped, and reports bus_off */
} stm32f405_clock_report_t;
stm32f405_clock_report_t stm32f405_clock_report(void);

void nmi_handler(void);
void can1_rx0_handler(void);
void usart1_handler(void);
void usart2_handler(void);
void usart3_handler(void);
void usart6_handler(void);

#endif
