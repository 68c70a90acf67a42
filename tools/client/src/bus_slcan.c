/* CAN frames as LAWICEL text, over a serial device or TCP: "t1238" and the data in hexadecimal, ended by a carriage
 * return. */
#include "bus_slcan.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

enum { ENTER_MS = 1000, WAITED_US = 100000 };

/* When the other end of a connection has closed, that must be a status and no signal to the robot's process. */
static ssize_t put(int fd, const char *text, size_t length)
{
    const ssize_t size = send(fd, text, length, MSG_NOSIGNAL);
    return size < 0 && errno == ENOTSOCK ? write(fd, text, length) : size;
}

static brace_bus_status_t write_all(brace_bus_t *bus, const char *text, size_t length, int timeout_ms)
{
    const uint64_t deadline_us = brace_bus_now_us() + (uint64_t)timeout_ms * 1000u;
    for (size_t sent = 0u; sent < length;) {
        const ssize_t size = put(bus->fd, text + sent, length - sent);
        if (size > 0) {
            sent += (size_t)size;
            continue;
        }
        if (size < 0 && errno != EAGAIN && errno != EINTR) {
            return BRACE_BUS_E_DOWN;
        }
        const int left_ms = brace_bus_left_ms(deadline_us);
        if (left_ms == 0) {
            return BRACE_BUS_E_FULL;
        }
        struct pollfd room = {.fd = bus->fd, .events = POLLOUT};
        poll(&room, 1, left_ms);
    }
    return BRACE_BUS_OK;
}

bool brace_slcan_rate(uint32_t bit_rate, char *rate)
{
    static const uint32_t known[] = {10000u, 20000u, 50000u, 100000u, 125000u, 250000u, 500000u, 800000u, 1000000u};
    for (uint32_t i = 0u; i < sizeof known / sizeof known[0]; i++) {
        if (known[i] == (bit_rate == 0u ? 1000000u : bit_rate)) {
            *rate = (char)('0' + i);
            return true;
        }
    }
    return false;
}

/* Ends a command that somebody left half-sent, closes the channel, sets the rate (a controller's own port ignores it),
 * and opens the channel. */
static brace_bus_status_t enter(brace_bus_t *bus, char rate, int timeout_ms)
{
    const char hello[] = {'\r', '\r', 'C', '\r', 'S', rate, '\r', 'O', '\r'};
    bus->is_slcan = true;
    bus->rate = rate;
    bus->empty_us = bus->empty_us == 0u ? brace_bus_now_us() : bus->empty_us;
    return write_all(bus, hello, sizeof hello, timeout_ms);
}

void brace_slcan_enter_again(brace_bus_t *bus)
{
    (void)enter(bus, bus->rate, 0);
}

void brace_slcan_leave(brace_bus_t *bus)
{
    (void)write_all(bus, "C\r", 2u, 100);
}

static bool speed_of(long baud, speed_t *speed)
{
    static const struct {
        long baud;
        speed_t speed;
    } known[] = {{9600, B9600},     {19200, B19200},   {38400, B38400},   {57600, B57600},     {115200, B115200},
                 {230400, B230400}, {460800, B460800}, {921600, B921600}, {1000000, B1000000}, {2000000, B2000000}};
    for (size_t i = 0u; i < sizeof known / sizeof known[0]; i++) {
        if (known[i].baud == baud) {
            *speed = known[i].speed;
            return true;
        }
    }
    return false;
}

brace_bus_status_t brace_slcan_open_tty(brace_bus_t *bus, const char *where, char rate, char *why, unsigned why_room)
{
    char path[256];
    const char *at = strchr(where, '@');
    const size_t length = at == NULL ? strlen(where) : (size_t)(at - where);
    speed_t speed = B115200;
    if (length == 0u || length >= sizeof path || (at != NULL && !speed_of(strtol(at + 1, NULL, 10), &speed))) {
        brace_bus_say(why, why_room, "slcan:%s: expected slcan:/dev/ttyACM0 or slcan:/dev/ttyACM0@115200", where);
        return BRACE_BUS_E_USAGE;
    }
    memcpy(path, where, length);
    path[length] = '\0';
    bus->fd = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (bus->fd < 0) {
        const char *hint = errno == EACCES  ? "add yourself to the group of the device (dialout)"
                           : errno == EBUSY ? "another program holds it"
                                            : "is the adapter plugged in? 'ls /dev/tty*' lists the devices there are";
        brace_bus_say(why, why_room, "%s: %s; %s", path, strerror(errno), hint);
        return BRACE_BUS_E_NO_DEVICE;
    }
    struct termios settings;
    if (tcgetattr(bus->fd, &settings) < 0) {
        brace_bus_say(why, why_room, "%s: not a serial device; 'ls /dev/tty*' lists those there are", path);
        return BRACE_BUS_E_NO_DEVICE;
    }
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cc[VMIN] = 1; /* without news a read gives EAGAIN; 0 means the end */
    settings.c_cc[VTIME] = 0;
    cfsetispeed(&settings, speed);
    cfsetospeed(&settings, speed);
    if (tcsetattr(bus->fd, TCSANOW, &settings) < 0) {
        brace_bus_say(why, why_room, "%s: %s; it does not take this baud rate", path, strerror(errno));
        return BRACE_BUS_E_NO_DEVICE;
    }
    const brace_bus_status_t status = enter(bus, rate, ENTER_MS);
    if (status != BRACE_BUS_OK) {
        brace_bus_say(why, why_room, "%s: the adapter takes no commands; unplug it and plug it in again", path);
    }
    return status;
}

