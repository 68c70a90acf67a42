// A serial line's settings: speed, parity, stop bits. A pty keeps no parity bit, so what is asked of the driver is
// judged.
#include <cerrno>
#include <cstdlib>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <termios.h>
#include <unistd.h>

extern "C" {
#include "brace_hal_posix.h"
#include "unity.h"
}

namespace {

termios asked;
int times_asked = 0;

} // namespace

// In place of the C library's: notes what is asked, and asks it.
extern "C" int tcsetattr(int file, int when, const termios *settings) noexcept
{
    using Real = int (*)(int, int, const termios *);
    static const Real real = reinterpret_cast<Real>(dlsym(RTLD_NEXT, "tcsetattr"));
    asked = *settings;
    ++times_asked;
    return real(file, when, settings);
}

extern "C" void setUp(void) {}
extern "C" void tearDown(void) {}

namespace {

// A pty pair, its far end opened as a tty by the posix door.
struct Line {
    int near = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    brace_posix_t posix;
    brace_hal_t hal;

    Line()
    {
        TEST_ASSERT_TRUE(near >= 0 && grantpt(near) == 0 && unlockpt(near) == 0);
        const std::string place = ptsname(near);
        brace_posix_init(&posix);
        TEST_ASSERT_EQUAL_INT(0, brace_posix_stream_open(&posix.stream[BRACE_SERIAL_MODBUS], place.c_str()));
        brace_posix_hal(&posix, &hal);
    }
    ~Line()
    {
        brace_posix_close(&posix);
        close(near);
    }
    int32_t setup(uint32_t baud, brace_parity_t parity)
    {
        return hal.serial_setup(hal.context, BRACE_SERIAL_MODBUS, baud, parity);
    }
};

void the_driver_is_asked_for_speed_parity_and_one_stop_bit()
{
    struct {
        brace_parity_t parity;
        tcflag_t control, input;
    } const cases[] = {{BRACE_PARITY_EVEN, PARENB, INPCK},
                       {BRACE_PARITY_ODD, PARENB | PARODD, INPCK},
                       {BRACE_PARITY_NONE, 0, 0}, // after the others: theirs is taken back
                       {BRACE_PARITY_EVEN, PARENB, INPCK}};
    struct {
        uint32_t baud;
        speed_t speed;
    } const rates[] = {{19200, B19200}, {115200, B115200}, {1000000, B1000000}};
    Line line;
    for (const auto &rate : rates) {
        for (const auto &wanted : cases) {
            const int before = times_asked;
            TEST_ASSERT_EQUAL_INT(0, line.setup(rate.baud, wanted.parity));
            TEST_ASSERT_EQUAL_INT(before + 1, times_asked);
            TEST_ASSERT_EQUAL_HEX32(wanted.control | CS8, asked.c_cflag & (PARENB | PARODD | CSTOPB | CSIZE));
            TEST_ASSERT_EQUAL_HEX32(wanted.input, asked.c_iflag & (INPCK | ISTRIP | PARMRK | IXON | IXOFF | ICRNL));
            TEST_ASSERT_EQUAL_HEX32(0, asked.c_lflag & (ICANON | ECHO | ISIG));
            TEST_ASSERT_TRUE(rate.speed == cfgetospeed(&asked) && rate.speed == cfgetispeed(&asked));
            termios kept;
            TEST_ASSERT_EQUAL_INT(0, tcgetattr(line.posix.stream[BRACE_SERIAL_MODBUS].file, &kept));
            TEST_ASSERT_EQUAL_HEX32(wanted.control & PARODD, kept.c_cflag & (PARODD | CSTOPB));
            TEST_ASSERT_EQUAL_HEX32(wanted.input, kept.c_iflag & INPCK);
        }
    }
}

void bytes_pass_under_every_parity()
{
    Line line;
    for (const brace_parity_t parity : {BRACE_PARITY_NONE, BRACE_PARITY_ODD, BRACE_PARITY_EVEN}) {
        TEST_ASSERT_EQUAL_INT(0, line.setup(19200, parity));
        uint8_t frame[256], back[256];
        for (int i = 0; i < 256; ++i) {
            frame[i] = static_cast<uint8_t>(i);
        }
        TEST_ASSERT_EQUAL_INT(256, static_cast<int>(write(line.near, frame, sizeof frame)));
        int32_t count = 0;
        for (int i = 0; i < 1000 && count < 256; ++i) {
            const int32_t more = line.hal.serial_read(line.hal.context, BRACE_SERIAL_MODBUS, back + count,
                                                      static_cast<uint32_t>(256 - count));
            count += more > 0 ? more : 0;
            usleep(more > 0 ? 0 : 200);
        }
        TEST_ASSERT_EQUAL_INT(256, count);
        TEST_ASSERT_EQUAL_MEMORY(frame, back, sizeof frame);
    }
}

void what_no_line_has_is_refused()
{
    Line line;
    const int before = times_asked;
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_RANGE, line.setup(12345, BRACE_PARITY_EVEN));
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_RANGE, line.setup(19200, static_cast<brace_parity_t>(3)));
    TEST_ASSERT_EQUAL_INT(before, times_asked);
}

} // namespace

int main()
{
    UNITY_BEGIN();
    RUN_TEST(the_driver_is_asked_for_speed_parity_and_one_stop_bit);
    RUN_TEST(bytes_pass_under_every_parity);
    RUN_TEST(what_no_line_has_is_refused);
    return UNITY_END();
}
