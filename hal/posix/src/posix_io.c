#include "posix_io.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

const char *brace_posix_status_text(int32_t status)
{
    static const char *const text[] = {
        "opened",
        "not a URL that is known here",
        "in use by another program",
        "there is no such device, host or folder",
        "this kernel knows no CAN",
        "not permitted",
        "the system refused",
        "a file of another size",
    };
    const int32_t index = -status;
    return index >= 0 && index < (int32_t)(sizeof text / sizeof text[0]) ? text[index] : "unknown status";
}

int32_t io_status_of_errno(void)
{
    switch (errno) {
    case EADDRINUSE:
    case EBUSY:
    case EWOULDBLOCK: return BRACE_POSIX_E_IN_USE;
    case EACCES:
    case EPERM: return BRACE_POSIX_E_DENIED;
    case ENOENT:
    case ENODEV:
    case ENXIO:
    case ENOTDIR:
    case ENOTTY:
    case EISDIR:
    case EADDRNOTAVAIL: return BRACE_POSIX_E_NO_DEVICE;
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT: return BRACE_POSIX_E_NO_CAN;
    default: return BRACE_POSIX_E_SYSTEM;
    }
}

void io_close(int *file)
{
    if (*file >= 0) {
        close(*file);
    }
    *file = -1;
}

void io_copy(char *to, size_t room, const char *from)
{
    size_t i = 0;
    for (; i + 1 < room && from[i] != '\0'; i++) { /* at most room */
        to[i] = from[i];
    }
    to[i] = '\0';
}

static bool make_nonblocking(int file)
{
    const int flags = fcntl(file, F_GETFL, 0);
    return flags >= 0 && fcntl(file, F_SETFL, flags | O_NONBLOCK) == 0 && fcntl(file, F_SETFD, FD_CLOEXEC) == 0;
}

/* ------------------------------------------------------------------------------------------- sockets -- */

/* Splits "HOST:PORT" or "[HOST]:PORT"; ignores everything from a '/' on. */
static bool split_place(const char *place, char *host, char *port)
{
    char whole[BRACE_POSIX_WHERE];
    io_copy(whole, sizeof whole, place);
    whole[strcspn(whole, "/")] = '\0';
    char *colon = strrchr(whole, ':');
    if (colon == NULL || colon == whole || colon[1] == '\0' || strspn(colon + 1, "0123456789") != strlen(colon + 1) ||
        strtoul(colon + 1, NULL, 10) > 65535u) {
        return false;
    }
    *colon = '\0';
    char *name = whole;
    const size_t length = strlen(name);
    if (name[0] == '[' && name[length - 1] == ']') {
        name[length - 1] = '\0';
        name++;
    }
    io_copy(host, BRACE_POSIX_WHERE, name);
    io_copy(port, 8, colon + 1);
    return true;
}

int32_t io_listen(const char *scheme, const char *place, int *listener, char *where)
{
    char host[BRACE_POSIX_WHERE], port[8];
    if (!split_place(place, host, port)) {
        return BRACE_POSIX_E_URL;
    }
    const struct addrinfo hints = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE | AI_NUMERICSERV};
    struct addrinfo *found = NULL;
    if (getaddrinfo(host, port, &hints, &found) != 0) {
        return BRACE_POSIX_E_NO_DEVICE;
    }
    int file = socket(found->ai_family, found->ai_socktype, found->ai_protocol);
    const int yes = 1;
    struct sockaddr_storage given;
    socklen_t size = sizeof given;
    const bool listens = file >= 0 && setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
                         bind(file, found->ai_addr, found->ai_addrlen) == 0 && make_nonblocking(file) &&
                         listen(file, 2 * BRACE_POSIX_CLIENTS) == 0 &&
                         getsockname(file, (struct sockaddr *)&given, &size) == 0;
    const int32_t status = listens ? BRACE_POSIX_OK : io_status_of_errno();
    freeaddrinfo(found);
    if (!listens) {
        io_close(&file);
        return status;
    }
    const in_port_t number = given.ss_family == AF_INET6 ? ((struct sockaddr_in6 *)(void *)&given)->sin6_port
                                                         : ((struct sockaddr_in *)(void *)&given)->sin_port;
    const bool bracketed = strchr(host, ':') != NULL;
    if (snprintf(where, BRACE_POSIX_WHERE, "%s://%s%s%s:%u", scheme, bracketed ? "[" : "", host, bracketed ? "]" : "",
                 (unsigned)ntohs(number)) >= BRACE_POSIX_WHERE) {
        io_close(&file);
        return BRACE_POSIX_E_URL;
    }
    *listener = file;
    return BRACE_POSIX_OK;
}

int io_accept(int listener)
{
    if (listener < 0) {
        return -1;
    }
    int file = accept(listener, NULL, NULL);
    if (file < 0) {
        return -1;
    }
    const int yes = 1;
    if (!make_nonblocking(file)) {
        io_close(&file);
        return -1;
    }
    (void)setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &yes,
                     sizeof yes); /* send a frame at once, not a full segment later */
    return file;
}

/* -------------------------------------------------------------------------------------------- lines -- */

static bool make_raw(int file)
{
    struct termios line;
    if (tcgetattr(file, &line) != 0) {
        return false;
    }
    cfmakeraw(&line);
    line.c_cflag |= CLOCAL | CREAD;
    line.c_cc[VMIN] = 0;
    line.c_cc[VTIME] = 0;
    return tcsetattr(file, TCSANOW, &line) == 0;
}

