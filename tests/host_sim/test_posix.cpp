// The hardware door on a POSIX host: CAN between controllers and clients, serial ends, Modbus TCP, memory.
#include <algorithm>
#include <arpa/inet.h>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

extern "C" {
#include "brace_hal_posix.h"
#include "unity.h"
}

extern "C" void setUp(void) {}
extern "C" void tearDown(void) {}

namespace {

// A controller's door, on a bus or not.
struct Host {
    brace_posix_t posix;
    brace_hal_t hal;

    explicit Host(brace_posix_bus_t *bus = nullptr)
    {
        brace_posix_init(&posix);
        if (bus != nullptr) {
            TEST_ASSERT_TRUE(brace_posix_join(&posix, bus));
        }
        brace_posix_hal(&posix, &hal);
    }
    ~Host() { brace_posix_close(&posix); }
    void *context() { return hal.context; }
};

struct Bus {
    std::unique_ptr<brace_posix_bus_t> bus = std::make_unique<brace_posix_bus_t>();
    explicit Bus(const char *url) { TEST_ASSERT_EQUAL_INT(BRACE_POSIX_OK, brace_posix_bus_open(bus.get(), url)); }
    ~Bus() { brace_posix_bus_close(bus.get()); }
    void poll() { brace_posix_bus_poll(bus.get(), 0); }
};

int connected(const char *where)
{
    const char *port = std::strrchr(where, ':');
    TEST_ASSERT_NOT_NULL(port);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::atoi(port + 1)));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int file = socket(AF_INET, SOCK_STREAM, 0);
    TEST_ASSERT_EQUAL_INT(0, connect(file, reinterpret_cast<const sockaddr *>(&address), sizeof address));
    TEST_ASSERT_EQUAL_INT(0, fcntl(file, F_SETFL, O_NONBLOCK));
    return file;
}

void put(int file, const std::string &text)
{
    TEST_ASSERT_EQUAL_INT(static_cast<int>(text.size()), static_cast<int>(write(file, text.data(), text.size())));
}

// What has come within some polls of whoever sends it.
template <typename Poll> std::string taken(int file, Poll poll, std::size_t wanted)
{
    std::string text;
    for (int i = 0; i < 500 && text.size() < wanted; ++i) {
        poll();
        char bytes[512];
        const ssize_t count = read(file, bytes, sizeof bytes);
        if (count > 0) {
            text.append(bytes, static_cast<std::size_t>(count));
        } else {
            usleep(1000);
        }
    }
    return text;
}

brace_can_frame_t frame(std::uint32_t id, std::uint8_t length, bool fd = false)
{
    brace_can_frame_t made{};
    made.id = id;
    made.length = length;
    made.fd = fd;
    for (std::uint8_t i = 0; i < sizeof made.data; ++i) {
        made.data[i] = i < length ? static_cast<std::uint8_t>(0x10 + i) : 0;
    }
    return made;
}

brace_can_setup_t at_1m()
{
    brace_can_setup_t setup{};
    setup.bit_rate = 1000000;
    return setup;
}

void controllers_hear_each_other_and_not_themselves()
{
    Bus bus("none");
    Host one(bus.bus.get()), two(bus.bus.get());
    const brace_can_setup_t setup = at_1m();
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_setup(one.context(), &setup));
    TEST_ASSERT_EQUAL_INT(0, two.hal.can_setup(two.context(), &setup));
    const brace_can_frame_t sent = frame(0x123, 5);
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_send(one.context(), &sent));
    brace_can_frame_t got{};
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_receive(one.context(), &got));
    TEST_ASSERT_EQUAL_INT(1, two.hal.can_receive(two.context(), &got));
    TEST_ASSERT_EQUAL_MEMORY(&sent, &got, sizeof got);
    TEST_ASSERT_EQUAL_INT(0, two.hal.can_receive(two.context(), &got));
}