static int connect_within(const struct addrinfo *address, int timeout_ms)
{
    const int fd = socket(address->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0) {
        return -1;
    }
    if (connect(fd, address->ai_addr, address->ai_addrlen) == 0) {
        return fd;
    }
    int error = errno;
    if (error == EINPROGRESS) {
        struct pollfd done = {.fd = fd, .events = POLLOUT};
        socklen_t size = sizeof error;
        if (poll(&done, 1, timeout_ms) <= 0) {
            error = ETIMEDOUT;
        } else if (getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0) {
            return fd;
        }
    }
    close(fd);
    errno = error;
    return -1;
}

brace_bus_status_t brace_slcan_open_tcp(brace_bus_t *bus, const char *where, char rate, int timeout_ms, char *why,
                                        unsigned why_room)
{
    char host[256];
    const char *colon = strrchr(where, ':');
    const size_t length = colon == NULL ? 0u : (size_t)(colon - where);
    if (colon == NULL || length == 0u || length >= sizeof host || colon[1] == '\0') {
        brace_bus_say(why, why_room, "tcp://%s: expected tcp://host:port", where);
        return BRACE_BUS_E_USAGE;
    }
    const bool bracketed = length > 2u && where[0] == '[' && where[length - 1u] == ']'; /* [::1] */
    snprintf(host, sizeof host, "%.*s", (int)(bracketed ? length - 2u : length), where + bracketed);
    const struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM};
    struct addrinfo *found = NULL;
    const int failed = getaddrinfo(host, colon + 1, &hints, &found);
    if (failed != 0) {
        brace_bus_say(why, why_room, "tcp://%s: %s", where, gai_strerror(failed));
        return BRACE_BUS_E_NO_DEVICE;
    }
    const uint64_t deadline_us = brace_bus_now_us() + (uint64_t)timeout_ms * 1000u;
    for (const struct addrinfo *address = found; address != NULL && bus->fd < 0; address = address->ai_next) {
        bus->fd = connect_within(address, brace_bus_left_ms(deadline_us));
    }
    const int error = errno;
    freeaddrinfo(found);
    if (bus->fd < 0) {
        brace_bus_say(why, why_room, "tcp://%s: %s; does anything listen there? ('brace sim' prints its port)", where,
                      strerror(error));
        return BRACE_BUS_E_NO_DEVICE;
    }
    const int on = 1;
    (void)setsockopt(bus->fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return enter(bus, rate, ENTER_MS);
}

brace_bus_status_t brace_slcan_send(brace_bus_t *bus, const brace_bus_frame_t *frame, int timeout_ms)
{
    char text[32];
    int length = snprintf(text, sizeof text, "t%03X%u", (unsigned)frame->id, (unsigned)frame->length);
    for (unsigned i = 0u; i < frame->length; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length, "%02X", frame->data[i]);
    }
    text[length++] = '\r';
    return write_all(bus, text, (size_t)length, timeout_ms);
}

static bool hex_value(const char *text, size_t digits, uint32_t *value)
{
    *value = 0u;
    for (size_t i = 0u; i < digits; i++) {
        const int c = tolower((unsigned char)text[i]);
        if (!isxdigit(c)) {
            return false;
        }
        *value = *value << 4 | (uint32_t)(isdigit(c) ? c - '0' : c - 'a' + 10);
    }
    return true;
}

static bool is_data_frame(char kind)
{
    return kind == 't' || kind == 'd' || kind == 'b'; /* d, b: CAN FD without and with bit-rate switch */
}

