// Masters on the controllers' buses: real connections by TCP to this process' own ports, opened and dropped at random,
// that ask, and send nonsense. Their frames are written out by hand.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "limbs.h"

namespace soak {

// A file descriptor of a connection.
class Socket {
public:
    Socket() = default;
    ~Socket() { drop(); }
    Socket(const Socket &) = delete;
    Socket &operator=(const Socket &) = delete;

    bool connect_to(const std::string &place); // "SCHEME://127.0.0.1:PORT"
    void drop();
    bool is_open() const { return file_ >= 0; }
    void send(const void *bytes, std::size_t count);
    void take(std::vector<std::uint8_t> &bytes); // appends what has come; drops when the other end has closed

private:
    int file_ = -1;
};

struct Answered {
    std::uint64_t count = 0, late = 0; // late: not within kPatience_ticks
    std::uint64_t ticks_sum = 0;
    std::uint32_t ticks_most = 0;
    void add(std::uint32_t ticks);
};
constexpr std::uint32_t kPatience_ticks = 100;

// Asks a limb for its whole snapshot by Modbus TCP, registers 0 to 61.
class ModbusMaster {
public:
    // returns false: an answer came that is none, or whose K is not the snapshot's of the same number
    bool step(brace_node_t *node, int limb, Chance &chance, bool is_calm, Answered &answered);
    std::uint64_t connections = 0;

private:
    bool judge(const brace_snapshot_t &snapshot) const;

    Socket socket_;
    std::vector<std::uint8_t> come_;
    std::uint16_t transaction_ = 0;
    std::uint32_t waits_ticks_ = 0;
    int rests_ticks_ = 0; // until it connects again
    bool waits_ = false;
};

// Asks any limb on the CAN bus for K at a posture, as text over TCP (SLCAN).
class CanMaster {
public:
    void step(const std::string &place, Chance &chance, bool is_calm, Answered &answered);
    std::uint64_t connections = 0;

private:
    Socket socket_;
    std::vector<std::uint8_t> come_;
    std::string awaited_;
    std::uint8_t token_ = 0;
    std::uint32_t waits_ticks_ = 0;
    int rests_ticks_ = 0; // until it connects again
};

} // namespace soak
