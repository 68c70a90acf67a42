// One servo's firmware: its registers, and what it answers to an instruction.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "servo/registers.h"

namespace brace::servo {

using Bytes = std::vector<std::uint8_t>;

// Numbers of a status packet's error byte.
enum Error : std::uint8_t {
    kNone = 0,
    kResult = 1,
    kInstruction = 2,
    kCrc = 3,
    kRange = 4,
    kLength = 5,
    kLimit = 6,
    kAccess = 7,
    kAlert = 0x80
};

struct Answer {
    std::uint8_t error;
    Bytes data;
};

class Servo {
public:
    Servo(std::uint8_t id, std::uint16_t model);

    std::uint8_t id() const { return static_cast<std::uint8_t>(get(kId, 1)); }
    std::uint64_t return_delay_ns() const { return 2000ull * static_cast<std::uint64_t>(get(kReturnDelay, 1)); }
    bool hears(std::uint64_t now_ns) const { return plugged && now_ns >= starts_ns_; }

    // What it answers to an instruction for it alone; nothing: it says nothing.
    std::optional<Answer> obey(std::uint8_t instruction, const Bytes &parameters, std::uint64_t now_ns);
    Answer read(std::uint16_t address, std::uint16_t count) const;
    std::uint8_t write(std::uint16_t address, const Bytes &data); // an Error
    std::uint8_t alert() const { return get(kHardwareError, 1) != 0 ? kAlert : 0; }

    std::int32_t get(std::uint16_t address, std::uint32_t bytes) const;
    void set(std::uint16_t address, std::uint32_t bytes, std::int32_t value);

    void restart(std::uint64_t now_ns);
    void fail(std::uint8_t hardware_error);

    bool plugged = true;
    double current_step_a = 2.69e-3;

private:
    std::array<std::uint8_t, kTableBytes> table_{};
    Bytes registered_; // by reg write
    std::uint64_t starts_ns_ = 0;
};

} // namespace brace::servo