void frames_that_cannot_be_are_refused()
{
    Bus bus("none");
    Host one(bus.bus.get());
    brace_can_setup_t setup = at_1m();
    setup.bit_rate = 1234;
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_RANGE, one.hal.can_setup(one.context(), &setup));
    brace_can_frame_t sent = frame(0x1, 1);
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_UNSUPPORTED, one.hal.can_send(one.context(), &sent)); // not set up
    setup = at_1m();
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_setup(one.context(), &setup));
    sent.id = 0x800;
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_RANGE, one.hal.can_send(one.context(), &sent));
    sent = frame(0x1, 9);
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_RANGE, one.hal.can_send(one.context(), &sent));
    sent = frame(0x1, 64, true);
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_UNSUPPORTED, one.hal.can_send(one.context(), &sent)); // classic only
    setup.fd_bit_rate = 2000000;
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_setup(one.context(), &setup));
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_send(one.context(), &sent));
    for (const std::uint8_t length : {9, 11, 13, 22, 28, 40, 63}) {
        sent = frame(0x1, length, true);
        TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_RANGE, one.hal.can_send(one.context(), &sent));
    }
    setup.listen_only = true;
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_setup(one.context(), &setup));
    sent = frame(0x1, 1);
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_UNSUPPORTED, one.hal.can_send(one.context(), &sent));
}

void bus_off_lasts_until_recovered()
{
    Bus bus("none");
    Host one(bus.bus.get()), two(bus.bus.get());
    const brace_can_setup_t setup = at_1m();
    (void)one.hal.can_setup(one.context(), &setup);
    (void)two.hal.can_setup(two.context(), &setup);
    const brace_can_frame_t sent = frame(0x1, 1);
    brace_can_health_t health{};
    bool &fault = bus.bus->node[one.posix.node].fault_bus_off;
    fault = true;
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_BUS_OFF, one.hal.can_send(one.context(), &sent));
    (void)one.hal.can_recover(one.context());
    (void)one.hal.can_health(one.context(), &health);
    TEST_ASSERT_TRUE(health.bus_off);
    fault = false;
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_BUS_OFF, one.hal.can_send(one.context(), &sent));
    (void)two.hal.can_send(two.context(), &sent);
    brace_can_frame_t got{};
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_receive(one.context(), &got));
    (void)one.hal.can_recover(one.context());
    (void)one.hal.can_health(one.context(), &health);
    TEST_ASSERT_FALSE(health.bus_off);
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_send(one.context(), &sent));
}

void a_full_ring_loses_the_newest_and_counts()
{
    Bus bus("none");
    Host one(bus.bus.get()), two(bus.bus.get());
    const brace_can_setup_t setup = at_1m();
    (void)one.hal.can_setup(one.context(), &setup);
    (void)two.hal.can_setup(two.context(), &setup);
    for (int i = 0; i < BRACE_POSIX_RING + 7; ++i) {
        const brace_can_frame_t sent = frame(static_cast<std::uint32_t>(i), 0);
        TEST_ASSERT_EQUAL_INT(0, one.hal.can_send(one.context(), &sent));
    }
    brace_can_health_t health{};
    (void)two.hal.can_health(two.context(), &health);
    TEST_ASSERT_EQUAL_UINT32(7, health.frames_lost);
    brace_can_frame_t got{};
    for (int i = 0; i < BRACE_POSIX_RING; ++i) {
        TEST_ASSERT_EQUAL_INT(1, two.hal.can_receive(two.context(), &got));
        TEST_ASSERT_EQUAL_UINT32(static_cast<std::uint32_t>(i), got.id);
    }
    TEST_ASSERT_EQUAL_INT(0, two.hal.can_receive(two.context(), &got));
}

void an_urgent_frame_finds_room_in_every_controller_and_goes_first()
{
    Bus bus("none");
    Host one(bus.bus.get()), two(bus.bus.get()), sender(bus.bus.get());
    brace_can_setup_t setup = at_1m();
    (void)sender.hal.can_setup(sender.context(), &setup);
    setup.urgent_id = 1;
    for (Host *host : {&one, &two}) {
        setup.filter_id = host == &one ? 0x601 : 0x602;
        setup.filter_mask = 0x7ff;
        (void)host->hal.can_setup(host->context(), &setup);
    }
    const brace_can_frame_t request = frame(0x601, 8), stop = frame(0x001, 0);
    for (int i = 0; i < BRACE_POSIX_RING + 3; i++) {
        (void)sender.hal.can_send(sender.context(), &request);
    }
    (void)sender.hal.can_send(sender.context(), &stop);
    (void)sender.hal.can_send(sender.context(), &stop);
    brace_can_frame_t got{};
    brace_can_health_t health{};
    for (Host *host : {&one, &two}) {
        TEST_ASSERT_EQUAL_INT(1, host->hal.can_receive(host->context(), &got));
        TEST_ASSERT_EQUAL_HEX32(1, got.id);
        for (int i = 0; i < (host == &one ? static_cast<int>(BRACE_POSIX_RING) : 0); i++) {
            TEST_ASSERT_EQUAL_INT(1, host->hal.can_receive(host->context(), &got));
            TEST_ASSERT_EQUAL_HEX32(0x601, got.id);
        }
        TEST_ASSERT_EQUAL_INT(0, host->hal.can_receive(host->context(), &got));
        (void)host->hal.can_health(host->context(), &health);
        TEST_ASSERT_EQUAL_UINT32(host == &one ? 3 : 0, health.frames_lost);
    }
}

