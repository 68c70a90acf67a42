// The control table of a servo: what each register is at first, who may write it, and in which range.
#pragma once

#include <array>
#include <cstdint>

namespace brace::servo {

enum class Access : std::uint8_t { kRead, kWrite };

struct Register {
    std::uint16_t address;
    std::uint8_t bytes;
    Access access;
    std::int32_t low, high, initial; // high of a limit given by another register: that register's
};

inline constexpr std::uint16_t kTableBytes = 256;
inline constexpr std::uint16_t kRamBegins = 64; // what stands before it outlives a reboot, and locks while torque is on

inline constexpr std::uint16_t kModel = 0, kFirmware = 6, kId = 7, kReturnDelay = 9, kOperatingMode = 11,
                               kCurrentLimit = 38, kMaxPosition = 48, kMinPosition = 52, kTorque = 64,
                               kReturnLevel = 68, kRegistered = 69, kHardwareError = 70, kGoalCurrent = 102,
                               kGoalPosition = 116, kRealtimeTick = 120, kPresentCurrent = 126, kPresentVelocity = 128,
                               kPresentPosition = 132, kVoltage = 144, kTemperature = 146;

inline constexpr std::int32_t kTurns = 1048575; // of the extended position mode: 256 turns each way

// By the makers' table for MX-106(2.0), X430 and X540; values out of the box are those of an XM430.
inline constexpr std::array<Register, 55> kRegisters = {{
    {kModel, 2, Access::kRead, 0, 65535, 0},
    {2, 4, Access::kRead, 0, 0, 0},
    {kFirmware, 1, Access::kRead, 0, 255, 48},
    {kId, 1, Access::kWrite, 0, 252, 1},
    {8, 1, Access::kWrite, 0, 7, 5},
    {kReturnDelay, 1, Access::kWrite, 0, 254, 0},
    {10, 1, Access::kWrite, 0, 13, 0},
    {kOperatingMode, 1, Access::kWrite, 0, 16, 5},
    {12, 1, Access::kWrite, 0, 255, 255},
    {13, 1, Access::kWrite, 1, 22, 2},
    {20, 4, Access::kWrite, -1044479, 1044479, 0},
    {24, 4, Access::kWrite, 0, 1023, 10},
    {31, 1, Access::kWrite, 0, 100, 80},
    {32, 2, Access::kWrite, 95, 160, 160},
    {34, 2, Access::kWrite, 95, 160, 95},
    {36, 2, Access::kWrite, 0, 885, 885},
    {kCurrentLimit, 2, Access::kWrite, 0, 2047, 2047},
    {44, 4, Access::kWrite, 0, 1023, 200},
    {kMaxPosition, 4, Access::kWrite, 0, 4095, 4095},
    {kMinPosition, 4, Access::kWrite, 0, 4095, 0},
    {63, 1, Access::kWrite, 0, 63, 52},
    {kTorque, 1, Access::kWrite, 0, 1, 0},
    {65, 1, Access::kWrite, 0, 1, 0},
    {kReturnLevel, 1, Access::kWrite, 0, 2, 2},
    {kRegistered, 1, Access::kRead, 0, 1, 0},
    {kHardwareError, 1, Access::kRead, 0, 255, 0},
    {76, 2, Access::kWrite, 0, 16383, 1920},
    {78, 2, Access::kWrite, 0, 16383, 100},
    {80, 2, Access::kWrite, 0, 16383, 0},
    {82, 2, Access::kWrite, 0, 16383, 0},
    {84, 2, Access::kWrite, 0, 16383, 800},
    {88, 2, Access::kWrite, 0, 16383, 0},
    {90, 2, Access::kWrite, 0, 16383, 0},
    {98, 1, Access::kWrite, 0, 127, 0},
    {100, 2, Access::kWrite, -885, 885, 885},
    {kGoalCurrent, 2, Access::kWrite, -2047, 2047, 2047},
    {104, 4, Access::kWrite, -1023, 1023, 0},
    {108, 4, Access::kWrite, 0, 32767, 0},
    {112, 4, Access::kWrite, 0, 32767, 0},
    {kGoalPosition, 4, Access::kWrite, -kTurns, kTurns, 0},
    {kRealtimeTick, 2, Access::kRead, 0, 32767, 0},
    {122, 1, Access::kRead, 0, 1, 0},
    {123, 1, Access::kRead, 0, 255, 0},
    {124, 2, Access::kRead, -885, 885, 0},
    {kPresentCurrent, 2, Access::kRead, -2047, 2047, 0},
    {kPresentVelocity, 4, Access::kRead, -1023, 1023, 0},
    {kPresentPosition, 4, Access::kRead, -kTurns, kTurns, 0},
    {136, 4, Access::kRead, -1023, 1023, 0},
    {140, 4, Access::kRead, -kTurns, kTurns, 0},
    {kVoltage, 2, Access::kRead, 0, 200, 120},
    {kTemperature, 1, Access::kRead, 0, 150, 25},
    {147, 1, Access::kRead, 0, 255, 0},
    {14, 4, Access::kRead, 0, 0, 0},
    {18, 2, Access::kRead, 0, 0, 0},
    {66, 2, Access::kRead, 0, 0, 0},
}};

} // namespace brace::servo
