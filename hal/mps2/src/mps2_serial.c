/* CMSDK UARTs: calls write to them directly; an interrupt reads them into a ring. The ring has one writer (the handler)
 * and one reader; each moves only its own index. */
#include "mps2_serial.h"

#include "brace_hal_mps2.h"
#include "mps2_registers.h"

enum { RING_BYTES = 512, UART_COUNT = 3, BAUD_MIN = 1200 };

typedef struct {
    uint8_t bytes[RING_BYTES];
    volatile uint32_t written, read; /* counts since start, modulo 2^32 */
} ring_t;

static ring_t rings[UART_COUNT];
static cmsdk_uart_t *const uarts[UART_COUNT] = {UART0, UART1, UART2};
static const uint8_t receive_irq[UART_COUNT] = {UART0_RX_IRQ, UART1_RX_IRQ, UART2_RX_IRQ};

int32_t mps2_serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    (void)context;
    if ((uint32_t)port >= UART_COUNT) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (baud < BAUD_MIN || baud > MPS2_CORE_HZ / UART_BAUD_DIVIDER_MIN || (uint32_t)parity > BRACE_PARITY_ODD) {
        return BRACE_HAL_E_RANGE;
    }
    cmsdk_uart_t *const uart = uarts[port];
    uart->control = 0u;
    uart->baud_divider = (MPS2_CORE_HZ + baud / 2u) / baud;
    uart->control = UART_CONTROL_TX | UART_CONTROL_RX | UART_CONTROL_RX_INTERRUPT;
    NVIC_ENABLE = 1u << receive_irq[port];
    return BRACE_HAL_OK;
}

int32_t mps2_serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    if ((uint32_t)port >= UART_COUNT) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    cmsdk_uart_t *const uart = uarts[port];
    uint32_t taken = 0u;
    /* at most count bytes, of a message */
    while (taken < count && (uart->state & UART_STATE_TX_FULL) == 0u) {
        uart->data = bytes[taken];
        taken++;
    }
    return (int32_t)taken;
}

int32_t mps2_serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    if ((uint32_t)port >= UART_COUNT) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    ring_t *const ring = &rings[port];
    const uint32_t waiting = ring->written - ring->read;
    const uint32_t count = waiting < room ? waiting : room;
    for (uint32_t i = 0u; i < count; i++) { /* at most RING_BYTES */
        bytes[i] = ring->bytes[(ring->read + i) % RING_BYTES];
    }
    ring->read += count;
    return (int32_t)count;
}

/* Takes one byte a call, because the receiver holds one. When the ring is full the newest byte is lost, and the frame's
 * check fails. */
static void receive(uint32_t index)
{
    cmsdk_uart_t *const uart = uarts[index];
    ring_t *const ring = &rings[index];
    uart->interrupt = UART_INTERRUPT_RX;
    if ((uart->state & UART_STATE_RX_FULL) == 0u) {
        return;
    }
    const uint8_t byte = (uint8_t)uart->data;
    uart->state = UART_STATE_RX_OVERRUN; /* writing the bit clears it */
    if (ring->written - ring->read < RING_BYTES) {
        ring->bytes[ring->written % RING_BYTES] = byte;
        ring->written++;
    }
}

void uart0_rx_handler(void)
{
    receive(0u);
}

void uart1_rx_handler(void)
{
    receive(1u);
}

void uart2_rx_handler(void)
{
    receive(2u);
}