void slcan_clients_and_controllers_share_the_bus()
{
    Bus bus("tcp://127.0.0.1:0");
    Host one(bus.bus.get());
    brace_can_setup_t setup = at_1m();
    setup.fd_bit_rate = 2000000;
    (void)one.hal.can_setup(one.context(), &setup);
    const int first = connected(bus.bus->where), second = connected(bus.bus->where);
    const auto poll = [&bus] { bus.poll(); };
    put(first, "\r\rS8\rO\r");
    put(second, "S8\rO\r");
    TEST_ASSERT_EQUAL_STRING("\r\r\r\r", taken(first, poll, 4).c_str());
    TEST_ASSERT_EQUAL_STRING("\r\r", taken(second, poll, 2).c_str());
    TEST_ASSERT_EQUAL_UINT32(2, brace_posix_bus_clients(bus.bus.get()));

    put(first, "t1233A1b2C3\r"); // digits of either case
    TEST_ASSERT_EQUAL_STRING("z\r", taken(first, poll, 2).c_str());
    TEST_ASSERT_EQUAL_STRING("t1233A1B2C3\r", taken(second, poll, 12).c_str());
    brace_can_frame_t got{};
    TEST_ASSERT_EQUAL_INT(1, one.hal.can_receive(one.context(), &got));
    TEST_ASSERT_EQUAL_HEX32(0x123, got.id);
    TEST_ASSERT_EQUAL_UINT8(3, got.length);
    TEST_ASSERT_EQUAL_HEX8(0xa1, got.data[0]);
    TEST_ASSERT_EQUAL_HEX8(0xc3, got.data[2]);

    put(second, "T1ABCDEF00\r"); // extended: for other clients, not for controllers
    TEST_ASSERT_EQUAL_STRING("Z\r", taken(second, poll, 2).c_str());
    TEST_ASSERT_EQUAL_STRING("T1ABCDEF00\r", taken(first, poll, 11).c_str());
    put(second, "r7FF8\r");
    TEST_ASSERT_EQUAL_STRING("z\r", taken(second, poll, 2).c_str());
    TEST_ASSERT_EQUAL_STRING("r7FF8\r", taken(first, poll, 6).c_str());
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_receive(one.context(), &got));

    const brace_can_frame_t sent = frame(0x7ff, 2), fd = frame(0x181, 12, true);
    (void)one.hal.can_send(one.context(), &sent);
    (void)one.hal.can_send(one.context(), &fd);
    TEST_ASSERT_EQUAL_STRING("t7FF21011\rb1819101112131415161718191A1B\r", taken(first, poll, 40).c_str());
    put(first, "b1819101112131415161718191A1B\r");
    (void)taken(first, poll, 2);
    TEST_ASSERT_EQUAL_INT(1, one.hal.can_receive(one.context(), &got));
    TEST_ASSERT_EQUAL_MEMORY(&fd, &got, sizeof got);

    put(first, "C\r");
    TEST_ASSERT_EQUAL_STRING("\r", taken(first, poll, 1).c_str());
    (void)one.hal.can_send(one.context(), &sent);
    put(first, "V\r");
    TEST_ASSERT_EQUAL_STRING("V1013\r", taken(first, poll, 6).c_str()); // closed: no frame before it
    close(first);
    for (int i = 0; i < 20; ++i) {
        bus.poll();
        (void)one.hal.can_send(one.context(), &sent); // into a connection that has gone
    }
    close(second);
}