int32_t io_pty(int *file, int *kept, char *where)
{
    int ours = posix_openpt(O_RDWR | O_NOCTTY);
    int theirs = -1;
    char path[BRACE_POSIX_WHERE];
    const bool made =
        ours >= 0 && grantpt(ours) == 0 && unlockpt(ours) == 0 && ptsname_r(ours, path, sizeof path) == 0 &&
        (theirs = open(path, O_RDWR | O_NOCTTY | O_CLOEXEC)) >= 0 && make_raw(theirs) && make_nonblocking(ours);
    if (!made) {
        const int32_t status = io_status_of_errno();
        io_close(&ours);
        io_close(&theirs);
        return status;
    }
    *file = ours;
    *kept = theirs;
    io_copy(where, BRACE_POSIX_WHERE, path);
    return BRACE_POSIX_OK;
}

static bool speed_of_baud(uint32_t baud, speed_t *speed)
{
    static const struct {
        uint32_t baud;
        speed_t speed;
    } known[] = {
        {1200, B1200},       {2400, B2400},       {4800, B4800},       {9600, B9600},
        {19200, B19200},     {38400, B38400},     {57600, B57600},     {115200, B115200},
        {230400, B230400},   {460800, B460800},   {500000, B500000},   {921600, B921600},
        {1000000, B1000000}, {2000000, B2000000}, {3000000, B3000000}, {4000000, B4000000},
    };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (known[i].baud == baud) {
            *speed = known[i].speed;
            return true;
        }
    }
    return false;
}

int32_t io_tty_setup(int file, uint32_t baud, brace_parity_t parity)
{
    speed_t speed;
    struct termios line;
    if (!speed_of_baud(baud, &speed)) {
        return BRACE_HAL_E_RANGE;
    }
    if (tcgetattr(file, &line) != 0) {
        return BRACE_HAL_E_DEVICE;
    }
    cfmakeraw(&line);
    line.c_cflag &= ~(tcflag_t)(CSTOPB | PARENB | PARODD);
    line.c_iflag &= ~(tcflag_t)INPCK;
    line.c_cflag |= CLOCAL | CREAD;
    if (parity != BRACE_PARITY_NONE) {
        line.c_cflag |= PARENB | (parity == BRACE_PARITY_ODD ? (tcflag_t)PARODD : 0u);
        line.c_iflag |= INPCK;
    }
    line.c_cc[VMIN] = 0;
    line.c_cc[VTIME] = 0;
    (void)cfsetispeed(&line, speed);
    (void)cfsetospeed(&line, speed);
    return tcsetattr(file, TCSANOW, &line) == 0 ? BRACE_HAL_OK : BRACE_HAL_E_DEVICE;
}

int32_t io_tty(const char *place, int *file, char *where)
{
    char path[BRACE_POSIX_WHERE];
    io_copy(path, sizeof path, place);
    char *at = strchr(path, '@');
    uint32_t baud = 115200;
    if (at != NULL) {
        *at = '\0';
        baud = (uint32_t)strtoul(at + 1, NULL, 10);
    }
    int device = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (device < 0) {
        return io_status_of_errno();
    }
    int32_t status = BRACE_POSIX_OK;
    if (!isatty(device)) {
        status = BRACE_POSIX_E_NO_DEVICE;
    } else if (flock(device, LOCK_EX | LOCK_NB) != 0) {
        status = io_status_of_errno();
    } else if (io_tty_setup(device, baud, BRACE_PARITY_NONE) != BRACE_HAL_OK) {
        status = BRACE_POSIX_E_URL;
    }
    if (status != BRACE_POSIX_OK) {
        io_close(&device);
        return status;
    }
    *file = device;
    io_copy(where, BRACE_POSIX_WHERE, path);
    return BRACE_POSIX_OK;
}

/* ------------------------------------------------------------------------------------ read and write -- */

static bool means_later(void)
{
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ENOBUFS;
}

int32_t io_read(int file, uint8_t *bytes, uint32_t room)
{
    if (file < 0 || room == 0u) {
        return 0;
    }
    const ssize_t count = read(file, bytes, room);
    if (count > 0) {
        return (int32_t)count;
    }
    return count < 0 && means_later() ? 0 : -1;
}

int32_t io_write(int file, const uint8_t *bytes, uint32_t count)
{
    if (file < 0 || count == 0u) {
        return 0;
    }
    ssize_t taken = send(file, bytes, count, MSG_NOSIGNAL);
    if (taken < 0 && errno == ENOTSOCK) {
        taken = write(file, bytes, count);
    }
    if (taken >= 0) {
        return (int32_t)taken;
    }
    return means_later() ? 0 : -1;
}

bool queue_put(brace_posix_queue_t *queue, const uint8_t *bytes, uint32_t count)
{
    if (count > BRACE_POSIX_OUT_BYTES - queue->count) {
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        queue->bytes[(queue->start + queue->count++) % BRACE_POSIX_OUT_BYTES] = bytes[i];
    }
    return true;
}

bool queue_flush(brace_posix_queue_t *queue, int file)
{
    for (int part = 0; part < 2 && queue->count > 0u; part++) { /* up to the ring's end, then from its start */
        const uint32_t straight = BRACE_POSIX_OUT_BYTES - queue->start;
        const int32_t taken =
            io_write(file, queue->bytes + queue->start, queue->count < straight ? queue->count : straight);
        if (taken < 0) {
            return false;
        }
        queue->start = (queue->start + (uint32_t)taken) % BRACE_POSIX_OUT_BYTES;
        queue->count -= (uint32_t)taken;
    }
    return true;
}
