#include "rest.h"

#include "cortex_m.h"

enum { US_PER_S = 1000000, REST_MOST_US = 10000 }; /* SysTick has 24 bits: 99 ms at 168 MHz */
enum { FRAME_ENDS_US = 21000 };                    /* behind the patience of the Modbus line, 20 ms */

static brace_hal_t unwatched;
static bool is_in_frame;
static uint32_t last_byte_us;
static uint32_t systick_per_us;

static uint32_t now_us(void)
{
    return unwatched.now_us(unwatched.context);
}

static int32_t watched_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    const int32_t count = unwatched.serial_read(context, port, bytes, room);
    if (port == BRACE_SERIAL_MODBUS && count > 0) {
        is_in_frame = true;
        last_byte_us = now_us();
    }
    return count;
}

static int32_t watched_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    if (port == BRACE_SERIAL_MODBUS) { /* the answer to a whole frame */
        is_in_frame = false;
    }
    return unwatched.serial_write(context, port, bytes, count);
}

void rest_start(brace_hal_t *door, uint32_t core_hz)
{
    systick_per_us = core_hz / (uint32_t)US_PER_S;
    unwatched = *door;
    door->serial_read = watched_read;
    door->serial_write = watched_write;
}

void rest_sleep(uint32_t at_most_us)
{
    is_in_frame = is_in_frame && now_us() - last_byte_us < (uint32_t)FRAME_ENDS_US;
    if (is_in_frame) {
        return;
    }
    const uint32_t us = at_most_us < (uint32_t)REST_MOST_US ? at_most_us : (uint32_t)REST_MOST_US;
    __asm__ volatile("cpsid i" ::: "memory"); /* an interrupt that comes now ends the sleep, and is taken behind it */
    SYSTICK_LOAD = us * systick_per_us;
    SYSTICK_VALUE = 0u;
    SYSTICK_CONTROL = SYSTICK_ON_CORE_CLOCK_WITH_INTERRUPT;
    __asm__ volatile("dsb\n\twfi" ::: "memory");
    SYSTICK_CONTROL = 0u;
    SCB_ICSR = ICSR_FORGET_SYSTICK; /* its exception stays one that nobody expects */
    __asm__ volatile("dsb\n\tcpsie i" ::: "memory");
}