// As typed in a terminal at a controller's own SLCAN port; the connection is gone as soon as the line is written.
void a_stop_needs_no_open_channel()
{
    Bus bus("tcp://127.0.0.1:0");
    Host one(bus.bus.get());
    brace_can_setup_t setup = at_1m();
    setup.urgent_id = 1;
    (void)one.hal.can_setup(one.context(), &setup);
    const auto poll = [&bus] { bus.poll(); };
    brace_can_frame_t got{};
    const int client = connected(bus.bus->where);
    put(client, "t0020\rT000000010\rr0010\r");
    TEST_ASSERT_EQUAL_STRING("\a\a\a", taken(client, poll, 3).c_str());
    TEST_ASSERT_EQUAL_INT(0, one.hal.can_receive(one.context(), &got));
    for (const char *before : {"", "L\r"}) {
        const int typist = connected(bus.bus->where);
        put(typist, before);
        put(typist, "t0010\r");
        close(typist);
        for (int i = 0; i < 1000 && one.hal.can_receive(one.context(), &got) == 0; ++i) {
            bus.poll();
        }
        TEST_ASSERT_EQUAL_HEX32(1, got.id);
        got = {};
    }
    close(client);
}

void a_client_that_does_not_read_loses_frames_and_nothing_else()
{
    Bus bus("tcp://127.0.0.1:0");
    Host one(bus.bus.get());
    const brace_can_setup_t setup = at_1m();
    (void)one.hal.can_setup(one.context(), &setup);
    const int lazy = connected(bus.bus->where);
    put(lazy, "O\r");
    const auto poll = [&bus] { bus.poll(); };
    TEST_ASSERT_EQUAL_STRING("\r", taken(lazy, poll, 1).c_str());
    const brace_can_frame_t sent = frame(0x1, 8);
    for (int i = 0; i < 1000000 && bus.bus->client[0].frames_lost == 0; ++i) {
        TEST_ASSERT_EQUAL_INT(0, one.hal.can_send(one.context(), &sent));
        bus.poll();
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, bus.bus->client[0].frames_lost);
    // What it then reads is whole lines all the same.
    const std::string text = taken(lazy, poll, 100000);
    for (std::size_t at = 0; at + 22 <= text.size(); at += 22) {
        TEST_ASSERT_EQUAL_STRING("t00181011121314151617\r", text.substr(at, 22).c_str());
    }
    close(lazy);
}

void more_clients_than_places_are_sent_away()
{
    Bus bus("tcp://127.0.0.1:0");
    int file[BRACE_POSIX_CLIENTS + 1];
    for (int &one : file) {
        one = connected(bus.bus->where);
    }
    for (int i = 0; i < 50; ++i) {
        bus.poll();
    }
    char byte;
    TEST_ASSERT_EQUAL_INT(0, static_cast<int>(read(file[BRACE_POSIX_CLIENTS], &byte, 1)));
    put(file[0], "V\r");
    TEST_ASSERT_EQUAL_STRING("V1013\r", taken(
                                            file[0], [&bus] { bus.poll(); }, 6)
                                            .c_str());
    for (const int one : file) {
        close(one);
    }
}

void urls_that_cannot_be_opened_say_why()
{
    auto bus = std::make_unique<brace_posix_bus_t>();
    TEST_ASSERT_EQUAL_INT(BRACE_POSIX_E_URL, brace_posix_bus_open(bus.get(), "tcp://127.0.0.1"));
    TEST_ASSERT_EQUAL_INT(BRACE_POSIX_E_URL, brace_posix_bus_open(bus.get(), "tcp://127.0.0.1:99999"));
    TEST_ASSERT_EQUAL_INT(BRACE_POSIX_E_NO_DEVICE, brace_posix_bus_open(bus.get(), "slcan:/dev/ttyNONE7"));
    TEST_ASSERT_EQUAL_INT(BRACE_POSIX_E_NO_DEVICE, brace_posix_bus_open(bus.get(), "slcan:/dev/null"));
    const int32_t socket_can = brace_posix_bus_open(bus.get(), "nocan9");
    TEST_ASSERT_TRUE(socket_can == BRACE_POSIX_E_NO_CAN || socket_can == BRACE_POSIX_E_NO_DEVICE);
    Bus taken_port("tcp://127.0.0.1:0");
    TEST_ASSERT_EQUAL_INT(BRACE_POSIX_E_IN_USE, brace_posix_bus_open(bus.get(), taken_port.bus->where));
    for (int32_t status = 0; status >= -8; --status) {
        TEST_ASSERT_NOT_NULL(brace_posix_status_text(status));
    }
}

