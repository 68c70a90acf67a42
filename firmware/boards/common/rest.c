#include "rest.h"

#include "board.h"
#include "cortex_m.h"
#include "fault.h"

enum { US_PER_S = 1000000, REST_MOST_US = 10000 }; /* SysTick has 24 bits: 99 ms at 168 MHz */
enum { AWAKE_US = 5000 };                          /* more than 3.5 characters at 9600 bit/s */

static int32_t (*serial_read)(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room);
static uint32_t last_byte_us;

static int32_t watched_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    const int32_t count = serial_read(context, port, bytes, room);
    if (count > 0) {
        last_byte_us = board_now_us();
    }
    return count;
}

void rest_start(brace_hal_t *door)
{
    serial_read = door->serial_read;
    door->serial_read = watched_read;
}

void rest(uint32_t at_most_us)
{
    if (board_now_us() - last_byte_us < (uint32_t)AWAKE_US) {
        return;
    }
    const uint32_t us = at_most_us < (uint32_t)REST_MOST_US ? at_most_us : (uint32_t)REST_MOST_US;
    __asm__ volatile("cpsid i" ::: "memory"); /* an interrupt that comes now ends the sleep, and is taken behind it */
    SYSTICK_LOAD = us * (board_core_hz() / (uint32_t)US_PER_S);
    SYSTICK_VALUE = 0u;
    SYSTICK_CONTROL = SYSTICK_ON_CORE_CLOCK_WITH_INTERRUPT;
    __asm__ volatile("dsb\n\twfi" ::: "memory");
    SYSTICK_CONTROL = 0u;
    SCB_ICSR = ICSR_FORGET_SYSTICK; /* its exception stays one that nobody expects */
    __asm__ volatile("dsb\n\tcpsie i" ::: "memory");
}