/* Reads a line without its end. True when it is a data frame with an 11-bit identifier. A time stamp may follow. */
static bool read_frame(const char *line, size_t length, brace_bus_frame_t *frame)
{
    static const uint8_t bytes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
    uint32_t id, code;
    if (length < 5u || !is_data_frame(line[0]) || !hex_value(line + 1, 3u, &id) || !hex_value(line + 4, 1u, &code) ||
        id > 0x7ffu || (line[0] == 't' && code > 8u)) {
        return false;
    }
    const uint32_t count = bytes[code];
    if (length != 5u + 2u * count && length != 9u + 2u * count) {
        return false;
    }
    memset(frame, 0, sizeof *frame);
    for (uint32_t i = 0u; i < count; i++) {
        uint32_t byte;
        if (!hex_value(line + 5u + 2u * i, 2u, &byte)) {
            return false;
        }
        frame->data[i] = (uint8_t)byte;
    }
    frame->id = id;
    frame->length = (uint8_t)count;
    frame->fd = line[0] != 't';
    return true;
}

/* Handles a line that is no frame: an adapter's answer, a frame of another kind, noise. */
static void note_line(brace_bus_t *bus)
{
    uint32_t status;
    if (bus->line_length == 3u && bus->line[0] == 'F' && hex_value(bus->line + 1, 2u, &status)) {
        bus->has_status = true;
        bus->errors += (status & 0xa4u) != 0u; /* bus error, error passive, error warning */
        bus->lost += (status & 0x09u) != 0u;   /* overrun, receive queue full */
    } else if (bus->line_is_too_long || (bus->line_length > 0u && is_data_frame(bus->line[0]))) {
        bus->lost++;
    }
    for (size_t i = 0u; i < bus->line_length; i++) {
        if (!isprint((unsigned char)bus->line[i])) {
            bus->errors++; /* another baud rate looks like this */
            break;
        }
    }
}

/* Takes characters of the chunk until a frame is whole. */
static bool next_frame(brace_bus_t *bus, brace_bus_frame_t *frame)
{
    while (bus->chunk_at < bus->chunk_end) {
        const char c = (char)bus->chunk[bus->chunk_at++];
        if (c != '\r' && c != '\a') {
            if (bus->line_length < sizeof bus->line) {
                bus->line[bus->line_length++] = c;
            } else {
                bus->line_is_too_long = true;
            }
            continue;
        }
        const bool whole = c == '\r' && !bus->line_is_too_long && read_frame(bus->line, bus->line_length, frame);
        if (!whole) {
            note_line(bus);
        }
        bus->line_length = 0u;
        bus->line_is_too_long = false;
        if (whole) {
            frame->received_us = bus->chunk_us;
            return true;
        }
    }
    return false;
}

/* When what was just read came. What has waited in the port for long may be as old as the time when the port was last
 * found empty. */
static uint64_t came_us(const brace_bus_t *bus)
{
    const uint64_t now_us = brace_bus_now_us();
    return now_us - bus->empty_us > WAITED_US ? bus->empty_us : now_us;
}

brace_bus_status_t brace_slcan_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms)
{
    const uint64_t deadline_us = brace_bus_now_us() + (uint64_t)timeout_ms * 1000u;
    while (!next_frame(bus, frame)) {
        const ssize_t size = read(bus->fd, bus->chunk, sizeof bus->chunk);
        if (size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR)) {
            return BRACE_BUS_E_DOWN;
        }
        bus->chunk_at = 0u;
        bus->chunk_end = size > 0 ? (size_t)size : 0u;
        bus->empty_us = size < 0 ? brace_bus_now_us() : bus->empty_us;
        bus->chunk_us = came_us(bus);
        const int left_ms = brace_bus_left_ms(deadline_us);
        if (left_ms == 0) { /* ends also when more always comes but none is a frame */
            return next_frame(bus, frame) ? BRACE_BUS_OK : BRACE_BUS_E_TIMEOUT;
        }
        if (size < 0) {
            struct pollfd news = {.fd = bus->fd, .events = POLLIN};
            poll(&news, 1, left_ms);
            bus->empty_us = brace_bus_now_us(); /* it was until now */
        }
    }
    return BRACE_BUS_OK;
}

void brace_slcan_ask_status(brace_bus_t *bus, int timeout_ms)
{
    const uint64_t deadline_us = brace_bus_now_us() + (uint64_t)timeout_ms * 1000u;
    brace_bus_frame_t dropped;
    bus->has_status = false;
    if (write_all(bus, "F\r", 2u, timeout_ms) != BRACE_BUS_OK) {
        return;
    }
    while (!bus->has_status && brace_bus_left_ms(deadline_us) > 0) {
        const brace_bus_status_t status = brace_slcan_receive(bus, &dropped, brace_bus_left_ms(deadline_us));
        if (status != BRACE_BUS_OK && status != BRACE_BUS_E_TIMEOUT) {
            return;
        }
    }
}