// ------------------------------------------------------------------------------------------------- Modbus

std::string adu(int transaction, const std::string &pdu)
{
    std::string made{static_cast<char>(transaction >> 8),
                     static_cast<char>(transaction),
                     0,
                     0,
                     0,
                     static_cast<char>(pdu.size() + 1),
                     1};
    return made + pdu;
}

// Answers each ADU with itself, as far as one has come; the connection that was made last first.
void echo(Host &host, std::uint32_t room)
{
    static std::string pending;
    std::vector<std::pair<std::uint32_t, std::string>> waiting;
    std::uint8_t bytes[300];
    brace_posix_poll(&host.posix);
    for (int i = 0; i < 4; ++i) {
        const int32_t count = host.hal.serial_read(host.context(), BRACE_SERIAL_MODBUS_TCP, bytes, room);
        if (count <= 0) {
            break;
        }
        pending.append(reinterpret_cast<const char *>(bytes), static_cast<std::size_t>(count));
        const std::size_t whole = pending.size() >= 6 ? 6u + static_cast<std::uint8_t>(pending[5]) : 1000u;
        TEST_ASSERT_TRUE(pending.size() <= whole); // never the beginning of another one's
        if (pending.size() == whole) {
            waiting.emplace_back(host.hal.serial_peer(host.context(), BRACE_SERIAL_MODBUS_TCP), pending);
            pending.clear();
        }
    }
    std::stable_sort(waiting.begin(), waiting.end(), [](const auto &a, const auto &b) { return a.first > b.first; });
    for (const auto &[peer, text] : waiting) {
        TEST_ASSERT_EQUAL_INT(static_cast<int>(text.size()),
                              host.hal.serial_write_to(host.context(), BRACE_SERIAL_MODBUS_TCP, peer,
                                                       reinterpret_cast<const std::uint8_t *>(text.data()),
                                                       static_cast<std::uint32_t>(text.size())));
    }
    brace_posix_poll(&host.posix);
}

void modbus_answers_reach_whoever_asked()
{
    for (const std::uint32_t room : {300u, 7u, 1u}) {
        Host host;
        TEST_ASSERT_EQUAL_INT(0, brace_posix_modbus_open(&host.posix.modbus, "modbus-tcp://127.0.0.1:0/1"));
        int file[3];
        for (int &one : file) {
            one = connected(host.posix.modbus.where);
        }
        const auto poll = [&host, room] { echo(host, room); };
        const std::string longest = adu(9, std::string(253, 'x'));
        put(file[0], adu(1, "one"));
        put(file[1], adu(2, "two") + adu(3, "three")); // two in one segment
        put(file[2], longest.substr(0, 100));          // half of one
        TEST_ASSERT_TRUE(adu(1, "one") == taken(file[0], poll, adu(1, "one").size()));
        TEST_ASSERT_TRUE(adu(2, "two") + adu(3, "three") == taken(file[1], poll, 9 + 1 + 10 + 2));
        put(file[2], longest.substr(100));
        TEST_ASSERT_TRUE(longest == taken(file[2], poll, longest.size()));
        for (const int one : file) {
            close(one);
        }
    }
}

void what_is_no_modbus_is_hung_up_on()
{
    const std::string bad[] = {
        {0, 1, 0, 7, 0, 6, 1, 3}, {0, 1, 0, 0, 0, 1, 1, 3}, {0, 1, 0, 0, 0, char(255), 1, 3}, {0, 1, 0, 0, 1, 6, 1, 3}};
    Host host;
    TEST_ASSERT_EQUAL_INT(0, brace_posix_modbus_open(&host.posix.modbus, "modbus-tcp://127.0.0.1:0"));
    std::uint32_t count = 0;
    for (const std::string &text : bad) {
        const int file = connected(host.posix.modbus.where);
        put(file, text);
        char byte;
        ssize_t end = -1;
        for (int i = 0; i < 500 && end < 0; ++i) {
            brace_posix_poll(&host.posix);
            end = read(file, &byte, 1);
            usleep(500);
        }
        TEST_ASSERT_EQUAL_INT(0, static_cast<int>(end));
        TEST_ASSERT_EQUAL_UINT32(++count, host.posix.modbus.refused);
        close(file);
    }
}

