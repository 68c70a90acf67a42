/* Serial ports: which exist, and do counts stay within what was given? The console is not read, so that no request is
 * lost. */
#include "selftest.h"

enum { BAUD = 115200, ROOM = 16 };

static const char *const names[BRACE_SERIAL_PORT_COUNT] = {"serial(console)", "serial(modbus)", "serial(slcan)",
                                                           "serial(modbus tcp)"};

static void one_port(selftest_t *test, brace_serial_port_t port)
{
    const brace_hal_t *const hal = test->hal;
    const char *const name = names[port];
    const int32_t answer = hal->serial_setup(hal->context, port, BAUD, BRACE_PARITY_NONE);
    if (answer == BRACE_HAL_E_UNSUPPORTED) {
        selftest_report(test, BRACE_SELFTEST_NOTE, name, "no such port on this board");
        return;
    }
    if (answer != BRACE_HAL_OK) {
        selftest_report_value(test, BRACE_SELFTEST_FAIL, name, "115200 baud without parity is refused", answer,
                              "answer");
        return;
    }
    uint8_t bytes[ROOM + 1];
    bytes[0] = bytes[ROOM] = 0x5au;
    const int32_t none_read = port == BRACE_SERIAL_CONSOLE ? 0 : hal->serial_read(hal->context, port, bytes, 0u);
    const int32_t none_written = hal->serial_write(hal->context, port, bytes, 0u);
    const bool nothing = none_read == 0 && none_written == 0 && bytes[0] == 0x5au;
    const int32_t read = port == BRACE_SERIAL_CONSOLE ? 0 : hal->serial_read(hal->context, port, bytes, ROOM);
    const bool within = read >= 0 && read <= ROOM && bytes[ROOM] == 0x5au;
    selftest_expect(test, nothing && within, name, "there, and its counts keep to the room given",
                    "a count is negative or larger than the room given, or bytes are written beyond it");
}

void selftest_serial(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    for (uint32_t port = 0u; port < BRACE_SERIAL_PORT_COUNT; port++) {
        one_port(test, (brace_serial_port_t)port);
    }
    const int32_t answer = hal->serial_setup(hal->context, BRACE_SERIAL_PORT_COUNT, BAUD, BRACE_PARITY_NONE);
    selftest_expect(test, answer < 0, "serial_setup", "a port that can not be is refused",
                    "port 4 is accepted: check the port first");
}
