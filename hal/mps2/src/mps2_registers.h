/* Registers of the MPS2 board's AN385/AN386 image that this layer uses. Sources: Arm DAI 0385D (memory map, FPGAIO),
 * Arm DDI 0479D (Cortex-M System Design Kit: UART, watchdog). */
#ifndef MPS2_REGISTERS_H
#define MPS2_REGISTERS_H

#include <stdint.h>

typedef struct {
    volatile uint32_t data, state, control, interrupt, baud_divider;
} cmsdk_uart_t;

enum {
    UART_STATE_TX_FULL = 1u << 0,
    UART_STATE_RX_FULL = 1u << 1,
    UART_STATE_RX_OVERRUN = 1u << 3,
    UART_CONTROL_TX = 1u << 0,
    UART_CONTROL_RX = 1u << 1,
    UART_CONTROL_RX_INTERRUPT = 1u << 3,
    UART_INTERRUPT_RX = 1u << 1,
    UART_BAUD_DIVIDER_MIN = 16
};

#define UART0 ((cmsdk_uart_t *)0x40004000u)
#define UART1 ((cmsdk_uart_t *)0x40005000u)
#define UART2 ((cmsdk_uart_t *)0x40006000u)

/* Interrupt numbers of the receivers. */
enum { UART0_RX_IRQ = 0, UART1_RX_IRQ = 2, UART2_RX_IRQ = 4 };

typedef struct {
    volatile uint32_t load, value, control, clear;
} cmsdk_watchdog_t;

enum { WATCHDOG_CONTROL_INTERRUPT = 1u << 0, WATCHDOG_CONTROL_RESET = 1u << 1 };

#define WATCHDOG ((cmsdk_watchdog_t *)0x40008000u)

/* FPGAIO: a counter that advances once in prescale + 1 periods of 25 MHz. */
#define FPGAIO_COUNTER (*(volatile uint32_t *)0x40028018u)
#define FPGAIO_PRESCALE (*(volatile uint32_t *)0x4002801Cu)
enum { FPGAIO_HZ = 25000000 };

#define NVIC_ENABLE (*(volatile uint32_t *)0xE000E100u) /* interrupts 0-31 */

#endif