void an_answer_never_reaches_a_later_connection()
{
    Host host;
    TEST_ASSERT_EQUAL_INT(0, brace_posix_modbus_open(&host.posix.modbus, "modbus-tcp://127.0.0.1:0"));
    const int gone = connected(host.posix.modbus.where);
    put(gone, adu(1, "asked"));
    std::uint8_t bytes[300];
    int32_t count = 0;
    for (int i = 0; i < 500 && count == 0; ++i) {
        brace_posix_poll(&host.posix);
        count = host.hal.serial_read(host.context(), BRACE_SERIAL_MODBUS_TCP, bytes, sizeof bytes);
        usleep(200);
    }
    TEST_ASSERT_EQUAL_INT(12, count);
    const std::uint32_t asked_by = host.hal.serial_peer(host.context(), BRACE_SERIAL_MODBUS_TCP);
    close(gone);
    for (int i = 0; i < 50; ++i) {
        brace_posix_poll(&host.posix);
        usleep(200);
    }
    const int later = connected(host.posix.modbus.where);
    for (int i = 0; i < 50; ++i) {
        brace_posix_poll(&host.posix);
    }
    TEST_ASSERT_EQUAL_INT(12, host.hal.serial_write_to(host.context(), BRACE_SERIAL_MODBUS_TCP, asked_by, bytes, 12));
    put(later, adu(2, "mine"));
    TEST_ASSERT_TRUE(adu(2, "mine") == taken(
                                           later, [&host] { echo(host, 300); }, 11));
    close(later);
}

// ----------------------------------------------------------------------------------------- serial, memory

void a_pty_is_a_line()
{
    Host host;
    brace_posix_stream_t *line = &host.posix.stream[BRACE_SERIAL_MODBUS];
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_UNSUPPORTED,
                          host.hal.serial_write(host.context(), BRACE_SERIAL_MODBUS, nullptr, 0));
    TEST_ASSERT_EQUAL_INT(0, brace_posix_stream_open(line, "pty"));
    TEST_ASSERT_EQUAL_INT(0, host.hal.serial_setup(host.context(), BRACE_SERIAL_MODBUS, 115200, BRACE_PARITY_EVEN));
    for (int visit = 0; visit < 2; ++visit) { // clients come and go
        const int client = open(line->where, O_RDWR | O_NOCTTY | O_NONBLOCK);
        TEST_ASSERT_TRUE(client >= 0);
        const std::uint8_t all[] = {0x00, 0x03, 0x0a, 0x0d, 0x11, 0x13, 0x7f, 0xff}; // nothing is special on it
        TEST_ASSERT_EQUAL_INT(8, host.hal.serial_write(host.context(), BRACE_SERIAL_MODBUS, all, 8));
        const std::string got = taken(
            client, [] {}, 8);
        TEST_ASSERT_EQUAL_INT(8, static_cast<int>(got.size()));
        TEST_ASSERT_EQUAL_MEMORY(all, got.data(), 8);
        put(client, got);
        std::uint8_t back[16];
        int32_t count = 0;
        for (int i = 0; i < 200 && count == 0; ++i) {
            count = host.hal.serial_read(host.context(), BRACE_SERIAL_MODBUS, back, sizeof back);
            usleep(200);
        }
        TEST_ASSERT_EQUAL_INT(8, count);
        TEST_ASSERT_EQUAL_MEMORY(all, back, 8);
        close(client);
    }
    std::uint8_t flood[4096] = {0};
    int32_t taken_bytes = 1;
    for (int i = 0; i < 100 && taken_bytes > 0; ++i) { // nobody reads: it fills up, and never blocks
        taken_bytes = host.hal.serial_write(host.context(), BRACE_SERIAL_MODBUS, flood, sizeof flood);
    }
    TEST_ASSERT_EQUAL_INT(0, taken_bytes);
}

