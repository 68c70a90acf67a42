// The half-duplex line between a master and its servos: packets, their times, and their damage.
#pragma once

#include <deque>
#include <memory>
#include <random>
#include <vector>

#include "servo/servo.h"

extern "C" {
#include "api/brace_servos.h"
}

namespace brace::servo {

class Line {
public:
    Line(std::uint32_t baud, std::uint64_t seed) : byte_ns_(10'000'000'000ull / baud), random_(seed) {}

    int add(std::uint8_t id, std::uint16_t model);
    Servo *servo(std::int32_t index);
    const Servo *servo(std::int32_t index) const;

    void hear(std::uint64_t at_ns, Bytes bytes);
    std::uint32_t give(std::uint64_t now_ns, std::uint8_t *bytes, std::uint32_t room);

    double damage_share = 0.0;
    brace_servos_counts_t counts{};

private:
    struct Spoken {
        std::uint64_t at_ns;
        std::uint8_t byte;
    };

    void obey(std::uint8_t id, std::uint8_t instruction, const Bytes &parameters);
    void sync_read(const Bytes &parameters, bool is_fast);
    void sync_write(const Bytes &parameters);
    void say(const Servo &servo, const Answer &answer, std::uint64_t after_ns);
    void speak(Bytes packet, std::uint64_t after_ns);
    void spoil(Bytes &packet);
    Servo *named(std::uint8_t id);

    std::uint64_t byte_ns_;
    std::mt19937_64 random_;
    std::vector<std::unique_ptr<Servo>> servos_;
    Bytes heard_;
    std::deque<Spoken> spoken_;
    std::uint64_t heard_ns_ = 0; // when the last byte of the master had come
    std::uint64_t free_ns_ = 0;  // until when servos speak
};

} // namespace brace::servo
