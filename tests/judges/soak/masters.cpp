#include "masters.h"

#include <arpa/inet.h>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

extern "C" {
#include "brace/can_messages.h"
}

namespace soak {
namespace {

constexpr int kHeader = 7, kRegisters = 62, kAnswer = kHeader + 2 + 2 * kRegisters;

constexpr int kOncePerTicks = 20;     // an idle master asks so seldom
constexpr int kDropsOnceIn = 50;      // and drops its connection after so many questions
constexpr int kLongestRest_ticks = 6000; // and is away for so long at most
constexpr int kNonsenseOnceIn = 20;

std::uint32_t value_at(const std::vector<std::uint8_t> &answer, int register_)
{
    const std::size_t at = kHeader + 2u + 2u * static_cast<std::size_t>(register_);
    return static_cast<std::uint32_t>(answer[at]) << 24 | static_cast<std::uint32_t>(answer[at + 1]) << 16 |
           static_cast<std::uint32_t>(answer[at + 2]) << 8 | answer[at + 3];
}

std::uint32_t bits_of(float value)
{
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

std::vector<std::uint8_t> nonsense(Chance &chance)
{
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(1 + whole(chance, 40)));
    for (std::uint8_t &byte : bytes) {
        byte = static_cast<std::uint8_t>(whole(chance, 256));
    }
    return bytes;
}

} // namespace

// ------------------------------------------------------------------------------------------------- socket

bool Socket::connect_to(const std::string &place)
{
    drop();
    const std::size_t colon = place.rfind(':');
    if (colon == std::string::npos) {
        return false;
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::atoi(place.c_str() + colon + 1)));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    file_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (file_ < 0 || ::connect(file_, reinterpret_cast<const sockaddr *>(&address), sizeof address) != 0) {
        drop();
        return false;
    }
    const int yes = 1;
    (void)::setsockopt(file_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    const linger at_once = {1, 0}; // no port waits behind a connection that was dropped
    (void)::setsockopt(file_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    return true;
}

void Socket::drop()
{
    if (file_ >= 0) {
        (void)::close(file_);
        file_ = -1;
    }
}

void Socket::send(const void *bytes, std::size_t count)
{
    if (file_ >= 0 && ::send(file_, bytes, count, MSG_NOSIGNAL | MSG_DONTWAIT) < 0 && errno != EAGAIN) {
        drop();
    }
}

void Socket::take(std::vector<std::uint8_t> &bytes)
{
    std::uint8_t part[4096];
    while (file_ >= 0) {
        const ssize_t count = ::recv(file_, part, sizeof part, MSG_DONTWAIT);
        if (count > 0) {
            bytes.insert(bytes.end(), part, part + count);
            continue;
        }
        if (count == 0 || errno != EAGAIN) {
            drop();
        }
        return;
    }
}

void Answered::add(std::uint32_t ticks)
{
    ++count;
    ticks_sum += ticks;
    ticks_most = std::max(ticks_most, ticks);
}

// ------------------------------------------------------------------------------------------------- Modbus

// The number of the snapshot, and K once every gap has closed: registers 8 and 32 to 37.
bool ModbusMaster::judge(const brace_snapshot_t &snapshot) const
{
    const bool is_right = come_.size() == static_cast<std::size_t>(kAnswer) && come_[0] == (transaction_ >> 8) &&
                          come_[1] == (transaction_ & 0xff) && come_[7] == 4 && come_[8] == 2 * kRegisters &&
                          value_at(come_, 0) == 0x4640e600u && value_at(come_, 2) == 0x01020304u;
    if (!is_right || value_at(come_, 8) != snapshot.sequence || !snapshot.k_is_valid || value_at(come_, 16) == 0u) {
        return is_right; // an older snapshot's K is not kept here
    }
    const brace_stiffness_t &k = snapshot.stiffness.engaged;
    return value_at(come_, 32) == bits_of(k.k_xx_n_per_mm) && value_at(come_, 34) == bits_of(k.k_xz_n_per_mm) &&
           value_at(come_, 36) == bits_of(k.k_zz_n_per_mm);
}

bool ModbusMaster::step(brace_node_t *node, int limb, Chance &chance, bool is_calm, Answered &answered)
{
    if (waits_) {
        ++waits_ticks_;
        socket_.take(come_);
        brace_snapshot_t snapshot;
        bool is_right = true;
        if (come_.size() >= static_cast<std::size_t>(kAnswer)) {
            (void)brace_node_snapshot(node, limb, &snapshot);
            is_right = judge(snapshot);
            answered.add(waits_ticks_);
            waits_ = false;
        } else if (!socket_.is_open() || waits_ticks_ > kPatience_ticks) {
            answered.late += socket_.is_open() ? 1u : 0u;
            waits_ = false;
            socket_.drop();
        } else if (whole(chance, 5000) == 0) { // it loses patience, and its question stays behind
            waits_ = false;
            socket_.drop();
        }
        return is_right;
    }
    if (rests_ticks_ > 0) {
        --rests_ticks_;
        return true;
    }
    if (whole(chance, kOncePerTicks) != 0) {
        return true;
    }
    if (socket_.is_open() && whole(chance, kDropsOnceIn) == 0) {
        socket_.drop();
        rests_ticks_ = whole(chance, kLongestRest_ticks);
        return true;
    }
    if (!socket_.is_open()) {
        connections += socket_.connect_to(brace_node_serial_place(node, limb, BRACE_SERIAL_MODBUS_TCP)) ? 1u : 0u;
    }
    if (!is_calm && whole(chance, kNonsenseOnceIn) == 0) {
        const std::vector<std::uint8_t> bytes = nonsense(chance);
        socket_.send(bytes.data(), bytes.size());
        socket_.drop();
        return true;
    }
    ++transaction_;
    const auto high = static_cast<std::uint8_t>(transaction_ >> 8), low = static_cast<std::uint8_t>(transaction_);
    const std::uint8_t request[] = {high, low, 0, 0, 0, 6, 1, 4, 0, 0, 0, kRegisters};
    socket_.send(request, sizeof request);
    come_.clear();
    waits_ = socket_.is_open();
    waits_ticks_ = 0;
    return true;
}

// ---------------------------------------------------------------------------------------------------- CAN

void CanMaster::step(const std::string &place, Chance &chance, bool is_calm, Answered &answered)
{
    if (rests_ticks_ > 0) {
        --rests_ticks_;
        return;
    }
    if (!awaited_.empty()) {
        socket_.take(come_);
        ++waits_ticks_;
        const auto found = std::search(come_.begin(), come_.end(), awaited_.begin(), awaited_.end());
        if (found != come_.end()) {
            answered.add(waits_ticks_);
            awaited_.clear();
        } else if (!socket_.is_open() || waits_ticks_ > kPatience_ticks) {
            answered.late += socket_.is_open() ? 1u : 0u;
            awaited_.clear();
        }
    }
    if (!awaited_.empty() || whole(chance, kOncePerTicks) != 0) {
        return;
    }
    if (socket_.is_open() && whole(chance, kDropsOnceIn) == 0) {
        socket_.drop();
        rests_ticks_ = whole(chance, kLongestRest_ticks);
        return;
    }
    socket_.take(come_); // what was sent to everybody meanwhile
    if (!socket_.is_open()) {
        connections += socket_.connect_to(place) ? 1u : 0u;
        socket_.send("O\r", 2);
    }
    if (!is_calm && whole(chance, kNonsenseOnceIn) == 0) {
        const std::vector<std::uint8_t> bytes = nonsense(chance);
        socket_.send(bytes.data(), bytes.size());
        socket_.drop();
        return;
    }
    const int limb = 1 + whole(chance, kLimbs);
    const auto micro_rad = [&chance](double near) {
        return static_cast<std::uint32_t>(1e6 * (near + real(chance, -0.1, 0.1)));
    };
    const std::uint32_t theta1 = micro_rad(kTheta1_rad), theta2 = micro_rad(kTheta2_rad);
    ++token_;
    char text[64];
    std::snprintf(text, sizeof text, "t%03X8%02X%02X%02X%02X%02X%02X%02X%02X\r", 0x600 + limb,
                  BRACE_REQUEST_K_AT_POSTURE, token_, theta1 & 0xff, theta1 >> 8 & 0xff, theta1 >> 16 & 0xff,
                  theta2 & 0xff, theta2 >> 8 & 0xff, theta2 >> 16 & 0xff);
    socket_.send(text, std::strlen(text));
    // the answer's last part
    std::snprintf(text, sizeof text, "t%03X8%02X%02X", 0x580 + limb, BRACE_K_AT_POSTURE_ANSWER_3, token_);
    awaited_ = text;
    waits_ticks_ = 0;
    come_.clear();
}

} // namespace soak
