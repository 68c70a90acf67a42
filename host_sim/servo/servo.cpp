#include "servo/servo.h"

#include <algorithm>

namespace brace::servo {
namespace {

constexpr std::uint64_t kStarts_ns = 500'000'000; // from a reboot until it answers
constexpr std::uint8_t kPing = 1, kRead = 2, kWrite = 3, kRegWrite = 4, kAction = 5, kReboot = 8;

std::int32_t value_of(const Bytes &bytes, std::size_t at, std::size_t count)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
        value |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
    }
    if (count == 2) {
        return static_cast<std::int16_t>(value);
    }
    return static_cast<std::int32_t>(value);
}

const Register *register_at(std::uint16_t address)
{
    const auto found = std::find_if(kRegisters.begin(), kRegisters.end(),
                                    [address](const Register &entry) { return entry.address == address; });
    return found != kRegisters.end() ? &*found : nullptr;
}

} // namespace

Servo::Servo(std::uint8_t id, std::uint16_t model)
{
    for (const Register &entry : kRegisters) {
        set(entry.address, entry.bytes, entry.initial);
    }
    set(kModel, 2, model);
    set(kId, 1, id);
    current_step_a = model < 1000 ? 3.36e-3 : 2.69e-3; // MX
}

std::int32_t Servo::get(std::uint16_t address, std::uint32_t bytes) const
{
    return value_of({table_.begin() + address, table_.begin() + address + bytes}, 0, bytes);
}

void Servo::set(std::uint16_t address, std::uint32_t bytes, std::int32_t value)
{
    for (std::uint32_t i = 0; i < bytes; ++i) {
        table_[address + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (8 * i));
    }
}

void Servo::restart(std::uint64_t now_ns)
{
    for (const Register &entry : kRegisters) {
        const bool is_measured = entry.address >= kRealtimeTick;
        if (entry.address >= kRamBegins && !is_measured) {
            set(entry.address, entry.bytes, entry.initial);
        }
    }
    set(kGoalCurrent, 2, get(kCurrentLimit, 2));
    registered_.clear();
    starts_ns_ = now_ns + kStarts_ns;
}

void Servo::fail(std::uint8_t hardware_error)
{
    set(kHardwareError, 1, hardware_error);
    set(kTorque, 1, 0);
}

Answer Servo::read(std::uint16_t address, std::uint16_t count) const
{
    if (address + count > kTableBytes) {
        return {static_cast<std::uint8_t>(kAccess | alert()), {}};
    }
    return {alert(), {table_.begin() + address, table_.begin() + address + count}};
}

// All registers from the address on, or none of them.
std::uint8_t Servo::write(std::uint16_t address, const Bytes &data)
{
    std::size_t at = 0;
    while (at < data.size()) {
        const Register *entry = register_at(static_cast<std::uint16_t>(address + at));
        if (entry == nullptr || entry->access == Access::kRead) {
            return kAccess;
        }
        if (at + entry->bytes > data.size()) {
            return kLength;
        }
        if (entry->address < kRamBegins && get(kTorque, 1) != 0) {
            return kAccess;
        }
        const std::int32_t value = value_of(data, at, entry->bytes);
        if (value < entry->low || value > entry->high) {
            return kRange;
        }
        const bool bounded = entry->address == kGoalPosition && get(kOperatingMode, 1) == 3;
        if ((bounded && (value < get(kMinPosition, 4) || value > get(kMaxPosition, 4)))
            || (entry->address == kGoalCurrent && std::abs(value) > get(kCurrentLimit, 2))) {
            return kLimit;
        }
        if (entry->address == kTorque && value != 0 && get(kHardwareError, 1) != 0) {
            return kResult;
        }
        at += entry->bytes;
    }
    std::copy(data.begin(), data.end(), table_.begin() + address);
    return kNone;
}

std::optional<Answer> Servo::obey(std::uint8_t instruction, const Bytes &given, std::uint64_t now_ns)
{
    const std::int32_t level = get(kReturnLevel, 1);
    const auto answer = [&](std::uint8_t error, bool says) -> std::optional<Answer> {
        return says ? std::optional<Answer>({static_cast<std::uint8_t>(error | alert()), {}}) : std::nullopt;
    };
    const auto address = [&given] { return static_cast<std::uint16_t>(value_of(given, 0, 2)); };
    switch (instruction) {
    case kPing: {
        Answer pong = read(kModel, 2);
        pong.data.push_back(static_cast<std::uint8_t>(get(kFirmware, 1)));
        return pong;
    }
    case kRead:
        if (given.size() != 4) {
            return answer(kLength, level >= 1);
        }
        return level >= 1 ? std::optional<Answer>(read(address(), static_cast<std::uint16_t>(value_of(given, 2, 2))))
                          : std::nullopt;
    case kWrite:
        return answer(given.size() < 3 ? static_cast<std::uint8_t>(kLength)
                                       : write(address(), {given.begin() + 2, given.end()}),
                      level >= 2);
    case kRegWrite:
        registered_ = given;
        set(kRegistered, 1, 1);
        return answer(given.size() < 3 ? kLength : kNone, level >= 2);
    case kAction:
        if (get(kRegistered, 1) != 0) {
            (void)write(static_cast<std::uint16_t>(value_of(registered_, 0, 2)),
                        {registered_.begin() + 2, registered_.end()});
            set(kRegistered, 1, 0);
        }
        return answer(kNone, level >= 2);
    case kReboot: {
        const auto said = answer(kNone, level >= 2);
        restart(now_ns);
        return said;
    }
    default: return answer(kInstruction, level >= 2);
    }
}

} // namespace brace::servo
