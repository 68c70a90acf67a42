/* SocketCAN: one raw socket for all controllers of the process. */
#include <errno.h>
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "posix_io.h"
#include "posix_nodes.h"
#include "posix_socketcan.h"

enum { FRAMES_PER_POLL = 1024 };

int32_t socketcan_open(brace_posix_bus_t *bus, const char *interface)
{
    struct ifreq request;
    memset(&request, 0, sizeof request);
    if (strlen(interface) == 0u || strlen(interface) >= sizeof request.ifr_name || strpbrk(interface, ":/ ") != NULL) {
        return BRACE_POSIX_E_URL;
    }
    int file = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (file < 0) {
        return io_status_of_errno();
    }
    io_copy(request.ifr_name, sizeof request.ifr_name, interface);
    const int yes = 1;
    struct sockaddr_can address;
    memset(&address, 0, sizeof address);
    address.can_family = AF_CAN;
    bool bound = ioctl(file, SIOCGIFINDEX, &request) == 0;
    if (bound) {
        address.can_ifindex = request.ifr_ifindex;
        /* the kernel's sockets and the interface must both allow FD: 'ip link set vcan0 mtu 72' */
        struct ifreq room = request;
        const bool broad = ioctl(file, SIOCGIFMTU, &room) == 0 && room.ifr_mtu == (int)CANFD_MTU;
        bus->socket_can_fd = broad && setsockopt(file, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &yes, sizeof yes) == 0;
        bound = bind(file, (const struct sockaddr *)&address, sizeof address) == 0;
    }
    if (!bound) {
        const int32_t status = errno == ENODEV ? BRACE_POSIX_E_NO_DEVICE : io_status_of_errno();
        io_close(&file);
        return status;
    }
    bus->socket_can = file;
    io_copy(bus->where, sizeof bus->where, interface);
    return BRACE_POSIX_OK;
}

void socketcan_poll(brace_posix_bus_t *bus)
{
    for (int i = 0; i < FRAMES_PER_POLL; i++) {
        struct canfd_frame raw;
        const ssize_t bytes = read(bus->socket_can, &raw, sizeof raw);
        if (bytes != (ssize_t)CAN_MTU && bytes != (ssize_t)CANFD_MTU) {
            return; /* no more frames, or the interface is down: the next poll tries again */
        }
        if ((raw.can_id & CAN_ERR_FLAG) != 0u || raw.len > (bytes == (ssize_t)CAN_MTU ? 8u : 64u)) {
            continue;
        }
        brace_posix_wire_frame_t frame = {{0}, (raw.can_id & CAN_EFF_FLAG) != 0u, (raw.can_id & CAN_RTR_FLAG) != 0u};
        frame.frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
        frame.frame.length = raw.len;
        frame.frame.fd = bytes == (ssize_t)CANFD_MTU;
        memcpy(frame.frame.data, raw.data, raw.len);
        bus_to_nodes(bus, -1, &frame, 0u);
    }
}

void socketcan_send(brace_posix_bus_t *bus, const brace_posix_wire_frame_t *frame)
{
    struct canfd_frame raw;
    memset(&raw, 0, sizeof raw);
    raw.can_id = frame->frame.id;
    raw.len = frame->frame.length;
    memcpy(raw.data, frame->frame.data, frame->frame.length);
    if (frame->frame.fd) {
        raw.flags = CANFD_BRS;
    }
    const size_t bytes = frame->frame.fd ? CANFD_MTU : CAN_MTU; /* can_frame is the first bytes of canfd_frame */
    if (write(bus->socket_can, &raw, bytes) != (ssize_t)bytes) {
        bus->socket_lost += bus->socket_lost != UINT32_MAX;
    }
}