void memory_writes_as_flash_does_and_outlives_its_process()
{
    char path[] = "/tmp/brace-memory-XXXXXX";
    close(mkstemp(path));
    const std::uint8_t first[] = {0xf0, 0x0f, 0xff, 0x00}, second[] = {0x3c, 0xff, 0xff, 0xff};
    std::uint8_t got[4];
    {
        Host host;
        bool is_new = false;
        TEST_ASSERT_EQUAL_INT(0, brace_posix_nvm_open(&host.posix.nvm, path, &is_new));
        TEST_ASSERT_TRUE(is_new);
        TEST_ASSERT_EQUAL_INT(0, host.hal.nvm_write(host.context(), 1, 8, first, 4));
        TEST_ASSERT_EQUAL_INT(0, host.hal.nvm_write(host.context(), 1, 8, second, 4));
        TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_RANGE, host.hal.nvm_write(host.context(), 1, 6, first, 4));
        TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_RANGE, host.hal.nvm_write(host.context(), 2, 0, first, 4));
        TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_RANGE, host.hal.nvm_read(host.context(), 0, 16383, got, 4));
        Host rival;
        TEST_ASSERT_EQUAL_INT(BRACE_POSIX_E_IN_USE, brace_posix_nvm_open(&rival.posix.nvm, path, nullptr));
    }
    Host host;
    bool is_new = true;
    TEST_ASSERT_EQUAL_INT(0, brace_posix_nvm_open(&host.posix.nvm, path, &is_new));
    TEST_ASSERT_FALSE(is_new);
    TEST_ASSERT_EQUAL_INT(0, host.hal.nvm_read(host.context(), 1, 8, got, 4));
    const std::uint8_t both[] = {0x30, 0x0f, 0xff, 0x00};
    TEST_ASSERT_EQUAL_MEMORY(both, got, 4);
    host.posix.nvm.forgets = true;
    TEST_ASSERT_EQUAL_INT(0, host.hal.nvm_erase(host.context(), 1));
    host.posix.nvm.forgets = false;
    host.posix.nvm.fails = true;
    TEST_ASSERT_EQUAL_INT(BRACE_HAL_E_DEVICE, host.hal.nvm_erase(host.context(), 1));
    TEST_ASSERT_EQUAL_INT(0, host.hal.nvm_read(host.context(), 1, 8, got, 4));
    TEST_ASSERT_EQUAL_MEMORY(both, got, 4);
    host.posix.nvm.fails = false;
    TEST_ASSERT_EQUAL_INT(0, host.hal.nvm_erase(host.context(), 1));
    TEST_ASSERT_EQUAL_INT(0, host.hal.nvm_read(host.context(), 1, 8, got, 4));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xff, got, 4);
    unlink(path);
}

void the_clock_runs_or_is_given()
{
    Host host;
    const std::uint32_t before = host.hal.now_us(host.context());
    usleep(3000);
    const std::uint32_t passed = host.hal.now_us(host.context()) - before;
    TEST_ASSERT_TRUE(passed >= 3000 && passed < 3000000);
    host.posix.time_is_given = true;
    host.posix.given_us = 77;
    TEST_ASSERT_EQUAL_UINT32(77, host.hal.now_us(host.context()));
}

} // namespace

int main()
{
    UNITY_BEGIN();
    RUN_TEST(controllers_hear_each_other_and_not_themselves);
    RUN_TEST(frames_that_cannot_be_are_refused);
    RUN_TEST(bus_off_lasts_until_recovered);
    RUN_TEST(a_full_ring_loses_the_newest_and_counts);
    RUN_TEST(an_urgent_frame_finds_room_in_every_controller_and_goes_first);
    RUN_TEST(slcan_clients_and_controllers_share_the_bus);
    RUN_TEST(a_stop_needs_no_open_channel);
    RUN_TEST(a_client_that_does_not_read_loses_frames_and_nothing_else);
    RUN_TEST(more_clients_than_places_are_sent_away);
    RUN_TEST(urls_that_cannot_be_opened_say_why);
    RUN_TEST(modbus_answers_reach_whoever_asked);
    RUN_TEST(what_is_no_modbus_is_hung_up_on);
    RUN_TEST(an_answer_never_reaches_a_later_connection);
    RUN_TEST(a_pty_is_a_line);
    RUN_TEST(memory_writes_as_flash_does_and_outlives_its_process);
    RUN_TEST(the_clock_runs_or_is_given);
    return UNITY_END();
}
