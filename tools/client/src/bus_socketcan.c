/* CAN through the kernel's own sockets. */
#include "bus_socketcan.h"

#include <errno.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { SKIPPED_MOST = 4096 }; /* frames of no use to a client that one call takes from the queue */

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
                      "slcan:/dev/ttyACM0",
                      name, strerror(errno));
        return BRACE_BUS_E_NO_KERNEL;
    }
    memcpy(request.ifr_name, name, strlen(name));
    if (ioctl(bus->fd, SIOCGIFINDEX, &request) < 0) {
        brace_bus_say(why, why_room, "%s: no such interface; 'ip -br link' lists those there are", name);
        return BRACE_BUS_E_NO_DEVICE;
    }
    const int index = request.ifr_ifindex;
    if (ioctl(bus->fd, SIOCGIFFLAGS, &request) < 0 || !(request.ifr_flags & IFF_UP)) {
        brace_bus_say(why, why_room,
                      "%s: the interface is down; try 'ip link set %s up type can bitrate 1000000' as root", name,
                      name);
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
    const int on = 1, room = 1 << 20;
    const can_err_mask_t errors = CAN_ERR_CRTL | CAN_ERR_PROT | CAN_ERR_ACK | CAN_ERR_BUSOFF | CAN_ERR_BUSERROR;
    (void)setsockopt(bus->fd, SOL_SOCKET, SO_TIMESTAMP, &on, sizeof on);
    (void)setsockopt(bus->fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    (void)setsockopt(bus->fd, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    (void)setsockopt(bus->fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on); /* old kernels: classic frames only */
    (void)setsockopt(bus->fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
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
        /* ENOBUFS: the interface's queue is full although the socket can be written to, so try again after a while */
        struct pollfd room = {.fd = bus->fd, .events = errno == ENOBUFS ? 0 : POLLOUT};
        poll(&room, 1, left_ms < 2 ? left_ms : 2);
    }
}

/* Reads what the kernel reports beside a frame: its time, and how many frames its queue has dropped so far. */
static void read_notes(brace_bus_t *bus, struct msghdr *message, brace_bus_frame_t *frame)
{
    frame->received_us = brace_bus_now_us();
    for (struct cmsghdr *note = CMSG_FIRSTHDR(message); note != NULL; note = CMSG_NXTHDR(message, note)) {
        if (note->cmsg_level == SOL_SOCKET && note->cmsg_type == SO_TIMESTAMP) {
            struct timeval stamp, now;
            memcpy(&stamp, CMSG_DATA(note), sizeof stamp);
            gettimeofday(&now, NULL);
            const int64_t age_us = (now.tv_sec - stamp.tv_sec) * (int64_t)1000000 + (now.tv_usec - stamp.tv_usec);
            if (age_us > 0 && (uint64_t)age_us < frame->received_us) {
                frame->received_us -= (uint64_t)age_us;
            }
        } else if (note->cmsg_level == SOL_SOCKET && note->cmsg_type == SO_RXQ_OVFL) {
            memcpy(&bus->lost, CMSG_DATA(note), sizeof bus->lost);
        }
    }
}

/* Sorts an error frame. Where nobody else is on the bus, a controller that sends finds no acknowledgement and nothing
 * else wrong. */
static void count_error(brace_bus_t *bus, const struct canfd_frame *got)
{
    const canid_t harmless = CAN_ERR_ACK | CAN_ERR_CRTL | CAN_ERR_PROT | CAN_ERR_BUSERROR;
    const uint8_t of_sending = CAN_ERR_CRTL_TX_WARNING | CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_ACTIVE;
    const bool is_of_sending = (got->can_id & CAN_ERR_CRTL) == 0u || (got->data[1] & ~of_sending) == 0u;
    const bool is_of_acknowledging =
        (got->can_id & CAN_ERR_PROT) == 0u || got->data[3] == CAN_ERR_PROT_LOC_ACK || (got->can_id & CAN_ERR_ACK) != 0u;
    const bool says_something = (got->can_id & (CAN_ERR_ACK | CAN_ERR_CRTL | CAN_ERR_PROT)) != 0u;
    const bool is_unheard =
        (got->can_id & CAN_ERR_MASK & ~harmless) == 0u && says_something && is_of_sending && is_of_acknowledging;
    bus->unacknowledged += is_unheard;
    bus->errors += !is_unheard;
}

/* Takes one frame from the queue. is_wanted: frame is written; a client has no use for frames of other kinds.
 * returns OK, E_TIMEOUT (the queue is empty), E_DOWN */
static brace_bus_status_t take_frame(brace_bus_t *bus, brace_bus_frame_t *frame, bool *is_wanted)
{
    struct canfd_frame got; /* a classic frame is its beginning */
    struct iovec part = {.iov_base = &got, .iov_len = sizeof got};
    union {
        struct cmsghdr aligned;
        char room[CMSG_SPACE(sizeof(struct timeval)) + CMSG_SPACE(sizeof(uint32_t))];
    } notes;
    struct msghdr message = {.msg_iov = &part, .msg_iovlen = 1, .msg_control = &notes, .msg_controllen = sizeof notes};
    const ssize_t size = recvmsg(bus->fd, &message, 0);
    if (size < 0) {
        return errno == EAGAIN || errno == EINTR ? BRACE_BUS_E_TIMEOUT : BRACE_BUS_E_DOWN;
    }
    const bool fd = size == (ssize_t)CANFD_MTU, is_whole = fd || size == (ssize_t)CAN_MTU;
    if (is_whole && !fd && (got.can_id & CAN_ERR_FLAG) != 0u) {
        count_error(bus, &got);
    }
    *is_wanted =
        is_whole && (got.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_ERR_FLAG)) == 0u && got.len <= (fd ? 64u : 8u);
    if (!*is_wanted) {
        return BRACE_BUS_OK;
    }
    frame->id = got.can_id;
    frame->length = got.len;
    frame->fd = fd;
    memcpy(frame->data, got.data, got.len);
    memset(frame->data + got.len, 0, sizeof frame->data - got.len);
    read_notes(bus, &message, frame);
    return BRACE_BUS_OK;
}

/* E_TIMEOUT means that the queue is empty, so that what comes next is new. */
brace_bus_status_t brace_socketcan_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms)
{
    const uint64_t deadline_us = brace_bus_now_us() + (uint64_t)timeout_ms * 1000u;
    for (int skipped = 0; skipped < SKIPPED_MOST;) {
        bool is_wanted = false;
        const brace_bus_status_t status = take_frame(bus, frame, &is_wanted);
        if (status == BRACE_BUS_OK && !is_wanted) {
            skipped++;
            continue;
        }
        const int left_ms = brace_bus_left_ms(deadline_us);
        if (status != BRACE_BUS_E_TIMEOUT || left_ms == 0) {
            return status;
        }
        struct pollfd news = {.fd = bus->fd, .events = POLLIN};
        poll(&news, 1, left_ms);
    }
    return BRACE_BUS_E_TIMEOUT;
}
