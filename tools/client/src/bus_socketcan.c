/* The kernel's own CAN. */
#include "bus_internal.h"

#include <errno.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

brace_bus_status_t brace_socketcan_open(brace_bus_t *bus, const char *name, char *why, unsigned why_room)
{
    struct ifreq request;
    memset(&request, 0, sizeof request);
    if (strlen(name) >= sizeof request.ifr_name) {
        brace_bus_say(why, why_room, "%s: longer than an interface's name can be", name);
        return BRACE_BUS_E_USAGE;
    }
    bus->fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
    if (bus->fd < 0) {
        brace_bus_say(why, why_room,
                      "%s: this kernel has no CAN (%s); try 'modprobe can-raw' as root, or an SLCAN adapter: "
                      "slcan:/dev/ttyACM0", name, strerror(errno));
        return BRACE_BUS_E_NO_KERNEL;
    }
    memcpy(request.ifr_name, name, strlen(name));
    if (ioctl(bus->fd, SIOCGIFINDEX, &request) < 0) {
        brace_bus_say(why, why_room, "%s: no such interface; 'ip -br link' lists those there are", name);
        return BRACE_BUS_E_NO_DEVICE;
    }
    const int index = request.ifr_ifindex;
    if (ioctl(bus->fd, SIOCGIFFLAGS, &request) < 0 || !(request.ifr_flags & IFF_UP)) {
        brace_bus_say(why, why_room, "%s: the interface is down; try 'ip link set %s up type can bitrate 1000000' as root",
                      name, name);
        return BRACE_BUS_E_DOWN;
    }
    struct sockaddr_can address;
    memset(&address, 0, sizeof address);
    address.can_family = AF_CAN;
    address.can_ifindex = index;
    if (bind(bus->fd, (struct sockaddr *)&address, sizeof address) < 0) {
        brace_bus_say(why, why_room, "%s: %s; is it a CAN interface?", name, strerror(errno));
        return BRACE_BUS_E_NO_DEVICE;
    }
    return BRACE_BUS_OK;
}

brace_bus_status_t brace_socketcan_send(brace_bus_t *bus, const brace_bus_frame_t *frame, int timeout_ms)
{
    struct can_frame sent;
    memset(&sent, 0, sizeof sent);
    sent.can_id = frame->id;
    sent.can_dlc = frame->length;
    memcpy(sent.data, frame->data, frame->length);
    const uint64_t deadline_us = brace_bus_now_us() + (uint64_t)timeout_ms * 1000u;
    for (;;) {
        if (write(bus->fd, &sent, sizeof sent) == (ssize_t)sizeof sent) {
            return BRACE_BUS_OK;
        }
        if (errno != EAGAIN && errno != ENOBUFS && errno != EINTR) {
            return BRACE_BUS_E_DOWN;
        }
        const int left_ms = brace_bus_left_ms(deadline_us);
        if (left_ms == 0) {
            return BRACE_BUS_E_FULL;
        }
        /* ENOBUFS: the interface's queue is full although the socket can be written to; look again in a while */
        struct pollfd room = {.fd = bus->fd, .events = errno == ENOBUFS ? 0 : POLLOUT};
        poll(&room, 1, left_ms < 2 ? left_ms : 2);
    }
}

brace_bus_status_t brace_socketcan_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms)
{
    const uint64_t deadline_us = brace_bus_now_us() + (uint64_t)timeout_ms * 1000u;
    for (;;) {
        struct can_frame got;
        const ssize_t size = read(bus->fd, &got, sizeof got);
        if (size == (ssize_t)sizeof got) {
            if (got.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_ERR_FLAG) || got.can_dlc > 8u) {
                continue;
            }
            frame->id = got.can_id;
            frame->length = got.can_dlc;
            memcpy(frame->data, got.data, sizeof frame->data);
            frame->received_us = brace_bus_now_us();
            return BRACE_BUS_OK;
        }
        if (size < 0 && errno != EAGAIN && errno != EINTR) {
            return BRACE_BUS_E_DOWN;
        }
        const int left_ms = brace_bus_left_ms(deadline_us);
        if (left_ms == 0) {
            return BRACE_BUS_E_TIMEOUT;
        }
        struct pollfd news = {.fd = bus->fd, .events = POLLIN};
        poll(&news, 1, left_ms);
    }
}
